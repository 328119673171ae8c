//! One file a suite.

pub(super) mod energy;
pub(super) mod generations;
pub(super) mod md;
pub(super) mod methods;
pub(super) mod neighbors;
pub(super) mod policies;
pub(super) mod primitives;
pub(super) mod scaling;
pub(super) mod speedup;

use super::{
    Case, Measure, Start,
    start::{POSITIONS, PaperRadii},
};
use crate::generate::Positions;
use nearfield_core::{Boundary, Images, Maintenance, Method, Plan, Skin};

/// Particles above which all pairs are too many to be of interest.
const BRUTE_LIMIT: usize = 20_000;

/// Skin of lists in paper A's cases: the same everywhere, so that machines are compared by the same work.
const SKIN: Skin = Skin::Fixed(0.3);

/// Every method with its defaults, all pairs for small systems only.
fn plans(n: usize) -> Vec<Plan> {
    let methods = Method::ALL.iter().filter(|&&method| method != Method::Brute || n <= BRUTE_LIMIT);
    methods.map(|&method| Plan::new(method)).collect()
}

/// Plans whose evaluations of particles at rest each build everything anew, as a single evaluation must. (A list that
/// lasts many steps, or a refitted tree, would look cheaper than it is.)
fn plans_at_rest(n: usize) -> Vec<Plan> {
    let at_rest = |plan: Plan| Plan { maintenance: Maintenance::Every, skin: Skin::NONE, ..plan };
    plans(n).into_iter().map(at_rest).collect()
}

/// A case of paper A.
fn paper_a(n: usize, positions: Positions, radii: PaperRadii, boundary: Boundary) -> Case {
    let name = paper_a_name(positions, radii, boundary);
    let start = Start::paper_a(n, positions, radii, boundary, 1.0);
    let plans = plans(n).into_iter().map(|plan| Plan { skin: SKIN, ..plan }).collect();
    Case { family: name.clone(), name, start, plans, measure: Measure::Steps }
}

/// Names of all of paper A's cases, in the order of its table 2.
pub fn paper_a_names() -> Vec<String> {
    paper_a_grid().map(|(positions, radii, boundary)| paper_a_name(positions, radii, boundary)).collect()
}

fn paper_a_name(positions: Positions, radii: PaperRadii, boundary: Boundary) -> String {
    format!("{} {} {}", format!("{positions:?}").to_lowercase(), radii.name(), format!("{boundary:?}").to_lowercase())
}

/// Every combination of positions, radii and boundary of paper A's evaluation.
fn paper_a_grid() -> impl Iterator<Item = (Positions, PaperRadii, Boundary)> {
    let boundaries = [Boundary::Wall, Boundary::Periodic];
    let of = move |boundary| {
        PaperRadii::ALL.into_iter().flat_map(move |radii| POSITIONS.map(|positions| (positions, radii, boundary)))
    };
    boundaries.into_iter().flat_map(of)
}

/// The three cases that paper A selects for energy and scaling (section 4.3), with walls and periodic.
fn representative(n: [usize; 3], measure: Measure) -> Vec<Case> {
    let chosen = [
        (Positions::Lattice, PaperRadii::Large),
        (Positions::Disordered, PaperRadii::One),
        (Positions::Cluster, PaperRadii::LogNormal),
    ];
    let mut cases = Vec::new();
    for boundary in [Boundary::Wall, Boundary::Periodic] {
        for ((positions, radii), n) in chosen.into_iter().zip(n) {
            let case = Case { measure, ..paper_a(n, positions, radii, boundary) };
            let plans = case.plans.into_iter().filter(|plan| plan.method != Method::Brute).collect();
            cases.push(Case { plans, ..case });
        }
    }
    cases
}

/// Every treatment of periodic images, for methods that have one.
fn with_images(plan: Plan) -> Vec<Plan> {
    if plan.method.uses_bvh() {
        Images::ALL.iter().map(|&images| Plan { images, ..plan }).collect()
    } else {
        vec![plan]
    }
}
