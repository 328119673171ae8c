//! The method `cluster`: a pair list that is kept while its skin lasts, particles in its order.

use super::evaluate::Loaded;
use crate::cluster::{Clusters, Output};
use nearfield_core::{Plan, Radii, SimBox, maintenance::Action};
use std::{
    sync::atomic::{AtomicBool, Ordering::Relaxed},
    time::Instant,
};

/// The pair list and how it is kept.
pub(super) struct StoredClusters {
    pub clusters: Clusters,
    /// At most what keeps range plus skin within half a periodic length.
    skin: f32,
    listing: Listing,
    /// Evaluations since the list was built.
    age: u64,
    /// Whether the list must not outlive the present moment: see [`StoredClusters::end`].
    ended: AtomicBool,
}

/// Whether there can be a list; otherwise pairs are found in the grid at each evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Listing {
    Possible,
    /// The list was larger than the memory budget.
    TooLarge,
    /// Radii differ from particle to particle.
    DifferentRadii,
}

impl StoredClusters {
    pub fn new(plan: &Plan, sim_box: &SimBox, radii: &Radii) -> Self {
        let lengths = sim_box.lengths();
        let room = (0..3)
            .filter(|&axis| sim_box.is_periodic(axis))
            .map(|axis| 0.5 * lengths[axis] - radii.largest())
            .fold(f32::INFINITY, f32::min);
        let listing = if radii.is_uniform() { Listing::Possible } else { Listing::DifferentRadii };
        Self {
            clusters: Clusters::default(),
            skin: plan.skin.min(room).max(0.0),
            listing,
            age: 0,
            ended: AtomicBool::new(false),
        }
    }

    /// Has list and forces made anew before the next step. Another engine that takes the particles over has no list: the
    /// order of sums, which is that of the list, would tell it from this one.
    pub fn end(&self) {
        self.ended.store(true, Relaxed);
    }

    /// Whether list and forces have ended; the list is then forgotten.
    pub fn forget_if_ended(&mut self) -> bool {
        let ended = std::mem::take(self.ended.get_mut());
        if ended {
            // With what it has learned of the particles' motion.
            self.clusters = Clusters::default();
        }
        ended
    }
}

impl Loaded {
    /// Brings the list up to date with the positions, or the grid where there can be no list.
    pub fn prepare_clusters(&mut self) {
        let Self { plan, physics, state, results, upkeep, clusters: stored, report, .. } = self;
        stored.age += 1;
        let start = Instant::now();
        let list = stored.listing == Listing::Possible;
        let serves = list && stored.clusters.refresh(state.moving_slices(self.dt));
        report.refit_seconds += start.elapsed().as_secs_f64();
        if serves {
            return;
        }
        let start = Instant::now();
        let input = state.input(physics, state.radii(physics));
        upkeep.update(Action::Build, &input, report);
        let gridded = start.elapsed();
        if list {
            let grid = upkeep.index.grid().expect("cluster has a grid");
            let order = stored.clusters.order(grid);
            state.reorder(order);
            results.reorder(order);
            let moving = state.moving_slices(self.dt);
            if stored.clusters.build(grid, physics, moving, stored.skin, plan.memory_budget) {
                report.list_builds += 1;
                if stored.age == 1 && stored.skin > 0.0 && report.list_builds > 1 {
                    report.dangerous_builds += 1;
                }
                stored.age = 0;
            } else {
                stored.listing = Listing::TooLarge;
                stored.clusters = Clusters::default();
                // The particles have left the order that the grid was built for.
                let input = state.input(physics, state.radii(physics));
                upkeep.update(Action::Build, &input, report);
            }
        }
        report.build_seconds += (start.elapsed() - gridded).as_secs_f64();
    }

    /// Forces, and energies where results have room, from the list; `None` when there is none, else whether all forces
    /// are finite.
    pub fn evaluate_clusters(&mut self) -> Option<bool> {
        match self.clusters.listing {
            Listing::Possible => {}
            Listing::TooLarge => {
                self.report.batched_evaluations += 1;
                return None;
            }
            Listing::DifferentRadii => return None,
        }
        let results = &mut self.results;
        let out = Output {
            force: results.force.axes_mut().map(|axis| &mut axis[..]),
            energy: &mut results.energy,
            virial: &mut results.virial,
            neighbors: &mut results.neighbors,
        };
        Some(self.clusters.clusters.evaluate(&self.physics, self.plan.deterministic, out))
    }
}
