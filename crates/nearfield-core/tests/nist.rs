//! The oracle against other programs: NIST's Lennard-Jones reference configurations with their published energies, a
//! float64 all-pairs sum made independently (`computed_reference.csv`), and LAMMPS forces.
//!
//! The data lie in the folder that `NEARFIELD_DATA` names, `../shared/data` beside the workspace by default. Where a
//! file is absent its tests show as ignored. `nist_lj/` holds NIST's `lj_sample_config_periodic{1,2}.txt`; `lammps/`
//! holds `NAME.data`, `NAME.forces` and `reference.json`.

use libtest_mimic::{Arguments, Failed, Trial};
use nearfield_core::{Boundary, Interaction, Particles, Radii, SimBox, System, Truncation, oracle};
use std::{fs, path::PathBuf, process::ExitCode};

fn main() -> ExitCode {
    let mut trials = Vec::new();
    for case in PUBLISHED {
        let name = format!("nist_configuration_{}_cutoff_{}_{:?}", case.config, case.cutoff, case.truncation);
        trials.push(trial(name, &format!("nist_lj/lj_sample_config_periodic{}.txt", case.config), move || {
            published_values_are_reproduced(case)
        }));
    }
    trials.push(trial("computed_reference_table".into(), "computed_reference.csv", the_computed_table_is_reproduced));
    for (case, file, boundary) in LAMMPS {
        trials.push(trial(format!("lammps_{case}"), &format!("lammps/{case}.forces"), move || {
            lammps_forces_are_reproduced(case, file, boundary)
        }));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

fn path(file: &str) -> PathBuf {
    let default = || concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data").into();
    std::env::var_os("NEARFIELD_DATA").map_or_else(default, PathBuf::from).join(file)
}

fn read(file: &str) -> Result<String, Failed> {
    fs::read_to_string(path(file)).map_err(|error| format!("{file}: {error}").into())
}

/// A test of a file, ignored where the file is absent.
fn trial(name: String, file: &str, body: impl FnOnce() -> Result<(), Failed> + Send + 'static) -> Trial {
    Trial::test(name, body).with_ignored_flag(!path(file).exists())
}

fn close(what: &str, found: f64, expected: f64, tolerance: f64) -> Result<(), Failed> {
    if (found - expected).abs() <= tolerance {
        return Ok(());
    }
    Err(format!("{what}: {found} for {expected}, more than {tolerance} apart").into())
}

fn system(sim_box: SimBox, positions: Vec<[f32; 3]>, cutoff: f32, truncation: Truncation) -> Result<System, Failed> {
    let interaction = Interaction { truncation, ..Interaction::lennard_jones() };
    let mut system =
        System { sim_box, particles: Particles::at(positions), radii: Radii::Uniform(cutoff), interaction };
    system.wrap();
    system.validate()?;
    Ok(system)
}

/// NIST's format: box lengths, N, then `id x y z` centred at the origin.
fn nist(config: u32, boundary: [Boundary; 3], cutoff: f32, truncation: Truncation) -> Result<System, Failed> {
    let text = read(&format!("nist_lj/lj_sample_config_periodic{config}.txt"))?;
    let rows: Vec<Vec<f32>> = text
        .lines()
        .map(|line| line.split_whitespace().map(str::parse).collect::<Result<_, _>>())
        .collect::<Result<_, _>>()?;
    let half = rows[0][0] / 2.0;
    let positions: Vec<_> = rows[2..].iter().map(|row| [row[1], row[2], row[3]]).collect();
    assert_eq!(positions.len(), rows[1][0] as usize);
    system(SimBox::new([-half; 3], [half; 3], boundary)?, positions, cutoff, truncation)
}

/// A row of NIST's table of published values.
#[derive(Clone, Copy)]
struct Published {
    config: u32,
    cutoff: f32,
    truncation: Truncation,
    energy: f64,
    virial: f64,
}

const fn row(config: u32, cutoff: f32, truncation: Truncation, energy: f64, virial: f64) -> Published {
    Published { config, cutoff, truncation, energy, virial }
}

const PUBLISHED: [Published; 6] = [
    row(1, 3.0, Truncation::Cut, -4.3515e3, -5.6867e2),
    row(1, 4.0, Truncation::Cut, -4.4675e3, -1.2639e3),
    row(1, 3.0, Truncation::Force, -3.8709e3, 3.1754e2),
    row(2, 3.0, Truncation::Cut, -6.9000e2, -5.6846e2),
    row(2, 4.0, Truncation::Cut, -7.0460e2, -6.5599e2),
    row(2, 3.0, Truncation::Force, -6.2012e2, -4.4533e2),
];

/// Five digits are published, so half a unit of the fifth; rounding positions to f32 moves less.
fn published_values_are_reproduced(case: Published) -> Result<(), Failed> {
    let found = oracle::evaluate(&nist(case.config, [Boundary::Periodic; 3], case.cutoff, case.truncation)?);
    let half_digit = |value: f64| 0.5 * 10f64.powf(value.abs().log10().floor() - 4.0);
    close("energy", found.potential_energy, case.energy, 1.01 * half_digit(case.energy))?;
    close("virial", found.virial, case.virial, 1.01 * half_digit(case.virial))
}

/// Rows `case,n,rc,full_neighbour_count,min,max,U,W,..`. The file's positions are f64; rounding them to f32 moves a
/// distance by at most 1e-6, and the closest pair to a cutoff is 6e-7 away from it, so a pair may change sides: one
/// pair of tolerance in counts (and its energy), 1e-6 relative to the sum of magnitudes for the rest. Rows whose cutoff
/// exceeds half the box need several images of a pair, which is outside the single-image definition.
fn the_computed_table_is_reproduced() -> Result<(), Failed> {
    let mut compared = 0;
    for line in read("computed_reference.csv")?.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>();
        let cutoff = number(2)? as f32;
        if cutoff > 5.0 {
            continue;
        }
        let (name, kind) = fields[0].split_once('_').unwrap_or((fields[0], "ppp"));
        let (p, o) = (Boundary::Periodic, Boundary::Open);
        let boundary = match kind {
            "ppp" => [p; 3],
            "ppf" => [p, p, o],
            "open" => [o; 3],
            _ => return Err(format!("unknown case {kind}").into()),
        };
        let config = if name == "cuboid1" { 1 } else { 2 };
        let found = oracle::evaluate(&nist(config, boundary, cutoff, Truncation::Cut)?);
        close("full neighbours", 2.0 * found.pairs as f64, number(3)?, 2.0)?;
        close("fewest neighbours", found.neighbors.iter().min().copied().unwrap_or(0).into(), number(4)?, 1.0)?;
        close("most neighbours", found.neighbors.iter().max().copied().unwrap_or(0).into(), number(5)?, 1.0)?;
        let pair_at_cutoff = 4.0 * f64::from(cutoff).powi(-6);
        close("energy", found.potential_energy, number(6)?, 1e-6 * found.energy_magnitude + pair_at_cutoff)?;
        close("virial", found.virial, number(7)?, 1e-6 * found.virial_magnitude + 6.0 * pair_at_cutoff)?;
        compared += 1;
    }
    if compared == 8 { Ok(()) } else { Err(format!("compared {compared} rows instead of 8").into()) }
}

/// Case, data file with the box, boundary.
const LAMMPS: [(&str, &str, Boundary); 2] =
    [("melt2048_periodic", "melt.data", Boundary::Periodic), ("droplet_fff", "drop.data", Boundary::Open)];

/// Positions are exact f32 values and LAMMPS computes in f64, so the oracle agrees to rounding: the f32 predicate may
/// differ only on pairs within a rounding of the cutoff, and there are none in these files. The one f32 rounding that
/// remains is that of the box length in the shift, 1e-6 in length: 1e-5 of the force scale in the periodic case.
fn lammps_forces_are_reproduced(case: &str, data: &str, boundary: Boundary) -> Result<(), Failed> {
    let reference: serde_json::Value = serde_json::from_str(&read("lammps/reference.json")?)?;
    let expected = |key: &str| reference[case][key].as_f64().ok_or(format!("reference.json: {case}.{key} is absent"));
    let text = read(&format!("lammps/{data}"))?;
    let bounds: Vec<Vec<f32>> = text
        .lines()
        .filter(|line| line.ends_with("hi"))
        .map(|line| line.split_whitespace().take(2).map(str::parse).collect::<Result<_, _>>())
        .collect::<Result<_, _>>()?;
    let (lo, hi) = (std::array::from_fn(|a| bounds[a][0]), std::array::from_fn(|a| bounds[a][1]));
    let dump = read(&format!("lammps/{case}.forces"))?;
    let atoms: Vec<Vec<f64>> = dump
        .lines()
        .skip_while(|line| !line.starts_with("ITEM: ATOMS"))
        .skip(1)
        .map(|line| line.split_whitespace().map(str::parse).collect::<Result<_, _>>())
        .collect::<Result<_, _>>()?;
    let positions = atoms.iter().map(|atom| std::array::from_fn(|a| atom[2 + a] as f32)).collect();
    let found = oracle::evaluate(&system(SimBox::new(lo, hi, [boundary; 3])?, positions, 2.5, Truncation::Cut)?);
    let tolerance = if boundary == Boundary::Periodic { 1e-5 } else { 1e-12 };
    for (i, atom) in atoms.iter().enumerate() {
        for axis in 0..3 {
            let what = format!("force {axis} on particle {i}");
            close(&what, found.force[i][axis], atom[5 + axis], tolerance * found.magnitude[i])?;
        }
    }
    close("pairs", found.pairs as f64, expected("pairs_within_cutoff")?, 0.0)?;
    let (energy, virial) = (expected("potential_energy")?, expected("virial_sum_r_dot_f")?);
    close("energy", found.potential_energy, energy, tolerance * found.energy_magnitude)?;
    close("virial", found.virial, virial, tolerance * found.virial_magnitude)
}
