//! The cost of each step: paper A, figure 8.

use super::Trial;
use crate::{
    Result,
    bench::{Measurement, Series, Spread},
    energy::EnergyMeter,
};
use nearfield_core::{Quantities, StepCost};

/// How often interactions are counted in a run.
const COUNTS: u64 = 20;

impl Trial<'_> {
    /// Runs once, with the cost of each step recorded.
    pub(super) fn series(&mut self, steps: u64, measurement: &mut Measurement) -> Result<()> {
        let n = self.system.particles.len() as f64;
        // Evaluations before the first step are no part of the run.
        let before = self.engine.report().history.len();
        let mut series = Series { interactions: vec![(0, measurement.pairs as f64 / n)], ..Series::default() };
        let (mut energy, mut meter) = self.meter();
        while self.step < steps {
            let chunk = (steps / COUNTS).clamp(1, steps - self.step);
            let (seconds, pairs) = self.advance(chunk, Quantities::ALL)?;
            energy.seconds += seconds;
            energy.interactions += pairs as f64 * chunk as f64;
            series.interactions.push((self.step, pairs as f64 / n));
        }
        let mut history = self.engine.report().history.split_off(before);
        // A step at which pairs are counted takes longer: the one before stands for it.
        let first = history.len().saturating_sub(steps as usize);
        for &(step, _) in series.interactions.iter().filter(|&&(step, _)| step > 1) {
            let at = first + step as usize - 1;
            history[at] = StepCost { built: history[at].built, ..history[at - 1] };
        }
        let micro = |seconds: f64| (seconds * 1e7).round() / 10.0;
        series.structure = history.iter().map(|cost| micro(cost.structure)).collect();
        series.query = history.iter().map(|cost| micro(cost.query)).collect();
        series.builds = (0..history.len()).filter(|&k| history[k].built).collect();
        energy.joules = meter.as_mut().map_or(0.0, EnergyMeter::joules);
        energy.steps = steps;
        measurement.time = Spread::of(vec![energy.seconds / steps as f64]);
        measurement.steps = steps;
        measurement.series = Some(series);
        measurement.energy = Some(energy);
        Ok(())
    }
}
