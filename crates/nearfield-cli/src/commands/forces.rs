//! `nearfield forces`: one single-point evaluation.

use super::{configuration, note_radii, print_json, print_line};
use crate::{
    arguments::{Forces, How},
    failure::Failure,
};
use nearfield::{
    Boundary, CoreError, Engine, Error, Method, PerParticle, Plan, Quantities, Skin, System,
    config::{Choice, Config},
    engine, file_system, io,
};
use serde::Serialize;
use std::time::Instant;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    n: usize,
    pairs: u64,
    potential_energy: f64,
    virial: f64,
    max_force: f64,
    device: String,
    method: Method,
    seconds: f64,
}

pub fn run(arguments: &Forces) -> Result<(), Failure> {
    let mut config = match &arguments.config {
        Some(path) => configuration(path, &[])?,
        None => Config::default(),
    };
    let interaction = &mut config.interaction;
    if let Some(cutoff) = arguments.cutoff {
        interaction.cutoff = cutoff;
    }
    if let Some(truncation) = arguments.truncation {
        interaction.truncation = truncation.into();
    }
    for kind in &mut interaction.types {
        kind.epsilon = arguments.epsilon.unwrap_or(kind.epsilon);
        kind.sigma = arguments.sigma.unwrap_or(kind.sigma);
    }
    config.validate()?;
    if let Some(path) = arguments.output.as_ref().filter(|path| path.extension() != Some("csv".as_ref())) {
        return Err(Failure::request(format!("{}: forces are written as .csv", path.display())));
    }
    // The boundaries of the command line, else of the configuration file, else of the input.
    let configured = || arguments.config.as_ref().map(|_| config.boundary.axes());
    let boundary: Option<[Boundary; 3]> = arguments.how.boundary.or_else(configured);
    let system = file_system(&config, &arguments.input, boundary)?;
    let of_input = |source| Error::Input { file: io::input_name(&arguments.input), source };
    if system.particles.is_empty() {
        return Err(of_input(CoreError::Empty).into());
    }
    note_radii(&system.radii);
    let mut engine = engine(arguments.how.device)?;
    let plan = plan(&mut *engine, &system, &arguments.how)?;
    let start = Instant::now();
    engine.load(&system, &plan)?;
    let totals = engine.evaluate(Quantities::ALL).map_err(of_input)?;
    let seconds = start.elapsed().as_secs_f64();
    if let Some(path) = &arguments.output {
        let mut results = PerParticle::default();
        engine.per_particle(&mut results)?;
        io::write_forces_csv(path, &results)?;
    }
    let tail = if config.interaction.tail_correction {
        system.tail_correction().unwrap_or_default()
    } else {
        Default::default()
    };
    let summary = Summary {
        n: system.particles.len(),
        pairs: totals.pairs,
        potential_energy: totals.potential_energy + tail.energy,
        virial: totals.virial + tail.virial,
        max_force: totals.max_force,
        device: engine.device(),
        method: plan.method,
        seconds,
    };
    if arguments.how.json {
        return print_json(&summary);
    }
    let Summary { n, pairs, potential_energy, virial, max_force, device, method, .. } = summary;
    print_line(&format!("{}: {n} particles, {pairs} pairs within range", io::input_name(&arguments.input)));
    print_line(&format!("potential energy {potential_energy}"));
    print_line(&format!("virial           {virial}"));
    print_line(&format!("largest force    {max_force}"));
    print_line(&format!("method {method} on {device}, {:.3} ms", seconds * 1e3));
    Ok(())
}

/// The plan for a single evaluation. `auto` is `cell`: trying others would take longer than the evaluation.
pub(super) fn plan(engine: &mut dyn Engine, system: &System, how: &How) -> Result<Plan, Failure> {
    let method = match how.method {
        Choice::Of(method) => method,
        Choice::Auto => Method::Cell,
    };
    let mut plan = Plan { order: how.order, skin: Skin::NONE, ..Plan::new(method) };
    if let Choice::Of(images) = how.images {
        plan.images = images;
    }
    engine.supports(system, &plan)?;
    Ok(plan)
}
