//! Measurements, and where they are written.

use crate::{Arguments, cases::Case};
use nearfield_core::{Engine, Error, ListKind, ListRequest, Plan, Quantities};
use nearfield_cuda::CudaEngine;
use serde_json::{Value, json};
use std::{
    fs::{File, OpenOptions},
    io::Write,
    time::Instant,
};

/// Seconds that only an evaluation takes, not the compilation of its programs.
const LONGER_THAN_COMPILING: f64 = 5.0;

/// Most steps of one call.
const MAX_STEPS: u64 = 200;

/// What became of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    Measured,
    TooLong,
    Skipped,
}

/// The engine under test and the results so far.
pub struct Bench {
    engine: CudaEngine,
    seconds: f64,
    patience: f64,
    stop_after: f64,
    filter: String,
    quick: bool,
    start: Instant,
    output: Option<File>,
}

impl Bench {
    pub fn new(engine: CudaEngine, arguments: &Arguments) -> Self {
        let open = |path| OpenOptions::new().create(true).append(true).open(path).expect("the output can be written");
        Self {
            engine,
            seconds: arguments.seconds,
            patience: arguments.patience,
            stop_after: arguments.stop_after,
            filter: arguments.filter.clone(),
            quick: arguments.quick,
            start: Instant::now(),
            output: arguments.output.as_ref().map(open),
        }
    }

    /// Whole steps: milliseconds a step, and bytes.
    pub fn steps(&mut self, suite: &str, case: &Case, plan: &Plan) -> Outcome {
        if !self.wants(case) || self.engine.supports(&case.system, plan).is_err() {
            return Outcome::Skipped;
        }
        let measured = self.measure_steps(case, plan);
        self.conclude(suite, case, plan, measured)
    }

    /// A structure built and neighbours counted, then listed in CSR, all left on the device.
    pub fn search(&mut self, suite: &str, case: &Case, plan: &Plan) -> Outcome {
        if !self.wants(case) || self.engine.supports(&case.system, plan).is_err() {
            return Outcome::Skipped;
        }
        let measured = self.measure_search(case, plan);
        self.conclude(suite, case, plan, measured)
    }

    fn wants(&self, case: &Case) -> bool {
        case.name.contains(&self.filter) && self.start.elapsed().as_secs_f64() < self.stop_after
    }

    fn measure_steps(&mut self, case: &Case, plan: &Plan) -> Result<Option<Value>, Error> {
        self.engine.load(&case.system, plan)?;
        let mut step = 0;
        let mut advance = |engine: &mut CudaEngine, steps: u64| -> Result<f64, Error> {
            let start = Instant::now();
            engine.advance(&case.dynamics, step, steps, Quantities::FORCES)?;
            step += steps;
            Ok(start.elapsed().as_secs_f64() / steps as f64)
        };
        // By `advance`, so that overlaps are allowed where they are.
        let evaluate = |engine: &mut CudaEngine| -> Result<f64, Error> {
            let start = Instant::now();
            engine.advance(&case.dynamics, 0, 0, Quantities::FORCES)?;
            Ok(start.elapsed().as_secs_f64())
        };
        let mut evaluation = evaluate(&mut self.engine)?;
        // The first also compiles ray-tracing programs.
        if evaluation < LONGER_THAN_COMPILING {
            evaluation = evaluate(&mut self.engine)?;
        }
        if evaluation > self.patience {
            return Ok(Some(json!({
                "one_evaluation": true,
                "ms": evaluation * 1e3,
                "batched": self.engine.report().batched_evaluations,
            })));
        }
        let first = advance(&mut self.engine, 1)?;
        let quick = if evaluation + first < self.seconds { advance(&mut self.engine, 3)? } else { first };
        let steps = ((self.seconds / 3.0 / quick) as u64).clamp(1, MAX_STEPS);
        let mut times = Vec::new();
        let start = Instant::now();
        while times.len() < 3 || (start.elapsed().as_secs_f64() < self.seconds && times.len() < 15) {
            times.push(advance(&mut self.engine, steps)?);
            if start.elapsed().as_secs_f64() > 20.0 * self.seconds {
                break;
            }
        }
        let totals = self.engine.evaluate(Quantities::ALL)?;
        let report = self.engine.report();
        let n = case.system.particles.len() as f64;
        Ok(Some(json!({
            "ms": median(&mut times) * 1e3,
            "ms_least": times[0] * 1e3,
            "ms_most": times[times.len() - 1] * 1e3,
            "repeats": times.len(),
            "steps": steps,
            "neighbors": 2.0 * totals.pairs as f64 / n,
            "bytes_per_particle": report.bytes as f64 / n,
            "builds": report.builds,
            "refits": report.refits,
            "list_builds": report.list_builds,
            "batched": report.batched_evaluations,
            "build_ms": 1e3 * report.build_seconds / report.builds.max(1) as f64,
            "refit_ms": 1e3 * report.refit_seconds / report.refits.max(1) as f64,
            "query_ms": 1e3 * report.query_seconds / report.evaluations.max(1) as f64,
        })))
    }

    fn measure_search(&mut self, case: &Case, plan: &Plan) -> Result<Option<Value>, Error> {
        self.engine.load(&case.system, plan)?;
        let request = ListRequest { shifts: false, ..ListRequest::new(ListKind::Full) };
        let entries = self.engine.list_on_device(request)?.index.len();
        let count = self.repeat(|engine| engine.count_on_device().map(drop))?;
        let list = self.repeat(|engine| engine.list_on_device(request).map(drop))?;
        Ok(Some(json!({
            "ms_count": count * 1e3,
            "ms_list": list * 1e3,
            "entries": entries,
            "neighbors": entries as f64 / case.system.particles.len() as f64,
        })))
    }

    /// Median seconds of a call that ends with the device's work.
    fn repeat(&mut self, call: impl Fn(&mut CudaEngine) -> Result<(), Error>) -> Result<f64, Error> {
        let mut times = Vec::new();
        let start = Instant::now();
        while times.len() < 5 || (start.elapsed().as_secs_f64() < self.seconds && times.len() < 200) {
            let start = Instant::now();
            call(&mut self.engine)?;
            self.engine.synchronize()?;
            times.push(start.elapsed().as_secs_f64());
        }
        Ok(median(&mut times))
    }

    fn conclude(&mut self, suite: &str, case: &Case, plan: &Plan, measured: Result<Option<Value>, Error>) -> Outcome {
        let (mut record, outcome) = match measured {
            Ok(Some(value)) if value.get("one_evaluation").is_some() => (value, Outcome::TooLong),
            Ok(Some(value)) => (value, Outcome::Measured),
            Ok(None) => return Outcome::Skipped,
            Err(error) => (json!({ "error": error.to_string() }), Outcome::Skipped),
        };
        let fields = record.as_object_mut().expect("records are objects");
        for (key, value) in [
            ("suite", json!(suite)),
            ("case", json!(case.name)),
            ("n", json!(case.system.particles.len())),
            ("device", json!(self.engine.device())),
            ("plan", json!(plan)),
            ("variant", json!(self.engine.cluster_variant().map(|variant| variant.to_string()))),
            ("version", json!(env!("CARGO_PKG_VERSION"))),
        ] {
            fields.insert(key.into(), value);
        }
        let numbers = [
            "ms",
            "ms_count",
            "ms_list",
            "neighbors",
            "build_ms",
            "refit_ms",
            "query_ms",
            "bytes_per_particle",
            "one_evaluation",
            "error",
        ]
        .iter()
        .filter_map(|&key| {
            record.get(key).map(|value| match value.as_f64() {
                Some(number) => format!("{key} {number:.4}"),
                None => format!("{key} {value}"),
            })
        })
        .collect::<Vec<_>>();
        if self.quick {
            println!("{record}");
            return outcome;
        }
        let exact = if plan.deterministic { " exact" } else { "" };
        let variant = record["variant"].as_str().map(|variant| format!(" {variant}")).unwrap_or_default();
        println!("{:<40} {:<10} {:<9}{exact}{variant} {}", case.name, plan.method, plan.images, numbers.join("  "));
        if let Some(output) = &mut self.output {
            writeln!(output, "{record}").expect("the output can be written");
        }
        outcome
    }
}

/// Sorts, and gives the one in the middle.
fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
