//! Whole steps of the Lennard-Jones melt, and how cost and memory scale with its size.
//!
//! `cargo bench -p nearfield --bench melt [-- METHOD [N ...]]`, by default `cell` at 10^4 to 10^7 particles. One line of
//! JSON for each size: median time of a step over repeated batches of steps, at density 0.8442, cutoff 2.5, dt 0.005
//! (kinetic start at T = 1.44, after 100 steps of melting), and the bytes that the engine holds for each particle.
//! Threads: RAYON_NUM_THREADS.

use nearfield::{
    Boundary, Dynamics, Interaction, Method, Radii, Simulation, System,
    generate::{Generate, Positions},
};
use serde_json::json;
use std::time::Instant;

/// Steps before timing starts.
const MELTING_STEPS: u64 = 100;
/// Timed batches of steps.
const BATCHES: usize = 5;
/// Particle-steps in a batch.
const BATCH_WORK: usize = 1_000_000;

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| !word.starts_with("--"));
    let method: Method = words.next().map_or(Method::Cell, |name| name.parse().expect("a method"));
    let mut sizes: Vec<usize> = words.map(|n| n.parse().expect("a number of particles")).collect();
    if sizes.is_empty() {
        sizes = [10_976, 32_000, 108_000, 256_000, 1_000_188, 10_061_824].to_vec();
    }
    for n in sizes {
        run(method, n);
    }
}

fn run(method: Method, n: usize) {
    let spec =
        Generate { positions: Positions::Fcc, n, density: Some(0.8442), temperature: 1.44, ..Generate::default() };
    let start = spec.build([Boundary::Periodic; 3], 1.0).expect("n is 4 m^3");
    let system = System {
        sim_box: start.sim_box,
        particles: start.particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    };
    let mut simulation =
        Simulation::builder(system).dynamics(Dynamics::nve(0.005)).method(method).build().expect("a valid system");
    simulation.advance(MELTING_STEPS.min(10_000_000 / n as u64 + 5)).expect("a stable run");
    let steps = (BATCH_WORK / n).max(2) as u64;
    let mut seconds: Vec<f64> = (0..BATCHES)
        .map(|_| {
            let begin = Instant::now();
            simulation.advance(steps).expect("a stable run");
            begin.elapsed().as_secs_f64() / steps as f64
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    let median = seconds[BATCHES / 2];
    let thermo = simulation.thermo().expect("a stable run");
    let line = json!({
        "benchmark": "melt",
        "method": method,
        "device": simulation.device(),
        "version": env!("CARGO_PKG_VERSION"),
        "n": n,
        "batches": BATCHES,
        "steps_per_batch": steps,
        "ms_per_step": median * 1e3,
        "ms_per_step_range": [seconds[0] * 1e3, seconds[BATCHES - 1] * 1e3],
        "ns_per_particle_step": median * 1e9 / n as f64,
        "million_particle_steps_per_second": n as f64 / median / 1e6,
        "engine_bytes_per_particle": simulation.report().bytes as f64 / n as f64,
        "pairs_per_particle": thermo.pairs as f64 / n as f64,
        "temperature": thermo.temperature,
    });
    println!("{line}");
}
