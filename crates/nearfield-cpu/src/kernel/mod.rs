//! Kernels: test a group's candidates by the predicate and turn the pairs into forces and energies.
//!
//! Each kernel is one generic function over the pair law, its coefficients and the way of summing, written as plain
//! loops over [`LANES`](crate::LANES) that the compiler vectorises, and compiled for each instruction set by
//! [`crate::lanes`].

mod accumulate;
mod block;
mod gather;
mod group;
mod rows;
mod scatter;
pub(crate) mod select;

pub(crate) use accumulate::Grain;
use block::evaluate;
pub(crate) use gather::gather;
pub(crate) use rows::{RowSource, gather_rows};
pub(crate) use scatter::{ScatterSums, scatter};
pub(crate) use select::with_law;

/// What a query's pairs add up to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sums {
    /// Force on the query particle.
    pub force: [f32; 3],
    /// Half of the energy of its pairs.
    pub energy: f64,
    /// Half of the virial of its pairs.
    pub virial: f64,
    /// Number of its neighbours.
    pub neighbors: u32,
}

/// Receives the sums of each particle, once, in no particular order and from any thread.
pub(crate) type Finish<'a> = &'a (dyn Fn(u32, &Sums) + Sync);

/// A particle whose candidates are tested.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub position: [f32; 3],
    pub radius: f32,
    pub kind: u32,
    pub particle: u32,
}
