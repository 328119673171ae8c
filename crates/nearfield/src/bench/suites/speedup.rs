//! Time by number of particles, and speedup over cells on the CPU: paper A, figures 9 (walls) and 10 (periodic).
//!
//! The paper does not list its sizes; its figures end at a million.

use super::{paper_a, paper_a_grid};
use crate::bench::{Case, Options};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let full = [10_000, 30_000, 100_000, 300_000, 1_000_000];
    let sizes = options.sizes(&[1000, 4000], &full);
    let of = |n| paper_a_grid().map(move |(positions, radii, boundary)| paper_a(n, positions, radii, boundary));
    sizes.into_iter().flat_map(of).collect()
}
