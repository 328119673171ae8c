//! Power and energy: paper A, figures 11 and 12.

use super::Trial;
use crate::{
    Result,
    bench::{Energy, Measurement, Spread},
    energy::EnergyMeter,
};
use nearfield_core::Quantities;
use std::time::Instant;

/// Seconds between readings: counters are refreshed every 100 ms or faster.
const INTERVAL: f64 = 0.2;

impl Trial<'_> {
    /// The device's meter, where there is one, and a record that says so.
    pub(super) fn meter(&self) -> (Energy, Option<EnergyMeter>) {
        match EnergyMeter::of(self.device) {
            Ok(meter) => (Energy { meter: Some(meter.name().into()), ..Energy::default() }, Some(meter)),
            Err(reason) => (Energy { no_meter: Some(reason), ..Energy::default() }, None),
        }
    }

    /// Runs for at least `duration` seconds. Interactions are counted at each reading.
    pub(super) fn energy(&mut self, duration: f64, measurement: &mut Measurement) -> Result<()> {
        let (mut energy, mut meter) = self.meter();
        let mut read = || meter.as_mut().map_or(0.0, EnergyMeter::joules);
        let mut times = Vec::new();
        let (origin, mut last, mut chunk) = (read(), (0.0, 0.0), 1);
        let begin = Instant::now();
        while energy.seconds < duration {
            let (seconds, pairs) = self.advance(chunk, Quantities::ALL)?;
            times.push(seconds / chunk as f64);
            energy.steps += chunk;
            energy.interactions += pairs as f64 * chunk as f64;
            energy.joules = read() - origin;
            energy.seconds = begin.elapsed().as_secs_f64();
            if energy.meter.is_some() {
                energy.power.push((energy.seconds, (energy.joules - last.1) / (energy.seconds - last.0)));
            }
            last = (energy.seconds, energy.joules);
            chunk = ((INTERVAL * chunk as f64 / seconds.max(1e-9)) as u64).clamp(1, 10 * chunk);
        }
        measurement.steps = energy.steps;
        measurement.time = Spread::of(times);
        measurement.energy = Some(energy);
        Ok(())
    }
}
