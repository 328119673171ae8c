//! Whole steps of the Lennard-Jones melt: density 0.8442, cutoff 2.5. Not in the papers.

use super::plans;
use crate::bench::{Case, Measure, Options, Start};
use nearfield_core::Plan;

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let of = |n| {
        let start = Start::melt(n);
        // Sums that depend on no order; methods on a BVH always take such on the CPU.
        let both = |plan: Plan| [plan, Plan { deterministic: true, ..plan }];
        let plans = plans(start.generate.n).into_iter().flat_map(both).collect();
        Case { name: "melt".into(), family: "melt".into(), start, plans, measure: Measure::Steps }
    };
    options.sizes(&[4000, 32_000], &[32_000, 256_000, 2_048_000]).into_iter().map(of).collect()
}
