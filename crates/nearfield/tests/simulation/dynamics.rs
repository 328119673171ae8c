//! Conservation laws and thermostats.

use crate::{build, crystal, methods_of_the_cpu, smooth};
use nearfield::{Dynamics, Ensemble, Method, Simulation, SimulationBuilder, System};

fn momentum(system: &System) -> [f64; 3] {
    system.particles.velocity.axes().map(|axis| axis.iter().map(|&v| f64::from(v)).sum())
}

#[test]
fn energy_and_momentum_are_conserved_by_every_method() {
    for method in methods_of_the_cpu() {
        let (n, steps) = if method == Method::Cell { (256, 3000) } else { (108, 400) };
        let mut simulation = build(Simulation::builder(smooth(n, 0.8442, 1.44)).method(method));
        let n = n as f64;
        let start = simulation.thermo().unwrap();
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for _ in 0..20 {
            let energy = simulation.advance(steps / 20).unwrap().total_energy / n;
            (lowest, highest) = (lowest.min(energy), highest.max(energy));
        }
        // Velocity Verlet at dt = 0.005 ripples by some 1e-3 while the crystal melts; a drift would be seen over
        // 3000 steps.
        let start = start.total_energy / n;
        let off = (highest - start).abs().max((lowest - start).abs());
        assert!(off < 2e-3, "{method}: energy per particle between {lowest} and {highest}, {start} at the start");
        // A rounding of 1e-7 each step and particle, at random.
        let momentum = momentum(simulation.system().unwrap());
        assert!(momentum.iter().all(|p| p.abs() < 1e-2), "{method}: {momentum:?}");
    }
}

/// Mean temperature of the later part of a run.
fn mean_temperature(ensemble: Ensemble, seed: u64) -> f64 {
    let dynamics = Dynamics { ensemble, seed, ..Dynamics::nve(0.005) };
    let mut simulation = build(Simulation::builder(crystal(500, 0.8, 2.0)).method(Method::Cell).dynamics(dynamics));
    simulation.advance(1000).unwrap();
    (0..150).map(|_| simulation.advance(20).unwrap().temperature).sum::<f64>() / 150.0
}

#[test]
fn thermostats_keep_their_temperature() {
    for ensemble in [
        Ensemble::Langevin { temperature: 1.1, friction: 1.0 },
        Ensemble::Rescale { temperature: 1.1, relaxation: 0.1 },
    ] {
        let found = mean_temperature(ensemble, 5);
        // One sample fluctuates by 1.1 sqrt(2 / 1500) = 0.04; the mean of 150 that are partly independent by a fifth
        // of that at most.
        assert!((found - 1.1).abs() < 0.025, "{ensemble:?}: mean temperature {found}");
    }
}

#[test]
fn the_seed_of_a_thermostat_makes_a_run_repeatable() {
    let end = |seed| {
        let ensemble = Ensemble::Langevin { temperature: 1.0, friction: 1.0 };
        let dynamics = Dynamics { ensemble, seed, ..Dynamics::nve(0.005) };
        let builder: SimulationBuilder = Simulation::builder(smooth(108, 0.4, 1.0)).method(Method::Cell);
        let mut simulation = build(builder.dynamics(dynamics));
        simulation.advance(50).unwrap();
        simulation.system().unwrap().particles.clone()
    };
    assert!(end(1) == end(1));
    assert!(end(1) != end(2));
}

#[test]
fn how_a_run_is_cut_into_calls_changes_nothing() {
    for method in methods_of_the_cpu() {
        let run = |pieces: &[u64]| {
            let mut simulation = build(Simulation::builder(smooth(108, 0.8442, 1.44)).method(method));
            pieces.iter().for_each(|&steps| _ = simulation.advance(steps).unwrap());
            simulation.system().unwrap().particles.clone()
        };
        assert!(run(&[240]) == run(&[1, 99, 0, 30, 110]), "{method}");
    }
}
