//! When to rebuild: paper A, figure 8. n = 140,000, 2000 steps, periodic, the base method (`rt-list`, a list a step).
//!
//! The quick run keeps the paper's density at a smaller n: the box, and radii above 1 with it, shrink, and neighbour
//! counts with them. The paper states neither time step nor velocities; here T = 10, dt = 0.05 and at most one length a
//! step, which carries a particle through several lattice spacings in a run.

use super::paper_a_name;
use crate::bench::{
    Case, Measure, Options, Start,
    start::{POSITIONS, PaperRadii},
};
use nearfield_core::{Boundary, Dynamics, Maintenance, Method, Plan, Skin};

/// The paper's number of particles and steps.
const PAPER: (usize, u64) = (140_000, 2000);
const QUICK: (usize, u64) = (1000, 300);
/// The paper's policies, rebuilding at each step, which it does not show, and its optimiser of energy, where there is a
/// meter.
const POLICIES: [Maintenance; 5] = [
    Maintenance::Gradient,
    Maintenance::Fixed(200),
    Maintenance::Average,
    Maintenance::Every,
    Maintenance::GradientJoules,
];

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let mut cases = Vec::new();
    let steps = if options.quick { QUICK.1 } else { PAPER.1 };
    for n in options.sizes(&[QUICK.0], &[PAPER.0]) {
        let scale = (n as f64 / PAPER.0 as f64).cbrt();
        for radii in PaperRadii::ALL {
            for positions in POSITIONS {
                let name = paper_a_name(positions, radii, Boundary::Periodic);
                let mut start = Start::paper_a(n, positions, radii, Boundary::Periodic, scale);
                start.generate.temperature = 10.0;
                start.dynamics = Dynamics { max_displacement: 1.0, ..Dynamics::nve(0.05) };
                let plan = |maintenance| Plan { maintenance, skin: Skin::NONE, ..Plan::new(Method::RtList) };
                let plans = POLICIES.map(plan).to_vec();
                cases.push(Case { family: name.clone(), name, start, plans, measure: Measure::Series { steps } });
            }
        }
    }
    cases
}
