//! Whole steps.

use super::{MIN_REPETITIONS, SINGLE, Trial};
use crate::{
    Result,
    bench::{Measurement, Spread},
};
use nearfield_core::Quantities;
use std::time::Instant;

/// Most steps of a repetition.
const MAX_STEPS: u64 = 500;
/// Steps of a repetition where lists last many: some are to be built in each.
const LIST_STEPS: u64 = 50;

/// Steps after which all kernels are there.
const WARM_UP: u64 = 3;

impl Trial<'_> {
    /// One run.
    pub(super) fn run(&mut self, steps: u64, measurement: &mut Measurement) -> Result<()> {
        self.advance(WARM_UP, Quantities::FORCES)?;
        let (seconds, _) = self.advance(steps, Quantities::FORCES)?;
        measurement.time = Spread::of(vec![seconds / steps as f64]);
        measurement.steps = steps;
        Ok(())
    }

    /// Repetitions of so many steps that each takes a part of the time or less.
    pub(super) fn steps(&mut self, measurement: &mut Measurement) -> Result<()> {
        // The first step after the start evaluates twice, and lists are new.
        self.advance(1, Quantities::FORCES)?;
        let (second, _) = self.advance(1, Quantities::FORCES)?;
        let fit = self.seconds / MIN_REPETITIONS as f64 / second.max(1e-9);
        let least = if self.keeps_lists { ((SINGLE * fit) as u64).clamp(1, LIST_STEPS) } else { 1 };
        let steps = (fit as u64).clamp(least, MAX_STEPS);
        let mut times = Vec::new();
        let begin = Instant::now();
        while self.repeat(&times, begin) {
            let (seconds, _) = self.advance(steps, Quantities::FORCES)?;
            times.push(seconds / steps as f64);
        }
        measurement.time = Spread::of(times);
        measurement.steps = steps;
        Ok(())
    }
}
