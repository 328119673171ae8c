//! Rebuild after a fixed number of steps.

use super::{Action, Motion, Policy};
use crate::engine::StepCost;

/// Rebuilds each `period` steps.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    period: u32,
    since_build: u32,
}

impl Fixed {
    /// A rebuild each `period` steps, at least 1.
    pub fn new(period: u32) -> Self {
        Self { period: period.max(1), since_build: 0 }
    }
}

impl Policy for Fixed {
    fn needs_cost(&self) -> bool {
        false
    }

    fn decide(&mut self, _: Motion) -> Action {
        if self.since_build >= self.period { Action::Build } else { Action::Refit }
    }

    fn record(&mut self, cost: StepCost) {
        self.since_build = if cost.built { 1 } else { self.since_build + 1 };
    }
}
