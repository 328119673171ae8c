//! `auto`: the fastest method that supports the system, by measurement on the device at hand.

use nearfield_core::{Engine, Error, Maintenance, Method, Order, Plan, Quantities, Result, System};
use serde::Serialize;
use std::time::{Duration, Instant};

/// How the method was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// Why, in a sentence.
    pub reason: String,
    /// Seconds of one force evaluation, of each candidate that was tried.
    pub measured: Vec<(Method, f64)>,
}

/// Particles below which all pairs are worth a try.
const BRUTE_LIMIT: usize = 2000;
/// A candidate this much slower than the best at its first evaluation is not measured further.
const HOPELESS: f64 = 3.0;
/// Evaluations timed, after a first one that also warms buffers.
const REPETITIONS: usize = 3;
/// Steps that a list of `cluster` is taken to serve. In a Lennard-Jones liquid it is 7 with the default skin.
const STEPS_PER_LIST: f64 = 7.0;
/// Once a candidate has taken so long, the next ones are only tried if their first evaluation is quicker.
const PATIENCE: Duration = Duration::from_secs(2);

/// The method the user chose.
pub fn chosen(method: Method) -> Choice {
    Choice { method, reason: "chosen by the user".into(), measured: Vec::new() }
}

/// Measures one force evaluation, structure included, of every method that supports the system, and picks the
/// fastest. `plan` gives all settings but the method.
///
/// # Errors
/// As [`Engine::evaluate`]. A start with overlaps that cannot be evaluated without a cap falls back to `cell`.
pub fn choose(engine: &mut dyn Engine, system: &System, plan: &Plan) -> Result<Choice> {
    let fallback = |reason: &str| Choice { method: Method::Cell, reason: reason.into(), measured: Vec::new() };
    if system.particles.is_empty() {
        return Ok(fallback("nothing to measure"));
    }
    let mut measured: Vec<(Method, f64)> = Vec::new();
    let mut too_large = None;
    let begin = Instant::now();
    // Not the rays of paper B, which find what those of rt-boxes find in more steps.
    let candidates = [
        Method::Cell,
        Method::Cluster,
        Method::RtBoxes,
        Method::RtPerse,
        Method::RtForces,
        Method::RtList,
        Method::Brute,
    ];
    for method in candidates {
        let too_many = method == Method::Brute && system.particles.len() > BRUTE_LIMIT;
        let skin = plan.skin;
        let plan = trial_plan(plan, method);
        if too_many || engine.supports(system, &plan).is_err() {
            continue;
        }
        if begin.elapsed() > PATIENCE && !measured.is_empty() {
            break;
        }
        let best = measured.iter().map(|&(_, seconds)| seconds).fold(f64::INFINITY, f64::min);
        match measure(engine, system, &plan, best).and_then(|built| with_list(engine, system, &plan, skin, built)) {
            Ok(seconds) => measured.push((method, seconds)),
            Err(Error::Coincident(..) | Error::NonFinite { .. }) => {
                return Ok(fallback("particles overlap, so evaluations could not be timed; cell is the safe choice"));
            }
            // What does not fit for one method may fit for another.
            Err(error @ Error::OutOfMemory { .. }) => too_large = Some(error),
            Err(error) => return Err(error),
        }
    }
    if let (true, Some(error)) = (measured.is_empty(), too_large) {
        return Err(error);
    }
    let (method, seconds) =
        measured.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((Method::Cell, f64::NAN));
    let others: Vec<String> =
        measured.iter().filter(|(m, _)| *m != method).map(|(m, s)| format!("{m} {:.3} ms", s * 1e3)).collect();
    let reason =
        format!("fastest of those measured: {:.3} ms a force evaluation ({})", seconds * 1e3, others.join(", "));
    Ok(Choice { method, reason, measured })
}

/// Particles do not move between the evaluations of a trial, so each of them must build: a list or a refitted tree
/// that is as good as new would look cheaper than it is.
fn trial_plan(plan: &Plan, method: Method) -> Plan {
    let order = if plan.order == Order::None { Order::None } else { Order::Morton };
    Plan { method, order, maintenance: Maintenance::Every, skin: 0.0, ..*plan }
}

/// What an evaluation of `cluster` costs when a list serves several steps, from that of one that `built` its list: the
/// method is nothing without. For other methods, `built`.
fn with_list(engine: &mut dyn Engine, system: &System, plan: &Plan, skin: f32, built: f64) -> Result<f64> {
    if plan.method != Method::Cluster || skin == 0.0 {
        return Ok(built);
    }
    let kept = measure(engine, system, &Plan { skin, ..*plan }, f64::INFINITY)?;
    Ok(kept + (built - kept).max(0.0) / STEPS_PER_LIST)
}

fn measure(engine: &mut dyn Engine, system: &System, plan: &Plan, best: f64) -> Result<f64> {
    engine.load(system, plan)?;
    let start = Instant::now();
    engine.evaluate(Quantities::FORCES)?;
    let first = start.elapsed().as_secs_f64();
    if first > HOPELESS * best {
        return Ok(first);
    }
    let mut times = Vec::new();
    for _ in 0..REPETITIONS {
        let start = Instant::now();
        engine.evaluate(Quantities::FORCES)?;
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok(times[REPETITIONS / 2])
}
