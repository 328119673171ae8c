//! `nearfield generate`.

use super::print_note;
use crate::{arguments::GenerateArguments, failure::Failure};
use nearfield::{
    Interaction, Radii, System,
    generate::Generate,
    io::{self, Configuration},
};

pub fn run(arguments: &GenerateArguments) -> Result<(), Failure> {
    let mut spec = Generate {
        positions: arguments.kind,
        n: arguments.n,
        density: arguments.density,
        lengths: arguments.lengths,
        temperature: arguments.temperature,
        seed: arguments.seed,
        center: arguments.center,
        radii: arguments.radii.clone(),
        ..Generate::default()
    };
    if let Some(spread) = arguments.spread {
        spec.spread = spread;
    }
    let interaction = Interaction::lennard_jones();
    let generated = spec.build(arguments.boundary, f64::from(interaction.types[0].mass))?;
    let n = generated.particles.len();
    let radii = match generated.radii {
        // A file holds radii by particle.
        Some(Radii::Uniform(r)) => Radii::PerParticle(vec![r; n]),
        Some(radii) => radii,
        None => Radii::Uniform(1.0),
    };
    let system = System { sim_box: generated.sim_box, particles: generated.particles, radii, interaction };
    let mut configuration = Configuration::from(&system);
    configuration.id = Some((1..=n as u64).collect());
    if arguments.temperature == 0.0 {
        configuration.velocity = None;
    }
    io::write(&arguments.output, &configuration)?;
    print_note(&format!("wrote {n} particles to {}", arguments.output.display()));
    Ok(())
}
