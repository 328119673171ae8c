//! The best skin of lists, from what was counted of the lists before.
//!
//! A list of skin s that serves K(s) steps costs (B + L(s)) / K(s) + S(s) a step: B for sorting, L for what it holds when
//! it is made, S for what it holds at each step. L and S grow as a power of range plus skin, K as a power of the skin
//! (the first where particles fly straight on, the second where they diffuse). Both powers are fitted to the lists so
//! far, and the next skin is the one that costs least, on a ladder of 2^(1/8) about the present one. It is then taken a rung
//! higher and a rung lower in turns, so that the powers stay known.
//!
//! All is counted, nothing timed: the same simulation makes the same choices each time, and one that continues from a
//! checkpoint with [`LearnedSkin`] does too.

use super::{Skin, power_law::PowerLaw};
use serde::{Deserialize, Serialize};

/// Rungs to a factor of two.
const OCTAVE: i32 = 8;
/// Lowest and highest rung: skins of 1/64 and 4 times the range.
const LADDER: [i32; 2] = [-6 * OCTAVE, 2 * OCTAVE];
/// Rungs that the first guess keeps to: skins of 1/16 to 1/2 of the range.
const GUESS: [i32; 2] = [-4 * OCTAVE, -OCTAVE];
/// Steps of the fastest particle that the first guess allows for.
const FIRST_LIFE: f64 = 15.0;
/// Most rungs from one list to the next.
const STRIDE: i32 = OCTAVE;
/// Expected exponents of life in the skin, and of size in range plus skin.
const EXPECTED: [f64; 2] = [1.0, 3.0];
/// Part of the work of sorting that is the least work of listing: where hardly anything is near, sizes follow no power.
const LEAST_LISTING: f64 = 0.01;
/// A list that serves so many times the steps foreseen, or this part of them, shows that the motion has changed.
const SURPRISE: f64 = 2.5;

/// A list that has been outrun, and its work in any one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListUse {
    /// Steps that it served, or that each of several served in the mean.
    pub steps: f64,
    /// Work of making it that does not depend on what it holds.
    pub sorting: f64,
    /// Work of making it that is proportional to what it holds.
    pub listing: f64,
    /// Work of each step that is proportional to what it holds.
    pub reading: f64,
}

/// What a [`SkinTuner`] has learned; part of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LearnedSkin {
    /// The skin is the range times 2^(rung / 8).
    rung: i32,
    /// The best rung, around which those of lists alternate.
    best: i32,
    /// Lowest rung whose list was too large, if any.
    too_large: Option<i32>,
    life: PowerLaw,
    listing: PowerLaw,
}

impl Default for LearnedSkin {
    fn default() -> Self {
        let [rung, _] = GUESS;
        Self { rung, best: rung, too_large: None, life: PowerLaw::default(), listing: PowerLaw::default() }
    }
}

/// Chooses the skin of the next list.
#[derive(Clone, Copy, Debug)]
pub struct SkinTuner {
    skin: Skin,
    range: f64,
    room: f32,
    learned: LearnedSkin,
}

impl SkinTuner {
    /// For a search `range` \[length\], of a typical particle where they differ, and a skin of at most `room` \[length\],
    /// as [`crate::SimBox::room_around`] the largest range.
    pub fn new(skin: Skin, range: f32, room: f32) -> Self {
        Self { skin, range: f64::from(range), room, learned: LearnedSkin::default() }
    }

    /// The skin of the next list, \[length\].
    pub fn skin(&self) -> f32 {
        let skin = match self.skin {
            Skin::Fixed(skin) => skin,
            Skin::Auto => self.of_rung(self.learned.rung) as f32,
        };
        skin.min(self.room).max(0.0)
    }

    /// Whether it is chosen here.
    pub fn is_auto(&self) -> bool {
        self.skin == Skin::Auto
    }

    /// Guesses from the longest way that a particle moves in a step, where there was no list yet.
    pub fn guess(&mut self, longest_step: f32) {
        if self.learned.life.is_empty() && self.learned.too_large.is_none() {
            let rung = f64::from(OCTAVE) * (2.0 * FIRST_LIFE * f64::from(longest_step) / self.range).log2();
            self.learned.rung = (rung as i32).clamp(GUESS[0], GUESS[1]);
            self.learned.best = self.learned.rung;
        }
    }

    /// Learns from a list of the present skin that has been outrun, and chooses the next skin.
    pub fn record(&mut self, list: ListUse) {
        let skin = f64::from(self.skin());
        if !self.is_auto() || list.steps <= 0.0 || skin <= 0.0 {
            return;
        }
        let size = list.listing.max(LEAST_LISTING * list.sorting);
        let (learned, steps) = (&mut self.learned, list.steps);
        if !learned.life.is_empty() {
            let foreseen = learned.life.at(skin, learned.life.exponent(EXPECTED[0]));
            if steps > SURPRISE * foreseen || SURPRISE * steps < foreseen {
                learned.life = PowerLaw::default();
            }
        }
        learned.life.add(skin, steps);
        learned.listing.add(self.range + skin, size);
        let (of_life, of_size) = (learned.life.exponent(EXPECTED[0]), learned.listing.exponent(EXPECTED[1]));
        let reading = list.reading / size;
        let cost = |rung: i32| {
            let skin = self.of_rung(rung).min(f64::from(self.room));
            let life = self.learned.life.at(skin, of_life).max(1.0);
            let listing = self.learned.listing.at(self.range + skin, of_size);
            (list.sorting + listing) / life + reading * listing
        };
        let [lowest, highest] = self.bounds();
        let (from, to) = ((self.learned.best - STRIDE).max(lowest), (self.learned.best + STRIDE).min(highest));
        let best = (from..=to).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap_or(lowest);
        // To the other side of the best than the last time.
        let aside = if self.learned.rung > self.learned.best { -1 } else { 1 };
        self.learned.best = best;
        self.learned.rung = (best + aside).clamp(lowest, highest);
    }

    /// Notes that a list of the present skin is too large to be kept. Whether a smaller skin is to be tried.
    pub fn shrink(&mut self) -> bool {
        let lowest = self.bounds()[0];
        let learned = &mut self.learned;
        if self.skin != Skin::Auto || learned.rung <= lowest {
            return false;
        }
        learned.too_large = Some(learned.rung);
        // Where even the first guess is too large, so perhaps is any list.
        let next = if learned.life.is_empty() { lowest } else { learned.rung - STRIDE };
        (learned.rung, learned.best) = (next.max(lowest), next.max(lowest));
        true
    }

    /// What was learned.
    pub fn learned(&self) -> LearnedSkin {
        self.learned
    }

    /// Takes what another tuner learned of the same system.
    pub fn set_learned(&mut self, learned: LearnedSkin) {
        let on_ladder = |rung: i32| rung.clamp(LADDER[0], LADDER[1]);
        self.learned = LearnedSkin {
            rung: on_ladder(learned.rung),
            best: on_ladder(learned.best),
            too_large: learned.too_large.map(on_ladder),
            ..learned
        };
    }

    fn of_rung(&self, rung: i32) -> f64 {
        self.range * (f64::from(rung) / f64::from(OCTAVE)).exp2()
    }

    /// Lowest and highest rung that make sense: the box and memory may leave no room for others.
    fn bounds(&self) -> [i32; 2] {
        let [lowest, highest] = LADDER;
        let highest = self.learned.too_large.map_or(highest, |rung| (rung - 2).clamp(lowest, highest));
        let fits = |&rung: &i32| self.of_rung(rung) <= f64::from(self.room);
        [lowest, (lowest..=highest).rev().find(fits).unwrap_or(lowest)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A simulation whose lists of skin s serve `life(s)` steps, with a few percent of chance.
    struct Motion<F> {
        life: F,
        sorting: f64,
        reading: f64,
    }

    impl<F: Fn(f64) -> f64> Motion<F> {
        fn listing(&self, skin: f64) -> f64 {
            40.0 * ((2.5 + skin) / 2.5).powi(3)
        }

        fn cost(&self, skin: f64) -> f64 {
            let listing = self.listing(skin);
            (self.sorting + listing) / (self.life)(skin).max(1.0) + self.reading * listing
        }

        /// Mean cost of the skins from the 20th list on, over that of the best one.
        fn relative_cost(&self, tuner: &mut SkinTuner) -> f64 {
            let mut random = 1u32;
            let mut costs = Vec::new();
            for list in 0..60 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let chance = 1.0 + 0.1 * (f64::from(random >> 8) / f64::from(1 << 24) - 0.5);
                let skin = f64::from(tuner.skin());
                let steps = ((self.life)(skin) * chance).round().max(1.0);
                let listing = self.listing(skin);
                tuner.record(ListUse { steps, sorting: self.sorting, listing, reading: self.reading * listing });
                if list >= 20 {
                    costs.push(self.cost(skin));
                }
            }
            let best = (1..500).map(|k| self.cost(0.01 * f64::from(k))).fold(f64::INFINITY, f64::min);
            costs.iter().sum::<f64>() / costs.len() as f64 / best
        }
    }

    fn tuner() -> SkinTuner {
        SkinTuner::new(Skin::Auto, 2.5, 100.0)
    }

    #[test]
    fn the_optimum_of_straight_and_of_diffusive_motion_is_found_from_any_start() {
        for longest_step in [0.0, 1e-3, 0.02, 1.0] {
            let start = || {
                let mut tuner = tuner();
                tuner.guess(longest_step);
                tuner
            };
            let straight = Motion { life: |s| 25.0 * s, sorting: 80.0, reading: 0.1 };
            let diffusive = Motion { life: |s| 60.0 * s * s, sorting: 80.0, reading: 0.1 };
            let slow = Motion { life: |s| 4000.0 * s, sorting: 300.0, reading: 0.1 };
            let (a, b, c) = (
                straight.relative_cost(&mut start()),
                diffusive.relative_cost(&mut start()),
                slow.relative_cost(&mut start()),
            );
            assert!(a < 1.02 && b < 1.02 && c < 1.02, "{longest_step}: {a} {b} {c}");
        }
    }

    #[test]
    fn where_nothing_is_near_the_skin_grows_as_far_as_it_may() {
        let mut tuner = SkinTuner::new(Skin::Auto, 1.0, 100.0);
        tuner.guess(0.005);
        for _ in 0..20 {
            let steps = (150.0 * tuner.skin()) as u64;
            tuner.record(ListUse { steps: steps as f64, sorting: 100.0, listing: 0.0, reading: 0.0 });
        }
        assert!(tuner.skin() > 1.0, "{}", tuner.skin());
    }

    #[test]
    fn a_change_of_the_motion_is_followed() {
        let mut tuner = tuner();
        let (cold, hot) = (
            Motion { life: |s| 300.0 * s, sorting: 80.0, reading: 0.1 },
            Motion { life: |s| 6.0 * s, sorting: 80.0, reading: 0.1 },
        );
        let cost = cold.relative_cost(&mut tuner);
        assert!(cost < 1.02, "{cost}");
        let skin = tuner.skin();
        let cost = hot.relative_cost(&mut tuner);
        assert!(cost < 1.02, "{cost} {tuner:?}");
        assert!(tuner.skin() > 1.5 * skin, "{skin} {}", tuner.skin());
    }

    #[test]
    fn the_first_guess_is_some_steps_of_the_fastest_particle() {
        let mut tuner = tuner();
        tuner.guess(0.02);
        assert!((0.5..0.7).contains(&tuner.skin()), "{}", tuner.skin());
        tuner.guess(0.0);
        assert_eq!(tuner.skin(), 2.5 / 16.0);
        tuner.record(ListUse { steps: 10.0, sorting: 80.0, listing: 40.0, reading: 4.0 });
        let skin = tuner.skin();
        tuner.guess(0.02);
        assert_eq!(tuner.skin(), skin, "what was learned counts more");
    }

    #[test]
    fn a_fixed_skin_stays_and_none_is_larger_than_there_is_room_for() {
        let mut tuner = SkinTuner::new(Skin::Fixed(0.4), 2.5, 100.0);
        tuner.guess(1.0);
        tuner.record(ListUse { steps: 1.0, sorting: 80.0, listing: 40.0, reading: 4.0 });
        assert_eq!(tuner.skin(), 0.4);
        assert!(!tuner.shrink());
        assert_eq!(SkinTuner::new(Skin::Fixed(0.4), 2.5, 0.3).skin(), 0.3);
        let mut tuner = SkinTuner::new(Skin::Auto, 2.5, 0.2);
        let slow = Motion { life: |s| 300.0 * s, sorting: 300.0, reading: 0.0 };
        slow.relative_cost(&mut tuner);
        assert!((0.15..=0.2).contains(&tuner.skin()), "{}", tuner.skin());
        assert_eq!(SkinTuner::new(Skin::Auto, 2.5, -1.0).skin(), 0.0);
    }

    #[test]
    fn lists_that_are_too_large_are_not_tried_again() {
        let mut tuner = tuner();
        tuner.guess(1.0);
        let too_large = tuner.skin();
        assert!(tuner.shrink());
        assert!(tuner.skin() < 0.1);
        let slow = Motion { life: |s| 4000.0 * s, sorting: 300.0, reading: 0.0 };
        slow.relative_cost(&mut tuner);
        assert!((0.7 * too_large..too_large).contains(&tuner.skin()), "{} {too_large}", tuner.skin());
        let mut tuner = SkinTuner::new(Skin::Auto, 2.5, 100.0);
        assert!(tuner.shrink() && !tuner.shrink(), "a list at the lowest skin is the last that is tried");
    }

    #[test]
    fn a_tuner_goes_on_from_what_another_learned() {
        let mut first = tuner();
        let straight = Motion { life: |s| 25.0 * s, sorting: 80.0, reading: 0.1 };
        straight.relative_cost(&mut first);
        let mut second = tuner();
        second.set_learned(first.learned());
        for _ in 0..10 {
            assert_eq!(first.skin(), second.skin());
            straight.relative_cost(&mut first);
            straight.relative_cost(&mut second);
        }
    }
}
