//! What an evaluation will take, from smaller cases of the family.

use super::{Case, Outcome, Record};
use nearfield_core::{Method, Plan};

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
            _ => None,
        })
        .max_by(|a, b| (a.0.n as f64 * (1.0 + a.2)).total_cmp(&(b.0.n as f64 * (1.0 + b.2))))?;
    let here = known_neighbors.unwrap_or(k * case.start.crowding() / record.input.crowding());
    Some(seconds * work(plan.method, n, here) / work(plan.method, record.n, k))
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
