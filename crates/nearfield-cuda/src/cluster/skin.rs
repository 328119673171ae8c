//! The skin of lists: fixed, or chosen from what lists have cost so far.

use super::list::Served;
use crate::engine::physics::Physics;
use nearfield_core::{
    Plan,
    skin::{ListUse, SkinTuner},
};

/// Nanoseconds of a new list: in any case, for each particle, and for each chunk of candidates; and of a step for each
/// chunk, with sums that depend on order and with exact ones. From steps of melts and of sparse systems with skins of 0.3
/// to 4 on an H200 (docs/performance.md); only their ratios matter.
const LAUNCHING: f64 = 25_000.0;
const SORTING: f64 = 0.2;
const LISTING: f64 = 0.45;
const READING: f64 = 0.4;
const READING_EXACT: f64 = 3.0;

/// Lists cost less beside their use than on a CPU, and least beside exact sums: the first guess is for so much of the steps.
const FIRST_LIFE: f32 = 0.6;
const FIRST_LIFE_EXACT: f32 = 0.2;

/// Chooses the skin, from time to time.
pub(super) struct ListSkin {
    tuner: SkinTuner,
    /// Of a step, for each chunk.
    reading: f64,
    /// See [`FIRST_LIFE`].
    first_life: f32,
}

impl ListSkin {
    /// A skin as far as the box allows it: no pair may be within range and skin at two images.
    pub fn new(plan: &Plan, physics: &Physics) -> Self {
        let room = physics.sim_box.room_around(physics.largest);
        let (reading, first_life) =
            if plan.deterministic { (READING_EXACT, FIRST_LIFE_EXACT) } else { (READING, FIRST_LIFE) };
        Self { tuner: SkinTuner::new(plan.skin, physics.largest, room), reading, first_life }
    }

    /// \[length\]
    pub fn skin(&self) -> f32 {
        self.tuner.skin()
    }

    /// Guesses from the longest way that a particle moves in a step, where no list has served yet; whether that changes the
    /// skin.
    pub fn guess(&mut self, longest: f32) -> bool {
        let before = self.skin();
        self.tuner.guess(self.first_life * longest);
        self.skin() != before
    }

    /// Learns from lists of `n` particles.
    pub fn record(&mut self, n: usize, served: Served) {
        if served.lists == 0 {
            return;
        }
        self.tuner.record(ListUse {
            steps: served.evaluations as f64 / served.lists as f64,
            sorting: LAUNCHING + SORTING * n as f64,
            listing: LISTING * served.chunks as f64,
            reading: self.reading * served.chunks as f64,
        });
    }

    /// Notes that a list is too large; whether a smaller skin is to be tried.
    pub fn shrink(&mut self) -> bool {
        self.tuner.shrink()
    }
}
