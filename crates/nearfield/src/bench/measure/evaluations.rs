//! Force evaluations of particles at rest.

use super::Trial;
use crate::{
    Result,
    bench::{Measurement, Spread},
};
use std::time::Instant;

impl Trial<'_> {
    /// Single evaluations, one after the other.
    pub(super) fn evaluations(&mut self, measurement: &mut Measurement) -> Result<()> {
        let mut times = Vec::new();
        let begin = Instant::now();
        while self.repeat(&times, begin) {
            times.push(self.evaluation()?);
        }
        measurement.time = Spread::of(times);
        Ok(())
    }
}
