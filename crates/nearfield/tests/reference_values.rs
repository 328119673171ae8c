//! Every method against published energies: NIST's Lennard-Jones configurations and LAMMPS' forces, read and evaluated
//! the way the command does.
//!
//! The files are not part of this repository: the environment variable `NEARFIELD_DATA` names their folder,
//! `../shared/data` from the workspace root by default; where it is absent these tests are ignored.

use libtest_mimic::{Arguments, Failed, Trial};
use nearfield::{
    Boundary, Device, Images, Interaction, Particles, PerParticle, Plan, Quantities, Radii, SimBox, System, Truncation,
    config::Config, engine, file_system,
};
use std::{
    fs,
    path::{Path, PathBuf},
};

fn main() {
    let data = std::env::var_os("NEARFIELD_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let is_absent = !data.is_dir();
    let mut trials = Vec::new();
    for method in nearfield::methods().into_iter().filter(|row| row.device == "cpu").map(|row| row.method) {
        let images: &[Images] = if method.uses_bvh() { Images::ALL } else { &[Images::Gamma] };
        for &images in images {
            let plan = Plan { images, ..Plan::new(method) };
            let name = if method.uses_bvh() { format!("{method}_{images}") } else { method.to_string() };
            type Test = fn(&Path, &Plan) -> Result<(), Failed>;
            let tests: [(&str, Test); 3] =
                [("nist_energies", nist_energies), ("lammps_melt", lammps_melt), ("lammps_droplet", lammps_droplet)];
            for (test, body) in tests {
                let data = data.clone();
                let trial = Trial::test(format!("{test}_of_{name}"), move || body(&data, &plan));
                trials.push(trial.with_ignored_flag(is_absent));
            }
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A row of NIST's table.
struct Published {
    config: u32,
    cutoff: f32,
    truncation: Truncation,
    energy: f64,
    virial: f64,
    tail: f64,
}

/// "Lennard-Jones Fluid Reference Calculations: Cuboid Cell", NIST Standard Reference Simulation Website.
#[rustfmt::skip]
const NIST: [Published; 6] = [
    Published { config: 1, cutoff: 3.0, truncation: Truncation::Cut, energy: -4351.5, virial: -568.67, tail: -198.49 },
    Published { config: 1, cutoff: 4.0, truncation: Truncation::Cut, energy: -4467.5, virial: -1263.9, tail: -83.769 },
    Published { config: 1, cutoff: 3.0, truncation: Truncation::Force, energy: -3870.9, virial: 317.54, tail: 0.0 },
    Published { config: 2, cutoff: 3.0, truncation: Truncation::Cut, energy: -690.00, virial: -568.46, tail: -24.230 },
    Published { config: 2, cutoff: 4.0, truncation: Truncation::Cut, energy: -704.60, virial: -655.99, tail: -10.226 },
    Published { config: 2, cutoff: 3.0, truncation: Truncation::Force, energy: -620.12, virial: -445.33, tail: 0.0 },
];

/// Equal in five figures.
fn five_figures(what: &str, found: f64, published: f64) -> Result<(), Failed> {
    let unit = 10f64.powf(published.abs().log10().floor() - 4.0);
    // Half a unit of the last figure, and as much for sums in f32 of pairs that are a thousand times larger.
    if (found - published).abs() <= unit { Ok(()) } else { Err(format!("{what}: {found} for {published}").into()) }
}

/// NIST's format: box lengths, N, then `id x y z` around the origin.
fn nist_system(data: &Path, case: &Published) -> Result<System, Failed> {
    let text = fs::read_to_string(data.join(format!("nist_lj/lj_sample_config_periodic{}.txt", case.config)))?;
    let rows: Vec<Vec<f32>> = text
        .lines()
        .map(|line| line.split_whitespace().map(str::parse).collect::<Result<_, _>>())
        .collect::<Result<_, _>>()?;
    let half = rows[0][0] / 2.0;
    let mut system = System {
        sim_box: SimBox::new([-half; 3], [half; 3], [Boundary::Periodic; 3])?,
        particles: Particles::at(rows[2..].iter().map(|row| [row[1], row[2], row[3]])),
        radii: Radii::Uniform(case.cutoff),
        interaction: Interaction { truncation: case.truncation, ..Interaction::lennard_jones() },
    };
    system.wrap();
    system.validate()?;
    Ok(system)
}

fn nist_energies(data: &Path, plan: &Plan) -> Result<(), Failed> {
    for case in &NIST {
        let system = nist_system(data, case)?;
        let mut engine = engine(Device::Cpu)?;
        engine.load(&system, plan)?;
        let totals = engine.evaluate(Quantities::ALL)?;
        five_figures("energy", totals.potential_energy, case.energy)?;
        five_figures("virial", totals.virial, case.virial)?;
        match system.tail_correction() {
            Some(tail) => five_figures("tail", tail.energy, case.tail)?,
            None => assert_eq!(case.tail, 0.0),
        }
    }
    Ok(())
}

fn lammps_melt(data: &Path, plan: &Plan) -> Result<(), Failed> {
    lammps(data, plan, "melt2048_periodic", "melt.data", Boundary::Periodic)
}

fn lammps_droplet(data: &Path, plan: &Plan) -> Result<(), Failed> {
    lammps(data, plan, "droplet_fff", "drop.data", Boundary::Open)
}

/// Totals and forces of a LAMMPS data file against those LAMMPS found.
fn lammps(data: &Path, plan: &Plan, case: &str, file: &str, boundary: Boundary) -> Result<(), Failed> {
    let reference: serde_json::Value = serde_json::from_str(&fs::read_to_string(data.join("lammps/reference.json"))?)?;
    let number = |key: &str| reference[case][key].as_f64().ok_or_else(|| Failed::from(format!("{case} has no {key}")));
    let system = file_system(&Config::default(), &data.join("lammps").join(file), Some([boundary; 3]))?;
    let mut engine = engine(Device::Cpu)?;
    engine.load(&system, plan)?;
    let totals = engine.evaluate(Quantities::ALL)?;
    let near = |what: &str, found: f64, expected: f64, tolerance: f64| -> Result<(), Failed> {
        let off = (found - expected).abs();
        if off <= tolerance { Ok(()) } else { Err(format!("{what}: {found} for {expected}, off by {off}").into()) }
    };
    assert_eq!(totals.pairs as f64, number("pairs_within_cutoff")?);
    let energy = number("potential_energy")?;
    near("energy", totals.potential_energy, energy, 1e-6 * energy.abs())?;
    // The virial is a small difference of terms a hundred times larger.
    near("virial", totals.virial, number("virial_sum_r_dot_f")?, 1e-6 * 24.0 * energy.abs())?;

    let mut results = PerParticle::default();
    engine.per_particle(&mut results).expect("a copy");
    let text = fs::read_to_string(data.join(format!("lammps/{case}.forces")))?;
    let tolerance = 1e-5 * number("rms_force")?;
    let mut largest = 0.0f64;
    for (i, row) in text.lines().skip(9).enumerate() {
        let numbers: Vec<f64> = row.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        largest = largest.max(numbers[5..].iter().map(|f| f * f).sum::<f64>().sqrt());
        for axis in 0..3 {
            near(&format!("force on {i}"), f64::from(results.force.get(i)[axis]), numbers[5 + axis], tolerance)?;
        }
    }
    assert_eq!(text.lines().count() - 9, results.force.len());
    near("largest force", totals.max_force, largest, tolerance)
}
