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

    /// Runs for at least `duration` seconds. Pairs are counted before and after, since a step with energies takes longer
    /// than one without, and their mean stands for all steps.
    pub(super) fn energy(&mut self, duration: f64, measurement: &mut Measurement) -> Result<()> {
        // The first step evaluates the forces at the start, too.
        self.advance(1, Quantities::FORCES)?;
        let (mut energy, mut meter) = self.meter();
        let mut read = || meter.as_mut().map_or(0.0, EnergyMeter::joules);
        let mut times = Vec::new();
        let (origin, mut last, mut chunk) = (read(), (0.0, 0.0), 1);
        let begin = Instant::now();
        while energy.seconds < duration {
            let (seconds, _) = self.advance(chunk, Quantities::FORCES)?;
            times.push(seconds / chunk as f64);
            energy.steps += chunk;
            energy.joules = read() - origin;
            energy.seconds = begin.elapsed().as_secs_f64();
            if energy.meter.is_some() {
                energy.power.push((energy.seconds, (energy.joules - last.1) / (energy.seconds - last.0)));
            }
            last = (energy.seconds, energy.joules);
            chunk = ((INTERVAL * chunk as f64 / seconds.max(1e-9)) as u64).clamp(1, 10 * chunk);
        }
        let (_, pairs) = self.advance(0, Quantities::ALL)?;
        energy.interactions = 0.5 * (measurement.pairs + pairs) as f64 * energy.steps as f64;
        measurement.steps = energy.steps;
        measurement.time = Spread::of(times);
        measurement.energy = Some(energy);
        Ok(())
    }
}
