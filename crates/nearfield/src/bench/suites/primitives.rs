//! What rays hit, against a grid of cells: paper B, figures 9 (uniform in a box) and 10 (on a sphere).
//!
//! n = p beta³ as in the paper's code; its text says p 3^beta. Boxes are also measured with particles as they come, in
//! random order: the paper's "Custom AABB" without and with sorting. Methods that paper B knows nothing of are left out,
//! but for `cluster` and, where there are few particles, all pairs.

use super::plans_at_rest;
use crate::{
    bench::{Case, Measure, Options, Start},
    generate::Workload,
};
use nearfield_core::{Method, Order, Plan};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let (betas, alphas, particles): (&[usize], &[usize], &[usize]) = if options.quick {
        (&[2, 4, 8, 16], &[4, 8, 16], &[1, 4, 16])
    } else {
        (&[2, 4, 8, 16, 32], &[8, 16, 32, 64, 128], &[1, 2, 4, 8, 16, 32])
    };
    let uniform = pairs(betas, particles)
        .map(|(beta, p)| (format!("uniform beta={beta}"), p, Start::paper_b(Workload::uniform(beta, p))));
    let sphere = pairs(alphas, particles)
        .map(|(alpha, p)| (format!("sphere alpha={alpha}"), p, Start::paper_b(Workload::sphere_surface(alpha, p))));
    let limit = options.n.iter().copied().max().unwrap_or(usize::MAX);
    uniform
        .chain(sphere)
        .filter(|(_, _, start)| start.generate.n <= limit)
        .map(|(family, p, start)| Case {
            name: format!("{family} p={p}"),
            plans: plans(start.generate.n),
            family,
            start,
            measure: Measure::Evaluations,
        })
        .collect()
}

fn pairs<'a>(divisors: &'a [usize], particles: &'a [usize]) -> impl Iterator<Item = (usize, usize)> + 'a {
    divisors.iter().flat_map(move |&divisor| particles.iter().map(move |&p| (divisor, p)))
}

fn plans(n: usize) -> Vec<Plan> {
    let mut plans = plans_at_rest(n);
    plans.retain(|plan| !matches!(plan.method, Method::RtList | Method::RtForces | Method::RtPerse));
    let unsorted = plans.iter().find(|plan| plan.method == Method::RtBoxes).map(|&p| Plan { order: Order::None, ..p });
    plans.extend(unsorted);
    plans
}
