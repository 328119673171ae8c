//! Where the time of `cluster` goes: whole steps of the Lennard-Jones melt by phase, and evaluations where particles
//! have very many neighbours or next to none.
//!
//! `cargo bench -p nearfield-cpu --bench clusters [-- [METHOD:]N[:SKIN|:rR] ...]`. One line of JSON for each case.
//! Threads: RAYON_NUM_THREADS.
//! - The melt: density 0.8442, cutoff 2.5, dt 0.005, after 200 steps of melting from T = 1.44: ns per particle and step
//!   of the phases that the engine reports, and of the whole; medians over batches of 40 steps or more.
//! - `rR`: paper A's lattice, spacing 10 with walls, and cutoff R: the median of three evaluations of forces, structure
//!   included.

use nearfield_core::{
    Boundary, Dynamics, Engine, Interaction, Method, Particles, Plan, Quantities, Radii, Report, SimBox, System,
};
use nearfield_cpu::CpuEngine;
use rand::{RngExt, SeedableRng};
use std::time::Instant;

const MELTING_STEPS: u64 = 200;
const BATCHES: usize = 9;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let words = if words.is_empty() { ["32000", "256000"].map(String::from).to_vec() } else { words };
    for word in words {
        let mut method = Method::Cluster;
        let (mut numbers, mut cutoff) = (Vec::new(), None);
        for part in word.split(':') {
            match (part.parse(), part.strip_prefix('r').and_then(|r| r.parse::<f32>().ok())) {
                (_, Some(r)) => cutoff = Some(r),
                (Ok(name), None) => method = name,
                (Err(_), None) => numbers.push(part.parse::<f64>().expect("a method or a number")),
            }
        }
        let mut plan = Plan::new(method);
        if let Some(&skin) = numbers.get(1) {
            plan.skin = skin as f32;
        }
        match cutoff {
            Some(r) => evaluate(numbers[0] as usize, r, &plan),
            None => run(numbers[0] as usize, &plan),
        }
    }
}

/// Evaluations of paper A's lattice.
fn evaluate(n: usize, cutoff: f32, plan: &Plan) {
    let side = (n as f64).cbrt().round() as usize;
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    let mut along = |cell: usize| (cell as f32 + 0.5 + 0.01 * (rng.random::<f32>() - 0.5)) * 10.0;
    let points = (0..side.pow(3)).map(|k| [k % side, k / side % side, k / side / side].map(&mut along));
    let system = System {
        particles: Particles::at(points.collect::<Vec<_>>()),
        sim_box: SimBox::cubic(side as f32 * 10.0, Boundary::Wall).expect("a box"),
        radii: Radii::Uniform(cutoff),
        interaction: Interaction::lennard_jones(),
    };
    // Nothing moves, so a skin would have lists found once.
    let plan = Plan { skin: 0.0, ..*plan };
    let mut engine = CpuEngine::new();
    engine.load(&system, &plan).expect("a load");
    engine.evaluate(Quantities::FORCES).expect("an evaluation");
    let mut seconds = [0.0; 3].map(|_: f64| {
        let start = Instant::now();
        engine.evaluate(Quantities::FORCES).expect("an evaluation");
        start.elapsed().as_secs_f64()
    });
    seconds.sort_by(f64::total_cmp);
    let pairs = engine.evaluate(Quantities::ALL).expect("an evaluation").pairs;
    println!(
        "{{\"method\": \"{}\", \"n\": {}, \"cutoff\": {cutoff}, \"pairs\": {pairs}, \"ms\": {:.1}}}",
        plan.method,
        side.pow(3),
        1e3 * seconds[1]
    );
}

/// A face-centred cubic crystal of at least `n` particles.
fn crystal(n: usize) -> System {
    let cells = (n as f64 / 4.0).cbrt().ceil() as usize;
    let spacing = (4.0f64 / 0.8442).cbrt();
    let length = cells as f64 * spacing;
    let mut points = Vec::new();
    for cell in 0..cells.pow(3) {
        let corner = [cell % cells, cell / cells % cells, cell / cells / cells];
        for offset in [[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]] {
            points.push([0, 1, 2].map(|a| ((corner[a] as f64 + offset[a] + 0.25) * spacing) as f32));
        }
    }
    let mut particles = Particles::at(points);
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    for axis in particles.velocity.axes_mut() {
        axis.iter_mut().for_each(|v| *v = 1.2 * (0..12).map(|_| rng.random::<f32>() - 0.5).sum::<f32>());
        let mean = axis.iter().sum::<f32>() / axis.len() as f32;
        axis.iter_mut().for_each(|v| *v -= mean);
    }
    System {
        sim_box: SimBox::cubic(length as f32, Boundary::Periodic).expect("a box"),
        particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    }
}

fn run(n: usize, plan: &Plan) {
    let system = crystal(n);
    let n = system.particles.len();
    let mut engine = CpuEngine::new();
    engine.load(&system, plan).expect("a load");
    let dynamics = Dynamics::nve(0.005);
    engine.advance(&dynamics, 0, MELTING_STEPS, Quantities::FORCES).expect("a run");
    let mut step = MELTING_STEPS;
    let steps = (2_000_000 / n as u64).max(40);
    let mut phases = Vec::new();
    let mut last = engine.report();
    for _ in 0..BATCHES {
        let start = Instant::now();
        engine.advance(&dynamics, step, steps, Quantities::FORCES).expect("a run");
        let seconds = start.elapsed().as_secs_f64();
        step += steps;
        let now = engine.report();
        let since = |of: fn(&Report) -> f64| of(&now) - of(&last);
        phases.push([
            seconds,
            since(|r| r.build_seconds),
            since(|r| r.refit_seconds),
            since(|r| r.query_seconds),
            since(|r| r.integrate_seconds),
        ]);
        last = now;
    }
    let totals = engine.evaluate(Quantities::ALL).expect("an evaluation");
    let median = |phase: usize| {
        let mut values: Vec<f64> = phases.iter().map(|p| p[phase]).collect();
        values.sort_by(f64::total_cmp);
        values[BATCHES / 2] * 1e9 / (n as f64 * steps as f64)
    };
    let report = engine.report();
    println!(
        "{{\"method\": \"{}\", \"n\": {n}, \"skin\": {}, \"ns\": {:.1}, \"build\": {:.1}, \"refresh_and_prune\": {:.1}, \
         \"query\": {:.1}, \"integrate\": {:.1}, \"million_per_second\": {:.1}, \"steps_per_list\": {:.1}, \
         \"dangerous\": {}, \"temperature\": {:.4}, \"bytes_per_particle\": {:.0}}}",
        plan.method,
        plan.skin,
        median(0),
        median(1),
        median(2),
        median(3),
        median(4),
        1e3 / median(0),
        report.evaluations as f64 / report.list_builds.max(1) as f64,
        report.dangerous_builds,
        totals.kinetic_energy * 2.0 / (3.0 * n as f64),
        report.bytes as f64 / n as f64,
    );
}
