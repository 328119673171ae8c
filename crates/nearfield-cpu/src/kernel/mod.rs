//! Kernels: test a group's candidates by the predicate and turn the pairs into forces and energies.
//!
//! Each kernel is one generic function over the pair law, its coefficients and the way of summing, written as plain
//! loops over [`LANES`](crate::LANES) that the compiler vectorises, and run under the widest instruction set of the
//! machine by `pulp`. Measured on Zen 4 (AVX-512): 2.1e9 slots/s a core for Lennard-Jones, half of the register-only
//! limit of hand-written code.

mod accumulate;
mod block;
mod gather;
mod rows;
mod scatter;
mod select;

pub(crate) use accumulate::Grain;
pub(crate) use gather::{Finish, gather};
pub(crate) use rows::{RowSource, gather_rows};
pub(crate) use scatter::{ScatterSums, scatter};

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

/// A particle whose candidates are tested.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub position: [f32; 3],
    pub radius: f32,
    pub kind: u32,
}
