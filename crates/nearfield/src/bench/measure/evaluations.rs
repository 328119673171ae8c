//! Force evaluations of particles at rest.

use super::Trial;
use crate::{
    Result,
    bench::{Measurement, Spread},
};
use std::time::Instant;

/// Steps that pass between evaluations, so that particles are sorted in memory for each: engines sort now and then.
const APART: u64 = 10_000;

impl Trial<'_> {
    /// Single evaluations, one after the other.
    pub(super) fn evaluations(&mut self, measurement: &mut Measurement) -> Result<()> {
        let before = self.engine.report().history.len();
        let mut times = Vec::new();
        let begin = Instant::now();
        while self.repeat(&times, begin) {
            self.step += APART;
            times.push(self.evaluation()?);
        }
        let queries: Vec<f64> = self.engine.report().history[before..].iter().map(|cost| cost.query).collect();
        let rest = times.iter().zip(&queries).map(|(time, query)| (time - query).max(0.0)).collect();
        measurement.structure_seconds = Spread::of(rest).median;
        measurement.query_seconds = Spread::of(queries).median;
        measurement.time = Spread::of(times);
        Ok(())
    }
}
