//! Lists that may miss pairs: how they are kept, by what they were and how particles move.

use super::state::State;
use crate::{
    cluster::{Clusters, Counts},
    physics::Physics,
};
use nearfield_core::{
    Plan,
    skin::{CutoffEdge, Limits, ListCosts, ListIntervals, ListSize, SkinTuner},
};

/// By how much the mean square of velocities may exceed what it was when a list was made, and is thought to.
const HEADROOM: f64 = 1.1;

/// What lists may miss, and what is known to find out how much they do.
pub(super) struct Tolerance {
    drift: f64,
    edge: CutoffEdge,
    n_types: u32,
    /// Particles to a unit of volume.
    density: f64,
    /// Most that lists may reach.
    most_reach: f64,
    /// For each type, the mean square of a component of the velocities for which the list is made.
    velocity2: Vec<f64>,
    /// Of the list.
    intervals: Option<ListIntervals>,
}

impl Tolerance {
    /// By a plan; `None` where no list may miss any pair. Results that depend on nothing but the system can not depend on
    /// when lists are made.
    pub fn new(plan: &Plan, physics: &Physics, state: &State) -> Option<Self> {
        if plan.list_tolerance <= 0.0 || plan.deterministic || !physics.radii.is_uniform() || state.len() == 0 {
            return None;
        }
        let n_types = physics.interaction.types.len() as u32;
        let shares: Vec<f64> = (0..n_types).map(|kind| state.count(kind) as f64 / state.len() as f64).collect();
        let cutoff = physics.cutoff();
        let volume: f64 = physics.sim_box.lengths().iter().map(|&length| f64::from(length)).product();
        Some(Self {
            drift: plan.list_tolerance,
            edge: CutoffEdge::new(&physics.interaction, cutoff, &shares),
            n_types,
            density: state.len() as f64 / volume,
            most_reach: f64::from(cutoff) + f64::from(physics.sim_box.room_around(cutoff)),
            velocity2: Vec::new(),
            intervals: None,
        })
    }

    /// Forgets what is known of lists.
    pub fn forget(&mut self) {
        self.intervals = None;
    }

    /// How the next list is to be kept; `None` where it may not miss any pair.
    pub fn choose(
        &mut self,
        last: &Clusters,
        state: &State,
        skin: &SkinTuner,
        dt: f32,
        costs: &ListCosts,
    ) -> Option<ListIntervals> {
        if dt == 0.0 {
            return None;
        }
        self.velocity2 = (0..self.n_types).map(|kind| HEADROOM * state.velocity2(kind)).collect();
        let missed = self.edge.missed(&self.velocity2);
        let size = match &self.intervals {
            None => ListSize::of_particles(self.density, missed.cutoff()),
            Some(lists) => {
                let Counts { entries, entries_of_inner, .. } = last.counts();
                let held = [entries, entries_of_inner].map(|entries| entries as f64 / state.len() as f64);
                ListSize::of_lists(held, [lists.outer_reach, lists.inner_reach].map(f64::from))
            }
        };
        let limits = Limits {
            tolerance: self.drift,
            dt: f64::from(dt),
            skin: (!skin.is_auto()).then(|| f64::from(skin.skin())),
            most_reach: self.most_reach,
        };
        self.intervals = ListIntervals::choose(&missed, &size, costs, &limits);
        self.intervals
    }

    /// Whether particles are still as slow as was thought.
    pub fn allows(&self, state: &State) -> bool {
        self.intervals.is_none()
            || (0..self.n_types).zip(&self.velocity2).all(|(kind, &then)| state.velocity2(kind) <= then)
    }
}
