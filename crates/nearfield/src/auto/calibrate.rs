//! The constants of a device, by measurement: what `nearfield bench auto` does.

use super::{Cost, DeviceProfile, Profile, Survey, trial};
use crate::{Device, Result, bench::Start, engine, generate::Generate};
use nearfield_core::{Dynamics, Engine, Method, Plan, System};
use std::collections::BTreeMap;

/// Mean numbers of neighbours that are measured.
const NEIGHBORS: [f64; 4] = [0.5, 8.0, 60.0, 400.0];
/// Numbers of particles on a CPU; the last takes a minute on two cores.
const SIZES_CPU: [usize; 4] = [400, 4_000, 40_000, 250_000];
/// Numbers of particles on a GPU.
const SIZES_GPU: [usize; 4] = [4_000, 40_000, 400_000, 2_000_000];
/// A method that is predicted to take longer than so many seconds for its trial of a system is not tried on it.
const PATIENCE: f64 = 4.0;

/// A method on a system, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The method.
    pub method: Method,
    /// The system.
    pub survey: Survey,
    /// Seconds of a step.
    pub seconds: f64,
}

/// What was measured, and the constants that fit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The constants.
    pub profile: DeviceProfile,
    /// What they were fitted to.
    pub samples: Vec<Sample>,
}

impl Calibration {
    /// The largest factor by which a sample of a method differs from its prediction.
    pub fn worst_error(&self, method: Method) -> f64 {
        let of_method = self.samples.iter().filter(|sample| sample.method == method);
        let error = |sample: &Sample| {
            let predicted = self.profile.predict(&sample.survey).into_iter().find(|(other, _)| *other == method);
            let ratio = predicted.map_or(1.0, |(_, predicted)| sample.seconds / predicted);
            ratio.max(1.0 / ratio)
        };
        of_method.map(error).fold(1.0, f64::max)
    }
}

/// Measures every candidate of `auto` on gases of several sizes and ranges, the two smallest sizes only where it is to be
/// `quick`, and fits the constants. `progress` is told what comes next and which part is done.
///
/// # Errors
/// A device that cannot be used, or that fails.
pub fn calibrate(device: Device, quick: bool, progress: &mut dyn FnMut(&str, f64)) -> Result<Calibration> {
    let mut engine = engine(device)?;
    let name = engine.device();
    let present = Profile::load().unwrap_or_default();
    // The name of a CPU goes on with threads and instruction set.
    let is_cpu = name.starts_with("cpu");
    let sizes = if is_cpu { SIZES_CPU } else { SIZES_GPU };
    let sizes = if quick { &sizes[..2] } else { &sizes[..] };
    let mut samples = Vec::new();
    for (done, &n) in sizes.iter().enumerate() {
        for (part, &neighbors) in NEIGHBORS.iter().enumerate() {
            let fraction = (done as f64 + part as f64 / NEIGHBORS.len() as f64) / sizes.len() as f64;
            progress(&format!("{n} particles with {neighbors} neighbours"), fraction);
            let Some(start) = gas(n, neighbors) else { continue };
            let system = start.build()?;
            let survey = Survey::of(&system);
            for (method, predicted) in present.of(&name).map(|entry| entry.predict(&survey)).unwrap_or_default() {
                if trial::duration(predicted) > PATIENCE {
                    continue;
                }
                samples.extend(measure(&mut *engine, &system, &start.dynamics, survey, method)?);
            }
        }
    }
    let threads = if is_cpu { rayon::current_num_threads() as f64 } else { 1.0 };
    let methods = Method::ALL.iter().filter(|method| samples.iter().any(|sample| sample.method == **method));
    let fit = |&method: &Method| {
        let of_method = samples.iter().filter(|sample| sample.method == method);
        let measured: Vec<(Survey, f64)> = of_method.map(|sample| (sample.survey, sample.seconds * threads)).collect();
        (method.name().to_owned(), Cost::fit(method, &measured))
    };
    let method: BTreeMap<String, Cost> = methods.map(fit).collect();
    let profile = DeviceProfile {
        name: if is_cpu { "cpu".into() } else { name.clone() },
        source: format!("measured on {name}"),
        per_thread: is_cpu,
        method,
    };
    Ok(Calibration { profile, samples })
}

/// Nothing where the system is not supported or does not fit.
fn measure(
    engine: &mut dyn Engine,
    system: &System,
    dynamics: &Dynamics,
    survey: Survey,
    method: Method,
) -> Result<Option<Sample>> {
    let plan = Plan::new(method);
    if engine.supports(system, &plan).is_err() {
        return Ok(None);
    }
    match trial::seconds_of_step(engine, system, dynamics, 0, &plan) {
        Ok(seconds) => Ok(Some(Sample { method, survey, seconds })),
        Err(nearfield_core::Error::OutOfMemory { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// A periodic gas of density 1; none where its box is too small for the range.
fn gas(n: usize, neighbors: f64) -> Option<Start> {
    let at_rest = Start::uniform(n, neighbors);
    if 2.0 * at_rest.cutoff >= (n as f64).cbrt() {
        return None;
    }
    let generate = Generate { temperature: 1.0, ..at_rest.generate };
    let dynamics = Dynamics { max_displacement: 0.01, ..at_rest.dynamics };
    Some(Start { generate, dynamics, ..at_rest })
}
