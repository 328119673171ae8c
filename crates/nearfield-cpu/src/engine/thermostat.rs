//! Stochastic velocity rescaling.

use super::evaluate::Loaded;
use nearfield_core::{Dynamics, Ensemble, dynamics::rescale_factor};

/// Rescales all velocities after `step` (Bussi, Donadio and Parrinello, 2007).
pub(super) fn rescale(loaded: &mut Loaded, dynamics: &Dynamics, step: u64) {
    let Ensemble::Rescale { temperature, relaxation } = dynamics.ensemble else { return };
    let kinetic = loaded.state.kinetic_energy(&loaded.physics.interaction.types);
    let factor = rescale_factor(
        kinetic,
        loaded.state.len(),
        temperature,
        f64::from(dynamics.dt) / relaxation,
        dynamics.seed,
        step,
    );
    let factor = factor as f32;
    loaded.state.for_each_moving(|_, p, _, _| p.velocity = p.velocity.map(|v| v * factor));
}
