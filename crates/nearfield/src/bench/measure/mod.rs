//! Measurements, one file a kind. All of them end with the device's work: an engine's calls wait for it.

mod energy;
mod evaluations;
mod series;
mod steps;

use super::{Case, Measure, Measurement, Options, Outcome, Spread};
use crate::{Device, Result, energy::attach_meter};
use nearfield_core::{Dynamics, Engine, Plan, Quantities, Skin, System};
use std::time::Instant;

/// Evaluations that take this many times the seconds of a measurement are not repeated.
const SINGLE: f64 = 10.0;
/// A first evaluation that takes longer, in seconds, is not repeated without energies, which may take a tenth.
const ONCE: f64 = 30.0;
/// Most repetitions.
const MAX_REPETITIONS: usize = 50;
/// A run of steps may take this many times as long as one evaluation may.
const RUN: f64 = 10.0;
/// Fewest repetitions, as in paper B.
const MIN_REPETITIONS: usize = 5;

/// A system on an engine, about to be measured.
pub(super) struct Trial<'a> {
    pub engine: &'a mut dyn Engine,
    pub system: &'a System,
    pub dynamics: Dynamics,
    pub device: Device,
    /// Whether lists last several steps.
    pub keeps_lists: bool,
    /// Seconds to spend.
    pub seconds: f64,
    pub step: u64,
}

/// Loads the system and measures.
pub(super) fn measure(
    engine: &mut dyn Engine,
    system: &System,
    case: &Case,
    plan: &Plan,
    options: &Options,
) -> Result<Outcome> {
    // On a GPU, costs are known only where they are recorded or a policy asks for them.
    engine.record_history(matches!(case.measure, Measure::Series { .. } | Measure::Evaluations));
    engine.load(system, plan)?;
    attach_meter(engine, plan, options.device)?;
    let (dynamics, device, seconds) = (case.start.dynamics, options.device, options.seconds());
    let keeps_lists = plan.method.uses_list() && plan.skin != Skin::NONE;
    let mut trial = Trial { engine, system, dynamics, device, keeps_lists, seconds, step: 0 };
    let (mut measurement, is_slow) = trial.first_look()?;
    let predicted_seconds = match case.measure {
        Measure::Series { steps } | Measure::Run { steps } => measurement.evaluation_seconds * steps as f64,
        // A step, and the evaluation before the first.
        Measure::Energy { .. } => 2.0 * measurement.evaluation_seconds,
        Measure::Steps | Measure::Evaluations => 0.0,
    };
    let patience = options.patience();
    if predicted_seconds > RUN * patience {
        return Ok(Outcome::TooSlow { predicted_seconds, patience });
    }
    match case.measure {
        Measure::Series { steps } => trial.series(steps, &mut measurement)?,
        Measure::Energy { seconds } => trial.energy(seconds, &mut measurement)?,
        Measure::Run { steps } => trial.run(steps, &mut measurement)?,
        _ if is_slow => {}
        Measure::Steps => trial.steps(&mut measurement)?,
        Measure::Evaluations => trial.evaluations(&mut measurement)?,
    }
    trial.conclude(&mut measurement);
    Ok(Outcome::Measured(Box::new(measurement)))
}

impl Trial<'_> {
    /// Counts the pairs and times one evaluation, after a first one that warms up. Whether that already took so long that
    /// it is the measurement.
    fn first_look(&mut self) -> Result<(Measurement, bool)> {
        let start = Instant::now();
        // By `advance`, so that overlaps are allowed where the dynamics allow them.
        let pairs = self.engine.advance(&self.dynamics, 0, 0, Quantities::ALL)?.pairs;
        let first = start.elapsed().as_secs_f64();
        let evaluation = if first > ONCE { first } else { first.min(self.evaluation()?) };
        let is_slow = evaluation > SINGLE * self.seconds;
        let measurement = Measurement {
            pairs,
            neighbors: 2.0 * pairs as f64 / self.system.particles.len() as f64,
            evaluation_seconds: evaluation,
            time: Spread::of(vec![evaluation]),
            ..Measurement::default()
        };
        Ok((measurement, is_slow))
    }

    /// Seconds of one evaluation where the particles are.
    fn evaluation(&mut self) -> Result<f64> {
        let start = Instant::now();
        self.engine.advance(&self.dynamics, self.step, 0, Quantities::FORCES)?;
        Ok(start.elapsed().as_secs_f64())
    }

    /// Moves on; seconds and pairs at the end, where they are asked for.
    fn advance(&mut self, steps: u64, quantities: Quantities) -> Result<(f64, u64)> {
        let start = Instant::now();
        let totals = self.engine.advance(&self.dynamics, self.step, steps, quantities)?;
        self.step += steps;
        Ok((start.elapsed().as_secs_f64(), totals.pairs))
    }

    /// Repeats until the time is used up.
    fn repeat(&self, times: &[f64], begin: Instant) -> bool {
        let spent = begin.elapsed().as_secs_f64();
        (times.len() < MIN_REPETITIONS && spent < SINGLE * self.seconds)
            || (times.len() < MAX_REPETITIONS && spent < self.seconds)
    }

    /// Adds what the engine reports.
    fn conclude(&self, measurement: &mut Measurement) {
        let report = self.engine.report();
        let evaluations = report.evaluations.max(1) as f64;
        if measurement.query_seconds == 0.0 {
            measurement.structure_seconds = (report.build_seconds + report.refit_seconds) / evaluations;
            measurement.query_seconds = report.query_seconds / evaluations;
        }
        measurement.builds = report.builds;
        measurement.refits = report.refits;
        measurement.list_builds = report.list_builds;
        measurement.batched_evaluations = report.batched_evaluations;
        let n = self.system.particles.len() as f64;
        measurement.bytes_per_particle = report.bytes as f64 / n;
        measurement.structure_bytes_per_particle = report.structure_bytes as f64 / n;
    }
}
