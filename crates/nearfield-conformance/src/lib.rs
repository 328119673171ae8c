//! One suite of test bodies for everything that implements [`nearfield_core::Engine`].
//!
//! [`engine_tests!`] stamps the suite on an engine. Bodies ask only what the trait promises: the neighbour set of the
//! one predicate bit for bit, forces within the rounding of f32, and dynamics that obey their conservation laws and
//! distributions. They run each plan of [`plans`] on each input of [`cases`] that the engine says it supports.
//!
//! Where it is known only at run time whether there is a device, [`bodies()`] gives the suite as data.
//!
//! The suite is itself tested: [`OracleEngine`], plain brute force, passes it, and each [`Fault`] that can be planted
//! there is caught (`tests/suite.rs`).

pub mod bodies;
pub mod cases;
mod expected;
mod macros;
mod oracle_engine;
pub mod plans;
mod statistics;

pub use expected::Expected;
pub use oracle_engine::{Fault, OracleEngine};

use nearfield_core::Engine;

/// Makes fresh engines of the kind under test.
pub type Factory<'a> = &'a dyn Fn() -> Box<dyn Engine>;

/// A test of engines; panics when they break a promise.
pub type Body = fn(Factory);

/// Every body with its name, for harnesses that decide at run time what to run; [`engine_tests!`] stamps the same list.
pub fn bodies() -> Vec<(&'static str, Body)> {
    let mut all = small_bodies!(bodies_as_data;).to_vec();
    all.extend(large_bodies!(bodies_as_data;));
    all
}
