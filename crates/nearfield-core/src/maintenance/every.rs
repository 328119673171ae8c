//! Rebuild at each step.

use super::{Action, Motion, Policy};
use crate::engine::StepCost;

/// No refits at all: the best queries, the dearest upkeep.
#[derive(Clone, Copy, Debug, Default)]
pub struct Every;

impl Policy for Every {
    fn needs_cost(&self) -> bool {
        false
    }

    fn decide(&mut self, _: Motion) -> Action {
        Action::Build
    }

    fn record(&mut self, _: StepCost) {}
}
