//! Tutorial C's rule: rebuild when particles have moved far on average, or after many steps.
//!
//! The tutorial compares the mean displacement with the absolute length 0.5; a length that means something needs a
//! scale, so here it is a fraction of the search radius. Its further conditions (a box-quality threshold and a
//! constant guess of a 30 % faster query) are left out: the first needs the hidden inside of a hardware BVH, the
//! second is what `gradient` measures instead of guessing.

use super::{Action, Motion, Policy};
use crate::engine::StepCost;

/// Mean displacement, in search radii, at which a rebuild is due.
const MEAN_DISPLACEMENT: f32 = 0.5;
/// Most steps between rebuilds, as in the tutorial.
const MAX_STEPS: u32 = 50;

/// Rebuilds by distance moved.
#[derive(Clone, Copy, Debug, Default)]
pub struct Displacement {
    since_build: u32,
}

impl Policy for Displacement {
    fn needs_motion(&self) -> bool {
        true
    }

    fn needs_cost(&self) -> bool {
        false
    }

    fn decide(&mut self, motion: Motion) -> Action {
        if motion.mean > MEAN_DISPLACEMENT || self.since_build >= MAX_STEPS { Action::Build } else { Action::Refit }
    }

    fn record(&mut self, cost: StepCost) {
        self.since_build = if cost.built { 1 } else { self.since_build + 1 };
    }
}
