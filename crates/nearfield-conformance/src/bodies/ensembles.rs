//! Thermostats: the target temperature and the Maxwell-Boltzmann distribution.

use crate::{
    Factory, cases, plans,
    statistics::{assert_standard_normal, mean_and_error},
};
use nearfield_core::{
    Boundary, Dynamics, Engine, Ensemble, Method, ParticleType, Particles, Plan, Quantities, Radii, System,
};

/// Free particles of two masses at rest.
fn free_particles(n: usize) -> System {
    let sim_box = cases::cube(20.0, [Boundary::Periodic; 3]);
    let mut system = cases::soft(sim_box, cases::uniform(n, &sim_box, 1), Radii::Uniform(1.0));
    system.interaction.types = [1.0, 4.0]
        .iter()
        .map(|&mass| ParticleType { name: mass.to_string(), epsilon: 0.0, mass, ..ParticleType::default() })
        .collect();
    system.particles.kind.iter_mut().step_by(2).for_each(|kind| *kind = 1);
    system
}

/// Velocity components in units of their thermal width.
fn scaled_velocities(system: &System, particles: &Particles, temperature: f64) -> Vec<f64> {
    let width = |kind: u32| (temperature / f64::from(system.interaction.types[kind as usize].mass)).sqrt();
    particles
        .velocity
        .iter()
        .zip(&particles.kind)
        .flat_map(|(v, &kind)| v.map(|v| f64::from(v) / width(kind)))
        .collect()
}

/// Plans of the methods that integrate in different ways: apart from the forces, and in the same pass.
fn two_methods() -> [Plan; 2] {
    [Plan::new(Method::Cell), Plan::new(Method::RtPerse)]
}

/// Without forces the Ornstein-Uhlenbeck step is exact for any dt; six relaxation times apart, samples are independent.
pub fn langevin_velocities_of_free_particles_follow_maxwell_and_boltzmann(factory: Factory) {
    let (system, temperature) = (free_particles(400), 0.7);
    let ensemble = Ensemble::Langevin { temperature, friction: 2.0 };
    let dynamics = Dynamics { ensemble, seed: 5, ..Dynamics::nve(0.1) };
    plans::run(&mut *factory(), &system, &two_methods(), |engine, plan| {
        let (mut particles, mut samples) = (Particles::default(), Vec::new());
        for round in 0..6 {
            engine.advance(&dynamics, 30 * round, 30, Quantities::FORCES).expect("a run");
            engine.snapshot(&mut particles).expect("a copy");
            samples.extend(scaled_velocities(&system, &particles, temperature));
        }
        assert_standard_normal(samples, &format!("{plan:?}"));
    });
}

/// Kinetic temperatures of a liquid, `interval` steps apart, after as many to forget the start.
fn temperatures(engine: &mut dyn Engine, dynamics: &Dynamics, n: usize, degrees: usize, interval: u64) -> Vec<f64> {
    (0..=n as u64)
        .map(|k| engine.advance(dynamics, k * interval, interval, Quantities::FORCES).expect("a run"))
        .map(|totals| 2.0 * totals.kinetic_energy / degrees as f64)
        .skip(1)
        .collect()
}

/// BAOAB's error in the kinetic temperature is of order dt², a tenth of a percent here, beside which five standard
/// errors are allowed.
pub fn langevin_keeps_a_liquid_at_its_temperature(factory: Factory) {
    let system = cases::liquid(3, 2.0, 0.05, 2.5, 2);
    let ensemble = Ensemble::Langevin { temperature: 1.0, friction: 2.0 };
    let dynamics = Dynamics { ensemble, seed: 3, ..Dynamics::nve(0.005) };
    plans::run(&mut *factory(), &system, &two_methods(), |engine, plan| {
        engine.advance(&dynamics, 1_000_000, 300, Quantities::FORCES).expect("a run");
        // The noise moves the centre of mass too: 3N degrees of freedom.
        let samples = temperatures(engine, &dynamics, 16, 3 * system.particles.len(), 60);
        let (mean, error) = mean_and_error(&samples);
        assert!((mean - 1.0).abs() < 5.0 * error + 0.005, "{plan:?}: {mean} ± {error}");
        assert!(error < 0.05, "{plan:?}: samples scatter by {error}");
    });
}

/// The stochastic rescaling samples kinetic energies of the canonical ensemble: mean (3N - 3) T / 2 and variance
/// (3N - 3) T² / 2. Free particles, started four times too hot.
pub fn rescaling_gives_free_particles_canonical_kinetic_energies(factory: Factory) {
    let mut system = free_particles(30);
    cases::thermalize(&mut system, 4.0, &mut cases::rng(6));
    system.particles.kind.fill(0);
    let ensemble = Ensemble::Rescale { temperature: 1.0, relaxation: 0.02 };
    let dynamics = Dynamics { ensemble, seed: 7, ..Dynamics::nve(0.01) };
    let degrees = 3 * system.particles.len() - 3;
    plans::run(&mut *factory(), &system, &two_methods(), |engine, plan| {
        engine.advance(&dynamics, 1_000_000, 50, Quantities::FORCES).expect("a run");
        let samples = temperatures(engine, &dynamics, 400, degrees, 10);
        let n = samples.len() as f64;
        let (mean, variance) = (1.0, 2.0 / degrees as f64);
        let found = samples.iter().sum::<f64>() / n;
        let spread = samples.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / n;
        assert!((found - mean).abs() < 5.0 * (variance / n).sqrt(), "{plan:?}: temperature {found}");
        assert!((spread / variance - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{plan:?}: variance {spread} for {variance}");
    });
}

/// Collisions thermalise what rescaling leaves alone.
pub fn rescaling_keeps_a_liquid_at_its_temperature_with_maxwell_boltzmann_velocities(factory: Factory) {
    let mut system = cases::liquid(3, 1.0, 0.05, 2.5, 8);
    // Not a Maxwell-Boltzmann start: all speeds equal.
    let mut rng = cases::rng(9);
    cases::thermalize(&mut system, 1.0, &mut rng);
    for axis in system.particles.velocity.axes_mut() {
        axis.iter_mut().enumerate().for_each(|(i, v)| *v = if i % 2 == 0 { 1.5 } else { -1.5 });
    }
    let temperature = 1.4;
    let ensemble = Ensemble::Rescale { temperature, relaxation: 0.1 };
    let dynamics = Dynamics { ensemble, seed: 10, ..Dynamics::nve(0.005) };
    let degrees = 3 * system.particles.len() - 3;
    plans::run(&mut *factory(), &system, &two_methods(), |engine, plan| {
        engine.advance(&dynamics, 0, 400, Quantities::FORCES).expect("a run");
        let (mut particles, mut samples, mut found) = (Particles::default(), Vec::new(), Vec::new());
        for round in 0..12 {
            let totals = engine.advance(&dynamics, 400 + 100 * round, 100, Quantities::FORCES).expect("a run");
            found.push(2.0 * totals.kinetic_energy / degrees as f64);
            engine.snapshot(&mut particles).expect("a copy");
            samples.extend(scaled_velocities(&system, &particles, temperature));
        }
        let (mean, error) = mean_and_error(&found);
        assert!((mean - temperature).abs() < 5.0 * error, "{plan:?}: {mean} ± {error}");
        assert!(error < 0.06, "{plan:?}: samples scatter by {error}");
        assert_standard_normal(samples, &format!("{plan:?}"));
    });
}
