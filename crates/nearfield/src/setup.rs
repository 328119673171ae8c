//! From configurations and files to a validated system.

use crate::{
    Error, Result,
    config::{Config, Source},
    io::{self, Bounds, Configuration},
};
use nearfield_core::{Boundary, Particles, Radii, SimBox, System, Vec3s};
use std::path::Path;

/// The validated, wrapped system of a configuration.
///
/// # Errors
/// Anything wrong with the input, naming the particle, line or key.
pub fn system(config: &Config) -> Result<System> {
    let mut system = match config.source()? {
        Source::Input(path) => return file_system(config, &config.folder.join(path), Some(config.boundary.axes())),
        Source::Generate(_) => {
            let (sim_box, particles, radii) = config.generate()?;
            System { sim_box, particles, radii, interaction: config.interaction()? }
        }
    };
    system.validate()?;
    system.wrap();
    Ok(system)
}

/// The validated, wrapped system of an input file, with the interaction of a configuration. Without boundaries, the
/// file's own are taken; where it has a box but does not say, periodic ones; where it has none, open ones. `-` reads
/// standard input.
///
/// # Errors
/// As [`system`].
pub fn file_system(config: &Config, path: &Path, boundary: Option<[Boundary; 3]>) -> Result<System> {
    configuration_system(config, &io::input_name(path), io::read(path, &io::ReadOptions::default())?, boundary)
}

/// The validated, wrapped particles of an input file for a search alone, with one cutoff where the file gives no
/// radii: species and masses mean nothing. Boundaries are as in [`file_system`].
///
/// # Errors
/// As [`system`].
pub fn file_points(path: &Path, cutoff: f32, boundary: Option<[Boundary; 3]>) -> Result<System> {
    let mut configuration = io::read(path, &io::ReadOptions::default())?;
    let n = configuration.len();
    configuration.species = io::Species { names: vec!["1".into()], of: vec![0; n] };
    configuration.mass = None;
    let mut config = Config::default();
    config.interaction.cutoff = f64::from(cutoff);
    configuration_system(&config, &io::input_name(path), configuration, boundary)
}

/// The validated, wrapped system of what was read from a file, as a frame of a trajectory; `file` names it in messages.
/// Otherwise as [`file_system`].
///
/// # Errors
/// As [`system`].
pub fn configuration_system(
    config: &Config,
    file: &str,
    configuration: Configuration,
    boundary: Option<[Boundary; 3]>,
) -> Result<System> {
    let boundary = boundary.unwrap_or_else(|| match configuration.bounds {
        Some(bounds) => bounds
            .periodic
            .map_or([Boundary::Periodic; 3], |axes| axes.map(|p| if p { Boundary::Periodic } else { Boundary::Open })),
        None => [Boundary::Open; 3],
    });
    let mut system = assemble(config, file, configuration, boundary)?;
    system.validate().map_err(|source| Error::Input { file: file.into(), source })?;
    system.wrap();
    Ok(system)
}

fn assemble(config: &Config, file: &str, configuration: Configuration, boundary: [Boundary; 3]) -> Result<System> {
    let n = configuration.len();
    let sim_box = match configuration.bounds {
        Some(Bounds { lo, hi, .. }) => SimBox::new(lo, hi, boundary)?,
        None if boundary == [Boundary::Open; 3] => bounding_box(&configuration.position)?,
        None => {
            return Err(Error::NoBox { file: file.into(), why: "periodic and wall boundaries need" });
        }
    };
    let kinds = config.interaction.match_species(&configuration.species.names)?;
    let mut interaction = config.interaction()?;
    if let Some(masses) = &configuration.mass {
        for (&kind, &mass) in kinds.iter().zip(masses) {
            interaction.types[kind as usize].mass = mass;
        }
    }
    let particles = Particles {
        velocity: configuration.velocity.unwrap_or_else(|| Vec3s::zeros(n)),
        kind: configuration.species.of.iter().map(|&species| kinds[species as usize]).collect(),
        image: configuration.image.unwrap_or_else(|| vec![[0; 3]; n]),
        position: configuration.position,
    };
    let radii = match configuration.radius {
        Some(radii) => Radii::PerParticle(radii),
        None => Radii::Uniform(config.interaction.cutoff as f32),
    };
    Ok(System { sim_box, particles, radii, interaction })
}

/// The box of particles in open space: their bounds, a little wider. It only informs.
fn bounding_box(position: &Vec3s) -> Result<SimBox> {
    let bounds = |values: &[f32]| {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let (lo, hi) = finite.fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        if lo > hi { (0.0, 1.0) } else { (lo - 0.5 - 0.01 * lo.abs(), hi + 0.5 + 0.01 * hi.abs()) }
    };
    let axes = position.axes().map(|axis| bounds(axis));
    Ok(SimBox::new(axes.map(|(lo, _)| lo), axes.map(|(_, hi)| hi), [Boundary::Open; 3])?)
}
