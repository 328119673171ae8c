//! One experiment of a suite.

use super::Start;
use nearfield_core::Plan;

/// A system and the plans by which it is computed.
#[derive(Clone, Debug)]
pub struct Case {
    /// What tells it from the other cases of the suite at the same number of particles, as in `lattice r=1 wall`.
    pub name: String,
    /// Cases of a family differ in size or range only, so that the time of one predicts that of the next.
    pub family: String,
    /// The input.
    pub start: Start,
    /// How it is computed.
    pub plans: Vec<Plan>,
    /// What is measured.
    pub measure: Measure,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// Whole steps: upkeep of the structure, forces, integration.
    Steps,
    /// The same in one run of so many steps from the start, as particles leave it.
    Run {
        /// Number of steps.
        steps: u64,
    },
    /// Force evaluations of particles at rest.
    Evaluations,
    /// Structure and query time of each of so many steps, once.
    Series {
        /// Number of steps.
        steps: u64,
    },
    /// Electrical energy of at least so many seconds of steps.
    Energy {
        /// Duration, \[s\].
        seconds: f64,
    },
}
