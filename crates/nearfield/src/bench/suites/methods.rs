//! Every method on every input: paper A, table 2.

use super::{paper_a, paper_a_grid};
use crate::bench::{Case, Options};

pub(in crate::bench) fn cases(options: &Options) -> Vec<Case> {
    let sizes = options.sizes(&[4000], &[50_000, 1_000_000]);
    let of = |n| paper_a_grid().map(move |(positions, radii, boundary)| paper_a(n, positions, radii, boundary));
    sizes.into_iter().flat_map(of).collect()
}
