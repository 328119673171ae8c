//! Runs a suite.

use super::{
    Case, Machine, Measure, Options, Outcome, Record, Suite,
    file::ResultsFile,
    measure::measure,
    predict::{evaluation_seconds, scout},
};
use crate::{Error, Result, device, engine};
use nearfield_core::{Engine, Error as CoreError, Plan, System};
use std::{path::Path, time::Instant};

/// What is about to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// The suite.
    pub suite: Suite,
    /// Measurements done or found in the file.
    pub done: usize,
    /// All of the suite.
    pub total: usize,
    /// Case, size and method.
    pub what: String,
}

/// How a suite went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Measurements made.
    pub measured: usize,
    /// Found in the file already.
    pub skipped: usize,
    /// Unsupported, out of memory or too slow.
    pub impossible: usize,
    /// Failed, or another number of pairs than other methods found.
    pub wrong: usize,
    /// Left for a later call because the time was over.
    pub left: usize,
}

impl std::ops::AddAssign for Summary {
    fn add_assign(&mut self, other: Self) {
        self.measured += other.measured;
        self.skipped += other.skipped;
        self.impossible += other.impossible;
        self.wrong += other.wrong;
        self.left += other.left;
    }
}

/// Measures what the suite's file in `directory` does not hold yet, and again what failed or was too slow for a smaller
/// patience. `progress` is called before each measurement.
///
/// # Errors
/// A device that cannot be used, a file that cannot be read or written. What fails in a measurement is in its record.
pub fn run(suite: Suite, directory: &Path, options: &Options, progress: &mut dyn FnMut(&Progress)) -> Result<Summary> {
    let mut bench = Bench::new(suite, directory, options)?;
    let cases = cases(suite, options);
    let total = cases.iter().map(|case| case.plans.len()).sum();
    let mut summary = Summary::default();
    let mut done = 0;
    for case in &cases {
        let mut system = None;
        for plan in &case.plans {
            let what = format!("{} n={} {}", case.name, case.start.generate.n, plan.method);
            progress(&Progress { suite, done, total, what });
            done += 1;
            if bench.results.records.iter().any(|record| bench.is(record, case, plan)) {
                summary.skipped += 1;
            } else if bench.is_over() {
                summary.left += 1;
            } else {
                bench.add(case, plan, &mut system, &mut summary)?;
            }
        }
    }
    Ok(summary)
}

/// The cases and plans that are asked for.
fn cases(suite: Suite, options: &Options) -> Vec<Case> {
    let mut cases = suite.cases(options);
    cases.retain(|case| case.name.contains(&options.filter));
    for case in &mut cases {
        if let (Some(steps @ 1..), Measure::Steps) = (options.steps, case.measure) {
            case.name = format!("{}, {steps} steps", case.name);
            case.measure = Measure::Run { steps };
        }
        case.plans.retain(|plan| options.wants(plan.method));
    }
    cases
}

struct Bench<'a> {
    suite: Suite,
    options: &'a Options,
    engine: Box<dyn Engine>,
    /// Name for `--device`.
    device: String,
    machine: Machine,
    results: ResultsFile,
    begin: Instant,
}

impl<'a> Bench<'a> {
    fn new(suite: Suite, directory: &Path, options: &'a Options) -> Result<Self> {
        let engine = engine(options.device)?;
        let (device, _) = device::identity(options.device);
        let cases = cases(suite, options);
        let again = |record: &Record| {
            let is_asked_for = record.device == device
                && record.quick == options.quick
                && cases.iter().any(|case| case.name == record.case && case.start.generate.n == record.n);
            let has_hope = match record.outcome {
                Outcome::Failed { .. } => true,
                Outcome::TooSlow { patience, .. } => patience < options.patience(),
                _ => false,
            };
            is_asked_for && (options.fresh || has_hope)
        };
        let results = ResultsFile::open(directory, suite, |record| !again(record))?;
        Ok(Self { suite, options, engine, device, machine: Machine::this(), results, begin: Instant::now() })
    }

    fn is_over(&self) -> bool {
        self.options.stop_after.is_some_and(|limit| self.begin.elapsed().as_secs_f64() > limit)
    }

    /// Whether a record is of this measurement.
    fn is(&self, record: &Record, case: &Case, plan: &Plan) -> bool {
        let same_device = record.device == self.device && record.device_name == self.engine.device();
        self.is_input(record, case) && same_device && record.plan == *plan
    }

    /// Whether a record is of this input, by whatever method and device.
    fn is_input(&self, record: &Record, case: &Case) -> bool {
        record.case == case.name && record.n == case.start.generate.n && record.quick == self.options.quick
    }

    fn add(&mut self, case: &Case, plan: &Plan, system: &mut Option<System>, summary: &mut Summary) -> Result<()> {
        let outcome = self.outcome(case, plan, system);
        match &outcome {
            Outcome::Measured(_) => summary.measured += 1,
            Outcome::Unsupported { .. } | Outcome::OutOfMemory { .. } | Outcome::TooSlow { .. } => {
                summary.impossible += 1;
            }
            Outcome::Mismatch { .. } | Outcome::Failed { .. } => summary.wrong += 1,
        }
        let record = Record {
            suite: self.suite,
            case: case.name.clone(),
            family: case.family.clone(),
            n: case.start.generate.n,
            quick: self.options.quick,
            device: self.device.clone(),
            device_name: self.engine.device(),
            plan: *plan,
            outcome,
            input: case.start.clone(),
            machine: self.machine.clone(),
        };
        self.results.add(record)
    }

    fn outcome(&mut self, case: &Case, plan: &Plan, system: &mut Option<System>) -> Outcome {
        let predicted = evaluation_seconds(case, plan, &self.results.records, &self.device)
            .or_else(|| scout(&mut *self.engine, case, plan));
        let patience = self.options.patience();
        if let Some(predicted_seconds) = predicted.filter(|&seconds| seconds > patience) {
            return Outcome::TooSlow { predicted_seconds, patience };
        }
        match self.measurement(case, plan, system) {
            Ok(outcome) => outcome,
            Err(Error::Core(error @ CoreError::Unsupported { .. })) => {
                Outcome::Unsupported { reason: error.to_string() }
            }
            Err(Error::Core(error @ CoreError::OutOfMemory { .. })) => {
                Outcome::OutOfMemory { reason: error.to_string() }
            }
            Err(error @ Error::NoMeter { .. }) => Outcome::Unsupported { reason: error.to_string() },
            Err(error) => Outcome::Failed { reason: error.to_string() },
        }
    }

    fn measurement(&mut self, case: &Case, plan: &Plan, system: &mut Option<System>) -> Result<Outcome> {
        let system = match system {
            Some(system) => system,
            none => none.insert(case.start.build()?),
        };
        self.engine.supports(system, plan)?;
        let outcome = measure(&mut *self.engine, system, case, plan, self.options)?;
        let Outcome::Measured(measurement) = &outcome else { return Ok(outcome) };
        let pairs = measurement.pairs;
        let others = self.results.records.iter().filter(|record| self.is_input(record, case));
        let expected = others.into_iter().find_map(|record| match &record.outcome {
            Outcome::Measured(measurement) => Some(measurement.pairs),
            _ => None,
        });
        Ok(match expected.filter(|&expected| expected != pairs) {
            Some(expected) => Outcome::Mismatch { pairs, expected },
            None => outcome,
        })
    }
}
