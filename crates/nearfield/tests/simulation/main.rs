//! The simulation as a program uses it: physics, observers, choice of method, checkpoints.

mod checkpoints;
mod choice;
mod dynamics;
mod observers;
mod reference_state;

use nearfield::{
    Boundary, Interaction, Method, Radii, Simulation, SimulationBuilder, System, Truncation, generate::Generate,
};

/// An fcc crystal of n particles with velocities, cutoff 2.5, periodic.
fn crystal(n: usize, density: f64, temperature: f64) -> System {
    let spec = Generate { n, density: Some(density), temperature, ..Generate::default() };
    let start = spec.build([Boundary::Periodic; 3], 1.0).unwrap();
    System {
        sim_box: start.sim_box,
        particles: start.particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    }
}

/// As [`crystal`], with a force that goes to zero at the cutoff, so that energy is conserved.
fn smooth(n: usize, density: f64, temperature: f64) -> System {
    let mut system = crystal(n, density, temperature);
    system.interaction.truncation = Truncation::Force;
    system
}

fn methods_of_the_cpu() -> impl Iterator<Item = Method> {
    nearfield::methods().into_iter().filter(|row| row.device == "cpu").map(|row| row.method)
}

fn build(builder: SimulationBuilder) -> Simulation {
    builder.build().unwrap_or_else(|error| panic!("{error}"))
}
