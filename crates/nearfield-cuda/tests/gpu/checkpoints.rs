//! Runs that begin on one device and end on the other.

use nearfield::{
    config::Config,
    run::{Record, Run},
};
use nearfield_core::Plan;
use std::{ops::ControlFlow, path::Path};

/// How far apart the energies of a particle may be at the end. Roundings of 1e-7 grow by the chaos of a liquid: on the
/// CPU, forces summed in another order leave 1.4e-6. States that have nothing to do with each other differ by 1e-2.
const TOLERANCE: f64 = 2e-5;

pub fn from_gpu_to_cpu(plan: &Plan) {
    continues(plan, "cuda:0", "cpu");
}

pub fn from_cpu_to_gpu(plan: &Plan) {
    continues(plan, "cpu", "cuda:0");
}

/// A run of 100 steps that another device resumes ends where a run on that device alone does.
fn continues(plan: &Plan, first: &str, second: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let begun = execute(Run::new(config(plan, folder.path(), "split", first, 100)));
    let resumed = execute(Run::resume(config(plan, folder.path(), "split", second, 200)));
    let whole = execute(Run::new(config(plan, folder.path(), "whole", second, 200)));
    assert_ne!(begun.device, resumed.device);
    assert_eq!((begun.steps, resumed.resumed_from, resumed.steps), (100, Some(100), 200));
    let n = whole.n_particles as f64;
    let (resumed, whole) = (resumed.thermo.expect("a state"), whole.thermo.expect("a state"));
    assert_eq!(resumed.step, whole.step);
    for (what, found, expected) in [
        ("kinetic energy", resumed.kinetic_energy, whole.kinetic_energy),
        ("potential energy", resumed.potential_energy, whole.potential_energy),
    ] {
        let off = (found - expected).abs() / n;
        assert!(off < TOLERANCE, "{plan:?}: {what} of {found} for {expected}, {off:e} for each particle");
    }
}

fn execute(run: nearfield::Result<Run>) -> Record {
    let run = run.unwrap_or_else(|error| panic!("{error}"));
    run.execute(&mut |_| ControlFlow::Continue(())).unwrap_or_else(|error| panic!("{error}"))
}

fn config(plan: &Plan, folder: &Path, output: &str, device: &str, steps: u64) -> Config {
    let text = format!(
        r#"
        [system.generate]
        positions = "fcc"
        n = 2048
        density = 0.8442
        temperature = 1.44
        [interaction]
        truncation = "force"
        [method]
        name = "{}"
        device = "{device}"
        [dynamics]
        dt = 0.004
        steps = {steps}
        [output]
        directory = "{}"
        trajectory_every = 0
        "#,
        plan.method,
        folder.join(output).display()
    );
    Config::parse(&text, &[], folder).unwrap_or_else(|error| panic!("{error}"))
}
