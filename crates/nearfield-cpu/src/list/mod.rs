//! Neighbour lists from any structure: the runs of a group are gathered once and tested against each of its particles.

mod addresses;
mod copy;
mod csr;
mod mirror;
mod rows;
mod rule;
mod scan;

pub(crate) use copy::copy;
pub(crate) use csr::empty as empty_list;
pub use csr::{ListBuilder, neighbor_list};
pub(crate) use rows::Queries;
pub use rows::{Row, Rows};
pub(crate) use rule::Rule;

#[cfg(test)]
mod tests;
