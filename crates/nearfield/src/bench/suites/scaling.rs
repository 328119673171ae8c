//! Time and memory of a particle by system size, at one density. Not in the papers.

use super::{plans, with_images};
use crate::bench::{Case, Measure, Options, Start};
use nearfield_core::Method;

/// Above this, only the basic methods with the default images.
const ALL_LIMIT: usize = 1_000_000;

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let full = [10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
    let of = |n| {
        let plans = if n > ALL_LIMIT {
            let basic = [Method::Cell, Method::Cluster, Method::RtBoxes];
            plans(n).into_iter().filter(|plan| basic.contains(&plan.method)).collect()
        } else {
            plans(n).into_iter().flat_map(with_images).collect()
        };
        Case { name: "gas".into(), family: "gas".into(), start: Start::gas(n), plans, measure: Measure::Steps }
    };
    options.sizes(&[1000, 4000, 16_000, 64_000], &full).into_iter().map(of).collect()
}
