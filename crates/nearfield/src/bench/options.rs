//! What the user of a suite can ask for.

use crate::Device;
use nearfield_core::Method;

/// How to run a suite.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Sizes that take about a minute on two processor cores.
    pub quick: bool,
    /// The device.
    pub device: Device,
    /// Measure again what is in the file already; its old lines for this device and these sizes are dropped.
    pub fresh: bool,
    /// Numbers of particles instead of the suite's own.
    pub n: Vec<usize>,
    /// Only these methods; all where empty.
    pub methods: Vec<Method>,
    /// Only cases whose name contains this.
    pub filter: String,
    /// One run of so many steps from the start, where a suite repeats a few.
    pub steps: Option<u64>,
    /// Seconds to spend on each measurement.
    pub seconds: Option<f64>,
    /// A measurement that is predicted to take longer than so many seconds for one evaluation is not begun.
    pub patience: Option<f64>,
    /// No measurement begins after so many seconds; a later call goes on.
    pub stop_after: Option<f64>,
}

impl Options {
    /// Seconds to spend on each measurement.
    pub(super) fn seconds(&self) -> f64 {
        self.seconds.unwrap_or(if self.quick { 0.05 } else { 1.0 })
    }

    pub(super) fn patience(&self) -> f64 {
        self.patience.unwrap_or(if self.quick { 2.0 } else { 120.0 })
    }

    /// The sizes of a suite.
    pub(super) fn sizes(&self, quick: &[usize], full: &[usize]) -> Vec<usize> {
        match (self.n.is_empty(), self.quick) {
            (false, _) => self.n.clone(),
            (true, true) => quick.to_vec(),
            (true, false) => full.to_vec(),
        }
    }

    pub(super) fn wants(&self, method: Method) -> bool {
        self.methods.is_empty() || self.methods.contains(&method)
    }
}
