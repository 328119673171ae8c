//! Paper A's `gradient` (section 3.1): rebuild after the number of refits that minimises the modelled cost.
//!
//! With rebuild cost t_r, refit cost t_u and a query time that grows by Δq per step since the rebuild, eq. (8) gives
//! k = -1 + sqrt(1 + 2 (t_r - t_u) / Δq). Its eq. (5) integrates k²/2 where the sum over steps is k(k+1)/2; summed
//! exactly the optimum is -1 + sqrt(2 (t_r - t_u) / Δq). The policy keeps the paper's formula.

use super::{
    Action, Motion, Policy,
    robust::{self, RecentMedian, Sample},
};
use crate::engine::StepCost;

/// Optimal refits between rebuilds, paper A eq. (8). Zero when a rebuild is no dearer than a refit, `None` when
/// queries do not slow down (`growth <= 0`): then there is no reason to rebuild.
pub fn optimal_updates(rebuild: f64, refit: f64, growth: f64) -> Option<f64> {
    if rebuild <= refit {
        Some(0.0)
    } else if growth <= 0.0 {
        None
    } else {
        Some(-1.0 + (1.0 + 2.0 * (rebuild - refit) / growth).sqrt())
    }
}

/// The optimum of the cost summed exactly over the steps instead of integrated.
pub fn optimal_updates_exact(rebuild: f64, refit: f64, growth: f64) -> Option<f64> {
    optimal_updates(rebuild, refit, growth)
        .map(|k| if k > 0.0 { (-1.0 + (2.0 * (rebuild - refit) / growth).sqrt()).max(0.0) } else { 0.0 })
}

/// Part of a step's cost for which the structure is rebuilt however little queries seem to slow down: bounds the harm of a
/// wrong estimate, and tells what a new structure gains.
const SHARE: f64 = 0.005;
/// Most refits between rebuilds.
const MAX_UPDATES: f64 = 2000.0;
/// Rebuilds between which queries of a new structure tell how the system itself changes.
const FRESH: usize = 8;
/// Samples before the slope of the very first cycle is believed.
const WINDOW: usize = 8;
/// Refits measured before "a rebuild is no dearer" is believed: under that guard none is measured any more.
const MIN_REFITS: usize = 3;
/// Share of the evidence kept from one cycle to the next, so that the estimate follows a changing system.
const MEMORY: f64 = 0.75;
/// The most a positive growth may rise or fall by from one cycle to the next: what a single wild cycle can do.
const MAX_CHANGE: f64 = 2.0;
/// Rebuilds in a row after which one step refits all the same: where every step rebuilds, neither refits nor the
/// growth are measured, and a wrong measurement would rule for ever.
const PROBE_AFTER: u32 = 64;

/// The optimiser: recent medians of build and refit time, and a robust slope of the query time over the steps since
/// the last rebuild.
///
/// Two estimates of the slope are weighted by their evidence, the cube of the number of steps each was fitted to (the
/// inverse variance of a fitted slope): what earlier cycles left, and the running cycle. Early in a cycle the former
/// rules, so that the noise of a few samples cannot end it; a cycle longer than those before trusts itself.
///
/// Queries also become slower or faster because the system changes: in a cluster that flies apart they become so much
/// faster that the structure's decay does not show. No rebuild changes that, so it is taken off: it is the slope of the
/// first query times after rebuilds.
#[derive(Clone, Debug, Default)]
pub struct Gradient {
    rebuild: RecentMedian,
    refit: RecentMedian,
    query: RecentMedian,
    past: Option<Growth>,
    /// Query times since the last rebuild, the rebuilt step's first.
    queries: Vec<Sample>,
    /// First query times after the last rebuilds.
    fresh: Vec<Sample>,
    steps: f64,
    rebuilds_in_a_row: u32,
}

/// Growth of the query time per step, and how much it is worth.
#[derive(Clone, Copy, Debug)]
struct Growth {
    slope: f64,
    evidence: f64,
}

impl Gradient {
    /// Past and running cycle together.
    fn growth(&self) -> Option<Growth> {
        let n = self.queries.len();
        let trend = self.trend();
        let now =
            robust::slope(&self.queries).map(|slope| Growth { slope: slope - trend, evidence: (n as f64).powi(3) });
        match (self.past, now) {
            (Some(past), Some(now)) => {
                let evidence = past.evidence + now.evidence;
                let mean = (past.slope * past.evidence + now.slope * now.evidence) / evidence;
                let slope = match past.slope {
                    positive if positive > 0.0 => mean.clamp(positive / MAX_CHANGE, positive * MAX_CHANGE),
                    _ => mean,
                };
                Some(Growth { slope, evidence })
            }
            (Some(past), None) => Some(past),
            (None, now) => now.filter(|_| n >= WINDOW),
        }
    }

    /// What a query of a new structure costs more from step to step.
    fn trend(&self) -> f64 {
        let fresh = if self.fresh.len() > FRESH / 2 { &self.fresh[..] } else { &[] };
        robust::slope(fresh).unwrap_or(0.0)
    }

    /// Refits after which a rebuild costs little beside all that was done since the last one.
    fn most_updates(&self, rebuild: f64, refit: f64) -> f64 {
        let step = refit + self.query.value().unwrap_or(0.0);
        ((rebuild - refit) / (SHARE * step)).clamp(WINDOW as f64, MAX_UPDATES)
    }
}

impl Policy for Gradient {
    fn decide(&mut self, _: Motion) -> Action {
        let updates = self.queries.len().saturating_sub(1) as f64;
        let (Some(rebuild), Some(refit)) = (self.rebuild.value(), self.refit.value()) else { return Action::Refit };
        let optimum = if rebuild <= refit {
            (self.refit.count() >= MIN_REFITS).then_some(0.0)
        } else {
            self.growth().and_then(|growth| optimal_updates(rebuild, refit, growth.slope))
        };
        let probe = self.rebuilds_in_a_row >= PROBE_AFTER;
        let due = !probe && optimum.is_some_and(|optimum| updates >= optimum.round());
        if due || updates >= self.most_updates(rebuild, refit) { Action::Build } else { Action::Refit }
    }

    fn record(&mut self, cost: StepCost) {
        let query = Sample { step: self.steps, value: cost.query };
        self.steps += 1.0;
        self.query.add(cost.query);
        if cost.built {
            self.rebuild.add(cost.structure);
            self.past = self.growth().map(|g| Growth { evidence: g.evidence * MEMORY, ..g });
            self.queries.clear();
            self.rebuilds_in_a_row += 1;
            if self.fresh.len() == FRESH {
                self.fresh.remove(0);
            }
            self.fresh.push(query);
        } else {
            self.refit.add(cost.structure);
            self.rebuilds_in_a_row = 0;
        }
        self.queries.push(query);
    }
}
