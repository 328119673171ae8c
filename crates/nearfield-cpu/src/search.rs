//! Other questions to a structure: how many pairs, each pair in turn, and the neighbours of points of another set.

use crate::list::{ListBuilder, Queries, Rows, Rule, empty_list};
use crate::{Grid, Input, Structure};
use nearfield_core::{ListKind, ListRequest, NeighborList};
use std::ops::ControlFlow;

/// Groups listed at once by [`for_each_pair`]: enough to amortise the call, few enough to stay in the cache.
const GROUPS: usize = 16;

/// Two particles within range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The smaller index, in input order.
    pub i: u32,
    /// The larger index.
    pub j: u32,
    /// `dr = (x_j - x_i) + image * box length`.
    pub image: [i8; 3],
    /// Squared distance, \[length²\].
    pub r2: f32,
}

/// Numbers of neighbours.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Neighbours of each particle, `[N]`, in input order.
    pub neighbors: Vec<u32>,
    /// Pairs, each counted once.
    pub pairs: u64,
}

/// Counts neighbours without storing them. `structure` was built from `input`.
pub fn count_neighbors(structure: &dyn Structure, input: &Input) -> Counts {
    let mut neighbors = Vec::new();
    let pairs = ListBuilder::default().count(structure, input, &mut neighbors);
    Counts { neighbors, pairs }
}

/// Calls `visit` once for each pair, in no particular order, on this thread, until it breaks. Nothing is stored
/// but a few groups' pairs. `structure` was built from `input`.
///
/// ```
/// use nearfield_core::{Boundary, SimBox};
/// use nearfield_cpu::{Grid, Input, InputRadii, for_each_pair};
/// use std::ops::ControlFlow;
/// let sim_box = SimBox::cubic(10.0, Boundary::Open)?;
/// let x = [1.0, 2.0, 3.0];
/// let input = Input { sim_box: &sim_box, position: [&x, &x, &x], radii: InputRadii::Uniform(2.0), kind: &[] };
/// let mut grid = Grid::new();
/// grid.build(&input);
/// let first = for_each_pair(&grid, &input, |pair| ControlFlow::Break(pair.r2));
/// assert_eq!(first, ControlFlow::Break(3.0));
/// # Ok::<(), nearfield_core::Error>(())
/// ```
pub fn for_each_pair<B>(
    structure: &dyn Structure,
    input: &Input,
    mut visit: impl FnMut(Pair) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let mut rows = Rows::default();
    let n_groups = structure.n_groups();
    for first in (0..n_groups).step_by(GROUPS) {
        rows.list(structure, input, first..(first + GROUPS).min(n_groups), ListKind::Half, true, true);
        for row in rows.iter() {
            for ((&j, &image), &r2) in row.neighbors.iter().zip(row.images).zip(row.r2) {
                let i = row.particle;
                visit(if i < j {
                    Pair { i, j, image, r2 }
                } else {
                    Pair { i: j, j: i, image: image.map(|s| -s), r2 }
                })?;
            }
        }
    }
    ControlFlow::Continue(())
}

/// The points of `structure` within the radius of each query: row `q` holds the points with distance < radius of `q`.
///
/// Queries are points of their own, inside the box on periodic axes; their radii are at most half a periodic length.
/// Radii of the points mean nothing here. `structure` must be [`Structure::complete`]; the kind of `request` does
/// not matter.
pub fn bipartite_list(structure: &dyn Structure, queries: &Input, request: ListRequest) -> NeighborList {
    // A grid of the queries themselves puts them into compact groups.
    let mut groups = Grid::new();
    groups.build(queries);
    let request = ListRequest { kind: ListKind::Full, ..request };
    let mut list = empty_list(request);
    let from = Queries::new(&groups, queries);
    ListBuilder::default().list(structure, queries.sim_box, from, queries.len(), Rule::Bipartite, request, &mut list);
    list
}

#[cfg(test)]
mod tests;
