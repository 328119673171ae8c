//! Paper A's `gradient` (section 3.1): rebuild after the number of refits that minimises the modelled cost.
//!
//! With rebuild cost t_r, refit cost t_u and a query time that grows by Δq per step since the rebuild, eq. (8) gives
//! k = -1 + sqrt(1 + 2 (t_r - t_u) / Δq). Its eq. (5) integrates k²/2 where the sum over steps is k(k+1)/2; summed
//! exactly the optimum is -1 + sqrt(2 (t_r - t_u) / Δq). The policy keeps the paper's formula.

use super::{Action, Motion, Policy};
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
    optimal_updates(rebuild, refit, growth).map(|k| {
        if k > 0.0 { (-1.0 + (2.0 * (rebuild - refit) / growth).sqrt()).max(0.0) } else { 0.0 }
    })
}

/// Weight of the newest build or refit time in its running mean.
const SMOOTHING: f64 = 0.3;
/// Refits after which the structure is rebuilt even though queries seem not to slow down: bounds the harm of a
/// wrong estimate, and at this rate a rebuild costs nothing.
const MAX_UPDATES: f64 = 2000.0;
/// Refits in a cycle before its own slope is trusted alone; until then the last cycle's slope is mixed in.
const WINDOW: f64 = 8.0;

/// The optimiser: running means of build and refit time, and the least-squares slope of the query time over the
/// steps since the last rebuild.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gradient {
    rebuild: Option<f64>,
    refit: Option<f64>,
    /// Slope of the previous cycle.
    last_growth: Option<f64>,
    cycle: Slope,
}

/// Least squares of query time over step number within one cycle.
#[derive(Clone, Copy, Debug, Default)]
struct Slope {
    n: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
}

impl Slope {
    fn add(&mut self, y: f64) {
        let x = self.n;
        self.n += 1.0;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
    }

    fn value(&self) -> Option<f64> {
        let denominator = self.n * self.xx - self.x * self.x;
        (self.n >= 3.0).then(|| (self.n * self.xy - self.x * self.y) / denominator)
    }
}

impl Gradient {
    /// Growth of the query time per step: this cycle's slope, mixed with the last cycle's while samples are few.
    fn growth(&self) -> Option<f64> {
        match (self.cycle.value(), self.last_growth) {
            (Some(now), Some(last)) => {
                let trust = (self.cycle.n / WINDOW).min(1.0);
                Some(trust * now + (1.0 - trust) * last)
            }
            // A first cycle of few samples is mostly noise: wait for the window.
            (Some(now), None) => (self.cycle.n >= WINDOW).then_some(now),
            (None, last) => last,
        }
    }
}

impl Policy for Gradient {
    fn decide(&mut self, _: Motion) -> Action {
        let updates = self.cycle.n - 1.0;
        let (Some(rebuild), Some(refit)) = (self.rebuild, self.refit) else { return Action::Refit };
        let due = match self.growth() {
            None => false,
            Some(growth) => match optimal_updates(rebuild, refit, growth) {
                Some(optimum) => updates >= optimum.round(),
                None => false,
            },
        };
        if due || updates >= MAX_UPDATES { Action::Build } else { Action::Refit }
    }

    fn record(&mut self, cost: StepCost) {
        let mean = |old: Option<f64>, new: f64| Some(old.map_or(new, |old| old + SMOOTHING * (new - old)));
        if cost.built {
            self.rebuild = mean(self.rebuild, cost.structure);
            self.last_growth = self.growth();
            self.cycle = Slope::default();
        } else {
            self.refit = mean(self.refit, cost.structure);
        }
        self.cycle.add(cost.query);
    }
}
