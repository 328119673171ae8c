//! `nearfield run`: a simulation from a configuration file.

use super::{configuration, note_radii, print_line, print_note};
use crate::{arguments::Run as RunArguments, failure::Failure, progress::RunBar};
use nearfield::{
    Report, Skin,
    config::Config,
    run::{CHECKPOINT, Record, Run},
};
use std::{
    ops::ControlFlow,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
};

pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let config = config(arguments)?;
    if arguments.print_config {
        print_line(config.to_toml()?.trim_end());
        return Ok(());
    }
    let output = config.output.directory.clone();
    let last_step = config.dynamics.steps;
    let run = if arguments.resume { Run::resume(config)? } else { Run::new(config)? };
    let simulation = run.simulation();
    if let Some(moved) = run.moved() {
        print_note(&format!("an earlier run in {} was moved to {}", output.display(), moved.display()));
    }
    print_note(&format!("{} particles on {}", simulation.n_particles(), simulation.device()));
    note_radii(simulation.radii());
    let first = simulation.choice().clone();
    print_note(&match arguments.explain {
        true => first.explain(),
        false => format!("method {}: {}", first.method, first.reason),
    });
    print_note(&format!("steps {} to {last_step}, output in {}", simulation.step(), output.display()));
    let bar = RunBar::new(simulation.step(), last_step, simulation.n_particles());
    let stop = stop_on_interrupt();
    let outcome = run.execute(&mut |progress| {
        bar.update(&progress);
        if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.clear();
    let record = outcome?;
    if arguments.explain {
        if record.method != first {
            print_note(&record.method.explain());
        }
        if let Some(steps) = record.steps_per_list {
            let how = match record.plan.skin {
                Skin::Auto if record.report.tolerant_lists.is_some() => "chosen by what lists may miss",
                Skin::Auto => "chosen from what the lists before cost and how long they served",
                Skin::Fixed(_) => "chosen by the user",
            };
            print_note(&format!("skin {:.3}: {how}; a list served {steps:.1} steps", record.report.skin));
        }
        if let Some(lists) = record.report.tolerant_lists {
            print_note(&format!(
                "lists that may miss pairs: reach {:.3} for {} steps, pruned to {:.3} for {}; expected drift of energy {:.1e} \
                 per particle and time, of {:.1e} allowed",
                lists.outer_reach,
                lists.rebuild_every,
                lists.inner_reach,
                lists.prune_every,
                lists.expected_drift,
                record.plan.list_tolerance
            ));
        }
    } else if record.method.reason != first.reason {
        print_note(&format!("method {}: {}", record.method.method, record.method.reason));
    }
    summarise(&record, &output);
    Ok(())
}

fn config(arguments: &RunArguments) -> Result<Config, Failure> {
    let mut config = match &arguments.config {
        Some(path) => configuration(path, &arguments.set)?,
        None => Config::parse("", &arguments.set, "")?,
    };
    if let Some(device) = arguments.device {
        config.method.device = device;
    }
    if let Some(method) = arguments.method {
        config.method.name = method;
    }
    if let Some(steps) = arguments.steps {
        config.dynamics.steps = steps;
    }
    if let Some(directory) = &arguments.output {
        config.output.directory.clone_from(directory);
    }
    config.validate()?;
    Ok(config)
}

/// Set by the first Ctrl-C: the run then ends after the present step with a checkpoint. A second one kills.
fn stop_on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let seen = stop.clone();
    let handler = move || {
        if seen.swap(true, Relaxed) {
            std::process::exit(1);
        }
        print_note("\ninterrupted: finishing the step and writing a checkpoint (again to quit at once)");
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        print_note(&format!("warning: Ctrl-C will not write a checkpoint: {error}"));
    }
    stop
}

fn summarise(record: &Record, output: &Path) {
    let report = &record.report;
    print_line(&format!(
        "{} steps of {} particles in {:.2} s: {:.1} steps/s, {:.2} million particle-steps/s",
        record.steps - record.resumed_from.unwrap_or(0),
        record.n_particles,
        record.wall_seconds,
        record.steps_per_second,
        record.particle_steps_per_second / 1e6
    ));
    if let Some(t) = record.thermo {
        let n = record.n_particles as f64;
        print_line(&format!(
            "temperature {:.5}, energy per particle {:.6} (potential {:.6}), pressure {:.5}",
            t.temperature,
            t.total_energy / n,
            t.potential_energy / n,
            t.pressure
        ));
    }
    print_line(&format!(
        "{} structure builds ({:.3} s), {} refits ({:.3} s), {}, queries {:.3} s, integration {:.3} s",
        report.builds,
        report.build_seconds,
        report.refits,
        report.refit_seconds,
        lists(report),
        report.query_seconds,
        report.integrate_seconds
    ));
    // Where the skin is ours to choose, one step was the best there was.
    if report.dangerous_builds > 0 && record.plan.skin != Skin::Auto {
        print_note(&format!(
            "warning: {} of {} lists lasted one step only; no pair was missed, but a larger method.skin would be faster",
            report.dangerous_builds, report.list_builds
        ));
    }
    let names = ["thermo.csv", "rdf.csv", "msd.csv", "run.json", CHECKPOINT].map(Path::new);
    let names = [names[0], &record.config.output.trajectory].into_iter().chain(names[1..].iter().copied());
    let written: Vec<_> = names.filter(|name| output.join(name).exists()).map(|name| name.to_string_lossy()).collect();
    print_line(&format!("in {}: {}", output.display(), written.join(", ")));
}

/// How many lists there were, how long they served, and the skin of the last.
fn lists(report: &Report) -> String {
    match report.steps_per_list() {
        Some(steps) => {
            format!("{} lists of {steps:.1} steps (the last with a skin of {:.3})", report.list_builds, report.skin)
        }
        None => "no lists".into(),
    }
}
