//! The test bodies, by what they are about. Each panics when the engine breaks a promise.

pub mod ensembles;
pub mod forces;
pub mod large;
pub mod limits;
pub mod motion;
pub mod neighbors;
pub mod plans;
pub mod reports;
