//! The CPU engine: structures (grid, BVH, all pairs) that propose candidates, and consumers that test and use them.
//!
//! Every method is one sentence: a [`Structure`] turns a group of queries into runs of candidate slots, and a consumer
//! applies the predicate to them and does something with the pairs. Structures and consumers know nothing of each
//! other, so each combination is exact once each part is.

mod brute;
mod engine;
mod kernel;
mod exact_sum;
mod parallel;
mod physics;
mod slots;
mod structure;

pub use brute::Brute;
pub use engine::CpuEngine;
pub use slots::{Input, InputRadii, LANES, Slots};
pub use structure::{GroupBox, Run, Structure};
