//! The CPU engine: structures (grid, BVH, all pairs) that propose candidates, and consumers that test and use them.
//!
//! Every method is one sentence: a [`Structure`] turns a group of queries into runs of candidate slots, and a consumer
//! applies the predicate to them and does something with the pairs. Structures and consumers know nothing of each
//! other, so each combination is exact once each part is.

mod brute;
mod bvh;
mod candidates;
mod cluster;
mod engine;
mod exact_sum;
mod grid;
mod kernel;
mod lanes;
mod list;
mod parallel;
mod physics;
mod prefetch;
mod search;
mod slots;
mod sparse;
mod structure;
#[cfg(test)]
mod testing;

pub use brute::Brute;
pub use bvh::{Bvh, Probe, Ray, Refit};
pub use engine::CpuEngine;
pub use grid::{Grid, Vicinity};
pub use list::{ListBuilder, Row, Rows, neighbor_list};
pub use search::{Counts, Pair, bipartite_list, count_neighbors, for_each_pair};
pub use slots::{Input, InputRadii, LANES, Slots};
pub use structure::{GroupBox, Run, Structure};

/// Name of the instruction set that kernels run with here.
pub fn instruction_set() -> &'static str {
    lanes::Isa::detect().name()
}
