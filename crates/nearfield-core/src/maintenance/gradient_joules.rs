//! `gradient` for joules instead of seconds, which paper A names as future work.
//!
//! The model is the same: with the energy of a build, of a refit, and of what a query costs more from step to step, the
//! optimum of eq. (8) is that of energy. No meter can read the energy of one build, so it is taken as its time times the
//! power of builds ([`BuildPower`]), in units of the power of all else.

use super::{Action, EnergyCounter, Gradient, Motion, Policy, build_power::BuildPower};
use crate::engine::StepCost;

/// The optimiser in units of energy. Without a counter it optimises time.
#[derive(Default)]
pub struct GradientJoules {
    gradient: Gradient,
    power: BuildPower,
    counter: Option<Box<dyn EnergyCounter>>,
}

impl Policy for GradientJoules {
    fn attach(&mut self, counter: Box<dyn EnergyCounter>) {
        self.counter = Some(counter);
    }

    fn decide(&mut self, motion: Motion) -> Action {
        if self.power.in_trial() { Action::Build } else { self.gradient.decide(motion) }
    }

    fn record(&mut self, cost: StepCost) {
        let was_in_trial = self.power.in_trial();
        if let Some(counter) = &mut self.counter {
            self.power.record(cost, &mut **counter);
        }
        // Of a trial the optimiser sees the last build, from which it goes on: others would teach it that cycles are short.
        if !(was_in_trial && self.power.in_trial()) {
            let power = if cost.built { self.power.ratio() } else { 1.0 };
            self.gradient.record(StepCost { structure: cost.structure * power, ..cost });
        }
    }
}
