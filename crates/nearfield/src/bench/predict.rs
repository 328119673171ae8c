//! What an evaluation will take, from smaller cases of the family.

use super::{Case, Outcome, Record};
use nearfield_core::{Engine, Method, Plan, Quantities};
use std::time::Instant;

/// Particles from which a case without smaller ones in its family is scouted out first.
const SCOUTED: usize = 50_000;
/// How many times smaller the scout's system is.
const SMALLER: usize = 16;

/// Predicted seconds of one evaluation; `None` where the family has not been measured by this plan.
///
/// The work of an evaluation is taken as n (1 + k) with k neighbours a particle, or n² for all pairs. On a GPU that is
/// not full this says too much, the less so the closer the sizes of a sweep.
pub(super) fn evaluation_seconds(case: &Case, plan: &Plan, records: &[Record], device: &str) -> Option<f64> {
    let n = case.start.generate.n;
    let known_neighbors = records.iter().filter(|r| r.case == case.name && r.n == n).find_map(neighbors);
    let (record, seconds, k) = records
        .iter()
        .filter(|r| r.family == case.family && r.plan == *plan && r.device == device)
        .filter_map(|r| match &r.outcome {
            Outcome::Measured(m) => Some((r, m.evaluation_seconds, m.neighbors)),
            // All pairs take the same time with any number of neighbours, and there may be no case to measure.
            Outcome::TooSlow { predicted_seconds, .. } if plan.method == Method::Brute => {
                Some((r, *predicted_seconds, 0.0))
            }
            _ => None,
        })
        .max_by(|a, b| (a.0.n as f64 * (1.0 + a.2)).total_cmp(&(b.0.n as f64 * (1.0 + b.2))))?;
    let here = known_neighbors.unwrap_or(k * case.start.crowding() / record.input.crowding());
    Some(seconds * work(plan.method, n, here) / work(plan.method, record.n, k))
}

/// Predicted seconds of one evaluation, from a smaller system that is made for it: a large one cannot be stopped once it
/// has begun. `None` for small cases, and where the smaller system cannot be computed.
pub(super) fn scout(engine: &mut dyn Engine, case: &Case, plan: &Plan) -> Option<f64> {
    let n = case.start.generate.n;
    if n < SCOUTED {
        return None;
    }
    let mut start = case.start.clone();
    start.generate.n = n / SMALLER;
    let system = start.build().ok()?;
    engine.load(&system, plan).ok()?;
    // The first evaluation warms up.
    let pairs = engine.advance(&start.dynamics, 0, 0, Quantities::ALL).ok()?.pairs;
    let begin = Instant::now();
    engine.advance(&start.dynamics, 0, 0, Quantities::FORCES).ok()?;
    let seconds = begin.elapsed().as_secs_f64();
    let small = system.particles.len();
    let k = 2.0 * pairs as f64 / small as f64;
    let here = k * case.start.crowding() / start.crowding();
    Some(seconds * work(plan.method, n, here) / work(plan.method, small, k))
}

fn neighbors(record: &Record) -> Option<f64> {
    match &record.outcome {
        Outcome::Measured(measurement) => Some(measurement.neighbors),
        _ => None,
    }
}

fn work(method: Method, n: usize, neighbors: f64) -> f64 {
    n as f64 * if method == Method::Brute { n as f64 } else { 1.0 + neighbors }
}
