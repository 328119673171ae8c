//! Paper A's `avg`: rebuild once the mean cost of the refitted steps since the last rebuild exceeds the cost of a
//! step with a rebuild.

use super::{Action, Motion, Policy};
use crate::engine::StepCost;

/// Compares the running mean of refitted steps with the last rebuilt one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Average {
    rebuilt_cost: f64,
    refitted_sum: f64,
    refitted_steps: u32,
}

impl Policy for Average {
    fn decide(&mut self, _: Motion) -> Action {
        let mean = self.refitted_sum / f64::from(self.refitted_steps.max(1));
        if self.refitted_steps > 0 && mean > self.rebuilt_cost { Action::Build } else { Action::Refit }
    }

    fn record(&mut self, cost: StepCost) {
        let total = cost.structure + cost.query;
        if cost.built {
            *self = Self { rebuilt_cost: total, refitted_sum: 0.0, refitted_steps: 0 };
        } else {
            self.refitted_sum += total;
            self.refitted_steps += 1;
        }
    }
}
