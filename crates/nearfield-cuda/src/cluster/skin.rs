//! The skin of lists: fixed, or chosen from what lists have cost so far.

use super::list::Served;
use crate::engine::physics::Physics;
use nearfield_core::{
    Plan,
    skin::{ListUse, SkinTuner},
};

/// Nanoseconds of a new list: in any case, for each particle, and for each chunk of candidates; and of a step for each
/// chunk. From steps of melts and of sparse systems with skins of 0.3 to 4 on an H200 (docs/performance.md); only their
/// ratios matter.
const LAUNCHING: f64 = 25_000.0;
const SORTING: f64 = 0.2;
const LISTING: f64 = 0.45;
const READING: f64 = 0.4;

/// Chooses the skin, from time to time.
pub(super) struct ListSkin(SkinTuner);

impl ListSkin {
    /// A skin as far as the box allows it: no pair may be within range and skin at two images.
    pub fn new(plan: &Plan, physics: &Physics) -> Self {
        Self(SkinTuner::new(plan.skin, physics.largest, physics.sim_box.room_around(physics.largest)))
    }

    /// \[length\]
    pub fn skin(&self) -> f32 {
        self.0.skin()
    }

    /// Guesses from the longest way that a particle moves in a step, where no list has served yet; whether that changes the
    /// skin.
    pub fn guess(&mut self, longest: f32) -> bool {
        let before = self.skin();
        self.0.guess(longest);
        self.skin() != before
    }

    /// Learns from lists of `n` particles.
    pub fn record(&mut self, n: usize, served: Served) {
        if served.lists == 0 {
            return;
        }
        self.0.record(ListUse {
            steps: served.evaluations as f64 / served.lists as f64,
            sorting: LAUNCHING + SORTING * n as f64,
            listing: LISTING * served.chunks as f64,
            reading: READING * served.chunks as f64,
        });
    }

    /// Notes that a list is too large; whether a smaller skin is to be tried.
    pub fn shrink(&mut self) -> bool {
        self.0.shrink()
    }
}
