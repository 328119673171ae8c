//! How long lists serve, and how far they reach, by a tolerance for what they may miss.

use super::missed::{ListSize, Missed};
use serde::{Deserialize, Serialize};

/// Part of the tolerance that is for the outer list; the inner list, which is read at each step, has the rest.
const OF_OUTER: f64 = 0.2;
/// Numbers of steps that are tried are powers of 2^(1/4), from 1 to 2^9.
const QUARTERS: i32 = 36;
/// Ways of the mean speed, by half the life of a list, within which nearly all particles are expected.
const AHEAD: f64 = 2.0;

/// What lists cost, in any one unit.
#[derive(Clone, Copy, Debug)]
pub struct ListCosts {
    /// For each particle of a new list.
    pub sorting: f64,
    /// For each pair of groups of a new list.
    pub listing: f64,
    /// For each pair of groups of a list that is pruned.
    pub pruning: f64,
    /// For each pair of groups of an outer list and step.
    pub keeping: f64,
    /// For each pair of groups of an inner list and step.
    pub computing: f64,
}

/// What lists must keep to.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Greatest expected drift of the energy, for each particle and unit of time.
    pub tolerance: f64,
    /// Time step.
    pub dt: f64,
    /// Skin of the outer list where it was chosen by the user, \[length\]; without any no list may serve twice.
    pub skin: Option<f64>,
    /// Most that a list may reach, with the ways that particles are expected to go, \[length\].
    pub most_reach: f64,
}

/// How lists are kept that may miss pairs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ListIntervals {
    /// Steps that a list serves.
    pub rebuild_every: u32,
    /// Steps that its inner list serves.
    pub prune_every: u32,
    /// Reach of the list, \[length\].
    pub outer_reach: f32,
    /// Reach of the inner list, \[length\].
    pub inner_reach: f32,
    /// Farthest from where it is that a particle is expected, and listed, \[length\].
    pub lead: f32,
    /// Expected drift of the energy from pairs that are missed, for each particle and unit of time.
    pub expected_drift: f64,
}

impl ListIntervals {
    /// The cheapest intervals within the limits; `None` where no list may serve two steps.
    pub fn choose(missed: &Missed, size: &ListSize, costs: &ListCosts, limits: &Limits) -> Option<Self> {
        let Limits { tolerance, dt, skin, most_reach } = *limits;
        let cutoff = missed.cutoff();
        let time = |steps: u32| f64::from(steps) * dt;
        let reach = |steps: u32, part: f64| missed.reach(size, time(steps), part * tolerance);
        let ladder: Vec<u32> = (0..=QUARTERS).map(|k| (0.25 * f64::from(k)).exp2().round() as u32).collect();
        let outer = ladder.iter().filter_map(|&steps| {
            let needed = reach(steps, OF_OUTER)?;
            let reach = skin.map_or(needed, |skin| cutoff + skin);
            let fits = reach >= needed && reach + 2.0 * missed.way_ahead(time(steps)) <= most_reach;
            fits.then_some((steps, reach))
        });
        let outer: Vec<_> = outer.collect();
        let inner = ladder.iter().filter_map(|&steps| Some((steps, reach(steps, 1.0 - OF_OUTER)?)));
        let pairs = inner.flat_map(|inner| outer.iter().map(move |&outer| (inner, outer)));
        let possible = pairs.filter_map(|((prune_every, inner), (most, outer))| {
            // The last inner list ends with the outer one.
            let rebuild_every = most / prune_every * prune_every;
            let (held, read) = (size.at(outer), size.at(inner));
            let cost = (costs.sorting + costs.listing * held) / f64::from(rebuild_every)
                + (costs.pruning / f64::from(prune_every) + costs.keeping) * held
                + costs.computing * read;
            let intervals = Self {
                rebuild_every,
                prune_every,
                outer_reach: outer as f32,
                inner_reach: inner as f32,
                lead: missed.way_ahead(time(rebuild_every)) as f32,
                expected_drift: missed.drift(size, outer, time(rebuild_every))
                    + missed.drift(size, inner, time(prune_every)),
            };
            (rebuild_every > 1 && inner <= outer && outer > cutoff).then_some((cost, intervals))
        });
        possible.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, intervals)| intervals)
    }
}

impl Missed {
    /// How far nearly all particles are expected to go in half of `time`, \[length\].
    pub fn way_ahead(&self, time: f64) -> f64 {
        AHEAD * 0.5 * time * (3.0 * 0.5 * self.largest_velocity2()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Interaction, skin::CutoffEdge};

    const COSTS: ListCosts = ListCosts { sorting: 140.0, listing: 9.0, pruning: 4.6, keeping: 0.0, computing: 12.0 };
    const SIZE: ListSize = ListSize { pairs: 3.5, reach: 2.5, exponent: 2.0 };

    fn chosen(tolerance: f64, skin: Option<f64>) -> Option<ListIntervals> {
        let missed = CutoffEdge::new(&Interaction::lennard_jones(), 2.5, &[1.0]).missed(&[0.71]);
        let limits = Limits { tolerance, dt: 0.005, skin, most_reach: 10.0 };
        let chosen = ListIntervals::choose(&missed, &SIZE, &COSTS, &limits);
        if let Some(lists) = &chosen {
            assert!(lists.expected_drift <= tolerance, "{lists:?}");
            assert!(lists.inner_reach >= 2.5 && lists.outer_reach >= lists.inner_reach, "{lists:?}");
            assert_eq!(lists.rebuild_every % lists.prune_every, 0, "{lists:?}");
        }
        chosen
    }

    #[test]
    fn a_larger_tolerance_gives_longer_lives_or_thinner_lists() {
        let all: Vec<_> = [1e-6, 1e-4, 1e-2].map(|tolerance| chosen(tolerance, None).unwrap()).to_vec();
        for pair in all.windows(2) {
            assert!(pair[1].prune_every >= pair[0].prune_every, "{all:?}");
            assert!(pair[1].inner_reach <= pair[0].inner_reach, "{all:?}");
        }
        // 0.005 kJ/mol/ps in units of argon, what GROMACS takes by default.
        let usual = chosen(0.0108, None).unwrap();
        assert!(usual.prune_every >= 16 && usual.inner_reach < 2.52, "{usual:?}");
    }

    #[test]
    fn the_skin_of_the_user_is_kept_and_tells_how_long_lists_serve() {
        let [thin, thick] = [0.2, 0.6].map(|skin| chosen(0.001, Some(skin)).unwrap());
        assert_eq!((thin.outer_reach, thick.outer_reach), (2.7, 3.1), "{thin:?} {thick:?}");
        assert!(thin.rebuild_every < thick.rebuild_every, "{thin:?} {thick:?}");
        assert_eq!(chosen(0.001, Some(0.0)), None);
    }

    #[test]
    fn where_a_small_box_leaves_no_room_there_is_no_choice() {
        let missed = CutoffEdge::new(&Interaction::lennard_jones(), 2.5, &[1.0]).missed(&[0.71]);
        let limits = Limits { tolerance: 1e-6, dt: 0.005, skin: None, most_reach: 2.501 };
        assert_eq!(ListIntervals::choose(&missed, &SIZE, &COSTS, &limits), None);
    }
}
