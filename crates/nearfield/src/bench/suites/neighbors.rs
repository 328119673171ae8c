//! Every method by mean number of neighbours, at one n: where each of them wins. Not in the papers.

use super::plans_at_rest;
use crate::bench::{Case, Measure, Options, Start};
use nearfield_core::{Method, Plan};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let mut cases = Vec::new();
    for n in options.sizes(&[10_000], &[200_000]) {
        let swept = [0.01, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10_000.0];
        // With more, the cutoff would reach beyond half the box.
        for k in swept.into_iter().filter(|&k| k < 0.45 * n as f64) {
            let mut plans = plans_at_rest(n);
            if plans.iter().all(|plan| plan.method != Method::Brute) {
                plans.push(Plan::new(Method::Brute));
            }
            cases.push(Case {
                name: format!("k={k}"),
                family: "uniform".into(),
                start: Start::uniform(n, k),
                plans,
                measure: Measure::Evaluations,
            });
        }
    }
    cases
}
