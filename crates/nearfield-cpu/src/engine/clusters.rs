//! The method `cluster`: a pair list that is kept while its skin lasts, particles in its order.

use super::{evaluate::Loaded, state::State, tolerance::Tolerance};
use crate::{
    cluster::{Clusters, Counts, Keeping, Output},
    physics::Physics,
};
use nearfield_core::{
    Plan,
    maintenance::Action,
    skin::{ListCosts, ListUse, SkinTuner},
};
use std::{
    sync::atomic::{AtomicBool, Ordering::Relaxed},
    time::Instant,
};

/// Most bytes of a list for each particle, worth some thousand pairs in lanes: it costs more to read larger ones than
/// to find the pairs of a batch of clusters again.
const MOST_BYTES: u64 = 1024;

/// Nanoseconds of one thread for each particle of a new list, for each pair of cluster and block that it holds, for each
/// of them when it is pruned, and at each step: fitted to the melt with skins of 0.4 to 1.9 (docs/performance-log.md). Only
/// their ratios matter. Steps cost more with a thick skin, though they do not read the list: perhaps because the order of
/// particles decays in the longer time that it serves.
const SORTING: f64 = 140.0;
const LISTING: f64 = 9.0;
const PRUNING: f64 = 3.3;
const STEPPING: f64 = 1.2;

/// The same for lists that serve for a number of steps; computing the pairs of an inner list costs the kernel's 45 ns over
/// the 3.6 that a particle of the melt has.
const COSTS: ListCosts =
    ListCosts { sorting: SORTING, listing: LISTING, pruning: PRUNING, keeping: STEPPING, computing: 12.5 };

/// The pair list and how it is kept.
pub(super) struct StoredClusters {
    pub clusters: Clusters,
    pub listing: Listing,
    /// What lists may miss.
    tolerance: Option<Tolerance>,
    /// Evaluations since the list was built.
    age: u64,
    /// Steps that had been taken when the list was built; none where there is no list, or one that may miss pairs.
    built_at: Option<u64>,
    /// Whether the list must not outlive the present moment: see [`StoredClusters::end`].
    ended: AtomicBool,
}

/// Whether there can be a list; otherwise pairs are found in the grid at each evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Listing {
    Possible,
    /// The list was larger than the memory budget or than is good: pairs are found anew for each evaluation.
    TooLarge,
    /// Radii differ from particle to particle.
    DifferentRadii,
}

impl StoredClusters {
    pub fn new(plan: &Plan, physics: &Physics, state: &State) -> Self {
        let listing = if physics.radii.is_uniform() { Listing::Possible } else { Listing::DifferentRadii };
        let tolerance = Tolerance::new(plan, physics, state);
        let clusters = Clusters::default();
        Self { clusters, listing, tolerance, age: 0, built_at: None, ended: AtomicBool::new(false) }
    }

    /// Has list and forces made anew before the next step. Another engine that takes the particles over has no list:
    /// the order of sums, which is that of the list, would tell it from this one.
    pub fn end(&self) {
        self.ended.store(true, Relaxed);
    }

    /// Whether list and forces have ended; the list is then forgotten.
    pub fn forget_if_ended(&mut self) -> bool {
        let ended = std::mem::take(self.ended.get_mut());
        if ended {
            // With what it has learned of the particles' motion.
            self.clusters = Clusters::default();
            self.tolerance.iter_mut().for_each(Tolerance::forget);
            self.built_at = None;
        }
        ended
    }

    /// Forgets the list: particles were put in another order.
    pub fn invalidate(&mut self) {
        self.clusters.invalidate();
        self.built_at = None;
    }

    /// Has the skin of the next list chosen, after what the last one was good for.
    fn choose_skin(&mut self, skin: &mut SkinTuner, state: &State, dt: f32, steps: u64) {
        let last = self.built_at.take().map(|built| (steps - built, self.clusters.counts()));
        if let Some((steps, Counts { entries, prunings, .. })) = last {
            let per_step = prunings.saturating_sub(1) as f64 / steps.max(1) as f64;
            skin.record(ListUse {
                steps: steps as f64,
                sorting: SORTING * state.len() as f64,
                listing: (LISTING + PRUNING) * entries as f64,
                reading: (STEPPING + PRUNING * per_step) * entries as f64,
            });
        } else if skin.is_auto() {
            skin.guess(dt * state.velocity.largest_norm());
        }
    }
}

impl Loaded {
    /// Brings the list up to date with the positions, or the grid where there can be no list.
    pub fn prepare_clusters(&mut self, step: u64) {
        let Self { physics, state, results, upkeep, clusters: stored, report, skin, dt, steps, .. } = self;
        stored.age += 1;
        let start = Instant::now();
        let list = stored.listing == Listing::Possible;
        let calm = || stored.tolerance.as_ref().is_none_or(|tolerance| tolerance.allows(state));
        let force = stored.clusters.knows_forces().then_some(&results.force);
        let moving = state.moving_slices(force, &physics.interaction.types, *dt);
        let serves = list && stored.clusters.refresh(moving, calm);
        report.refit_seconds += start.elapsed().as_secs_f64();
        if serves {
            return;
        }
        let start = Instant::now();
        stored.clusters.fetch_positions(&mut state.position);
        let tolerant = stored.tolerance.as_mut().filter(|_| list);
        let tolerant = tolerant.and_then(|tolerance| tolerance.choose(&stored.clusters, state, skin, *dt, &COSTS));
        if list && tolerant.is_none() {
            stored.choose_skin(skin, state, *dt, *steps);
        }
        let input = state.input(physics, state.radii(physics));
        upkeep.update(Action::Build, &input, report);
        let gridded = start.elapsed();
        if list && skin.skin() == 0.0 {
            let due = self.reordering_is_due(step);
            if self.find_sparse_pairs(due) {
                self.sorted_at = if due { Some(step) } else { self.sorted_at };
                self.report.list_builds += 1;
                self.report.build_seconds += (start.elapsed() - gridded).as_secs_f64();
                return;
            }
        }
        let Self { plan, physics, state, results, upkeep, clusters: stored, report, skin, dt, steps, .. } = self;
        if stored.listing != Listing::DifferentRadii {
            let grid = upkeep.index.grid().expect("cluster has a grid");
            state.reorder(grid.order());
            let knows_forces = stored.clusters.knows_forces();
            if knows_forces {
                results.reorder(grid.order());
            }
            let force = knows_forces.then_some(&results.force);
            let moving = state.moving_slices(force, &physics.interaction.types, *dt);
            let budget = plan.memory_budget.min(MOST_BYTES * state.len() as u64);
            let strict = |skin: &SkinTuner| Keeping::Strict { skin: skin.skin() };
            let mut keeping = tolerant.map_or_else(|| strict(skin), Keeping::Tolerant);
            let mut fits = list && stored.clusters.build(grid, physics, moving, keeping, budget);
            while list && !fits && (matches!(keeping, Keeping::Tolerant(_)) || skin.shrink()) {
                keeping = strict(skin);
                fits = stored.clusters.build(grid, physics, moving, keeping, budget);
            }
            if fits {
                report.list_builds += 1;
                (report.skin, report.tolerant_lists, stored.built_at) = match keeping {
                    Keeping::Strict { skin } => (skin, None, Some(*steps)),
                    Keeping::Tolerant(lists) => (lists.outer_reach - physics.cutoff(), Some(lists), None),
                };
                if stored.age == 1 && report.skin > 0.0 && report.list_builds > 1 {
                    report.dangerous_builds += 1;
                }
                stored.age = 0;
            } else {
                if list {
                    (stored.listing, stored.clusters) = (Listing::TooLarge, Clusters::default());
                }
                stored.clusters.build_without_list(grid, physics, moving);
            }
        }
        report.build_seconds += (start.elapsed() - gridded).as_secs_f64();
    }

    /// Forces, and energies where results have room; `None` when radii differ, else whether all forces are finite.
    pub fn evaluate_clusters(&mut self) -> Option<bool> {
        let Self { plan, physics, results, upkeep, clusters: stored, report, .. } = self;
        let grid = match stored.listing {
            Listing::Possible => None,
            Listing::TooLarge => upkeep.index.grid(),
            Listing::DifferentRadii => return None,
        };
        report.batched_evaluations += u64::from(grid.is_some());
        let out = Output {
            force: results.force.axes_mut().map(|axis| &mut axis[..]),
            energy: &mut results.energy,
            virial: &mut results.virial,
            neighbors: &mut results.neighbors,
        };
        Some(stored.clusters.evaluate(physics, grid, plan.deterministic, out))
    }
}
