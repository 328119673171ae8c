//! The Lennard-Jones melt at constant energy.

use nearfield::{Device, Dynamics, Plan, Radii, Simulation, System, Truncation, generate::Generate};
use nearfield_core::{Boundary, Interaction};

/// Steps, unless `NEARFIELD_MELT_STEPS` says otherwise.
const STEPS: u64 = 2_000;
/// Steps in which the crystal melts, before energies are compared.
const MELTING: u64 = 1_000;
const SAMPLES: u64 = 100;

/// Largest drift of the total energy of a particle over the whole run, and per step. Velocity Verlet conserves an energy
/// that differs from this one by terms in dt², so it wanders a little whatever the length of the run; rounding in f32
/// adds to it step by step. The CPU engine drifts by 9e-10 a step over 2,000 steps and by 3e-10 over 100,000.
const WANDERING: f64 = 4e-5;
const DRIFT: f64 = 2e-9;

/// 4,000 atoms at density 0.8442, whose force goes to zero at the cutoff: else energy jumps there.
pub fn melt() -> System {
    let spec = Generate { n: 4_000, density: Some(0.8442), temperature: 1.44, ..Generate::default() };
    let start = spec.build([Boundary::Periodic; 3], 1.0).expect("a crystal");
    System {
        sim_box: start.sim_box,
        particles: start.particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction { truncation: Truncation::Force, ..Interaction::lennard_jones() },
    }
}

/// Slope of the total energy over the steps, and the sum of all momenta at the end.
pub fn energy_and_momentum_are_conserved(plan: &Plan) {
    let steps = std::env::var("NEARFIELD_MELT_STEPS").map_or(STEPS, |text| text.parse().expect("a number of steps"));
    let builder = Simulation::builder(melt()).device(Device::Cuda(Some(0))).plan(*plan).method(plan.method);
    let mut simulation = builder.dynamics(Dynamics::nve(0.004)).build().expect("a simulation");
    let n = simulation.n_particles() as f64;
    simulation.advance(MELTING).expect("a run");
    let mut energies = Vec::new();
    for _ in 0..SAMPLES {
        let thermo = simulation.advance(steps.div_ceil(SAMPLES)).expect("a run");
        energies.push((thermo.step as f64, thermo.total_energy / n));
    }
    let slope = slope(&energies);
    let limit = DRIFT + WANDERING / steps as f64;
    eprintln!("{}: energy of a particle drifts by {slope:.2e} a step over {steps} steps", plan.method);
    assert!(slope.abs() < limit, "{plan:?}: the energy of a particle drifts by {slope:e} a step, {limit:e} is allowed");
    let velocity = &simulation.system().expect("a copy").particles.velocity;
    for (axis, velocities) in velocity.axes().iter().enumerate() {
        let momentum = velocities.iter().map(|&v| f64::from(v)).sum::<f64>() / n;
        // Each step rounds each velocity, of size 1, at random: a random walk, divided by the number of particles.
        let limit = 4.0 * f64::from(f32::EPSILON) * ((MELTING + steps) as f64 / n).sqrt();
        assert!(momentum.abs() < limit, "{plan:?}: mean momentum {momentum:e} on axis {axis}, {limit:e} is allowed");
    }
}

/// Of the least-squares line.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let covariance: f64 = points.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum();
    covariance / points.iter().map(|p| (p.0 - mean.0).powi(2)).sum::<f64>()
}
