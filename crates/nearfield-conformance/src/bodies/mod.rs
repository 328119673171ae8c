//! The test bodies, by what they are about. Each panics when the engine breaks a promise.

pub mod ensembles;
pub mod forces;
pub mod large;
pub mod limits;
pub mod motion;
pub mod neighbors;
pub mod plans;
pub mod reports;

use crate::Body;

/// Every body with its name, for harnesses that decide at run time what to run; `engine_tests!` stamps the same list.
pub fn all() -> Vec<(&'static str, Body)> {
    let mut all = crate::small_bodies!(bodies_as_data;).to_vec();
    all.extend(crate::large_bodies!(bodies_as_data;));
    all
}
