//! Where the time of `cluster` goes: whole steps of the Lennard-Jones melt by phase, and evaluations where particles
//! have very many neighbours or next to none.
//!
//! `cargo bench -p nearfield-cpu --bench clusters [-- [METHOD:]N[:rR][:SKIN][:tD] ...]`, SKIN a number or `auto`, D the
//! tolerance of lists. One line of JSON for each case. Threads: RAYON_NUM_THREADS.
//! - `N`, `N:SKIN`: the melt, density 0.8442, cutoff 2.5, dt 0.005, after 200 steps of melting from T = 1.44; the default is
//!   `auto`.
//! - `N:rR:SKIN`: as paper A's disordered particles, one to a cube of 10 with walls, cutoff R, moving at T = 1 by steps of
//!   0.001 and no farther than 0.01.
//! - `N:rR`: paper A's lattice, spacing 10 with walls, at rest: the median of three evaluations of forces, structure included; `uniform` or
//!   `lognormal` for R gives paper A's radii, U(1, 160) and LN(1, 2) within 1 to 330.
//!
//! What moves gives ns per particle and step of the phases that the engine reports, and of the whole: medians over
//! batches of 200 steps or more.

use nearfield_core::{
    Boundary, Dynamics, Engine, Interaction, Method, Particles, Plan, Quantities, Radii, Report, SimBox, Skin, System,
};
use nearfield_cpu::CpuEngine;
use rand::{RngExt, SeedableRng};
use std::time::Instant;

const WARM_UP: u64 = 200;
const BATCHES: usize = 9;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let words = if words.is_empty() { ["32000", "256000"].map(String::from).to_vec() } else { words };
    for word in words {
        let (mut plan, mut n, mut cutoff, mut skin) = (Plan::new(Method::Cluster), None, None, None);
        for part in word.split(':') {
            match part.parse() {
                Ok(method) => plan.method = method,
                Err(_) if part == "auto" => skin = Some(Skin::Auto),
                Err(_) if part.starts_with('t') => plan.list_tolerance = part[1..].parse().expect("a tolerance"),
                Err(_) if part.starts_with('r') => cutoff = Some(part[1..].to_owned()),
                Err(_) if n.is_none() => n = Some(part.parse().expect("a number of particles")),
                Err(_) => skin = Some(Skin::Fixed(part.parse().expect("a skin"))),
            }
        }
        let n = n.expect("a number of particles");
        match (cutoff, skin) {
            (Some(r), None) => evaluate(spaced(n, 0.01, &r), &plan),
            (Some(r), Some(skin)) => {
                let dynamics = Dynamics { max_displacement: 0.01, ..Dynamics::nve(0.001) };
                run(spaced(n, 1.0, &r), dynamics, &Plan { skin, ..plan });
            }
            (None, skin) => run(crystal(n), Dynamics::nve(0.005), &Plan { skin: skin.unwrap_or(Skin::Auto), ..plan }),
        }
    }
}

/// Particles somewhere near the points of a lattice, anywhere in its cells with a `spread` of 1.
fn spaced(n: usize, spread: f32, radii: &str) -> System {
    let side = (n as f64).cbrt().round() as usize;
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    let mut along = |cell: usize| (cell as f32 + 0.5 + spread * (rng.random::<f32>() - 0.5)) * 10.0;
    let points = (0..side.pow(3)).map(|k| [k % side, k / side % side, k / side / side].map(&mut along));
    let mut particles = Particles::at(points.collect::<Vec<_>>());
    heat(&mut particles, 1.0);
    let mut interaction = Interaction::lennard_jones();
    let mut draw = |radius: &dyn Fn(f32, f32) -> f32| {
        let mut radius = || radius(rng.random(), (0..12).map(|_| rng.random::<f32>()).sum::<f32>() - 6.0);
        let radii =
            (0..particles.len()).map(|_| std::iter::repeat_with(&mut radius).find(|r| (1.0..330.0).contains(r)));
        Radii::PerParticle(radii.flatten().collect())
    };
    let radii = match radii {
        "uniform" => draw(&|uniform, _| 1.0 + 159.0 * uniform),
        "lognormal" => draw(&|_, normal| (1.0 + 2.0 * normal).exp()),
        cutoff => Radii::Uniform(cutoff.parse().expect("a cutoff, uniform or lognormal")),
    };
    if radii.is_uniform() {
        interaction.types[0].sigma = radii.largest() / 2.5;
    }
    System { particles, sim_box: SimBox::cubic(side as f32 * 10.0, Boundary::Wall).expect("a box"), radii, interaction }
}

/// Gives particles of mass 1 velocities of about this deviation, and no momentum.
fn heat(particles: &mut Particles, deviation: f32) {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    for axis in particles.velocity.axes_mut() {
        axis.iter_mut().for_each(|v| *v = deviation * (0..12).map(|_| rng.random::<f32>() - 0.5).sum::<f32>());
        let mean = axis.iter().sum::<f32>() / axis.len() as f32;
        axis.iter_mut().for_each(|v| *v -= mean);
    }
}

/// Evaluations of particles at rest.
fn evaluate(system: System, plan: &Plan) {
    // Nothing moves, so a skin would have lists found once.
    let plan = Plan { skin: Skin::NONE, ..*plan };
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
        "{{\"method\": \"{}\", \"n\": {}, \"cutoff\": {}, \"pairs\": {pairs}, \"ms\": {:.1}}}",
        plan.method,
        system.particles.len(),
        system.radii.largest(),
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
    heat(&mut particles, 1.2);
    System {
        sim_box: SimBox::cubic(length as f32, Boundary::Periodic).expect("a box"),
        particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    }
}

fn run(system: System, dynamics: Dynamics, plan: &Plan) {
    let n = system.particles.len();
    let mut engine = CpuEngine::new();
    engine.load(&system, plan).expect("a load");
    engine.advance(&dynamics, 0, WARM_UP, Quantities::FORCES).expect("a run");
    let mut step = WARM_UP;
    // Many lists to a batch: the median counts one more or one less.
    let steps = (2_000_000 / n as u64).max(200);
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
        "{{\"method\": \"{}\", \"n\": {n}, \"skin\": {}, \"cutoff\": {}, \"ns\": {:.1}, \"build\": {:.1}, \"refresh_and_prune\": {:.1}, \
         \"query\": {:.1}, \"integrate\": {:.1}, \"million_per_second\": {:.1}, \"steps_per_list\": {:.1}, \
         \"dangerous\": {}, \"lists\": {}, \"temperature\": {:.4}, \"bytes_per_particle\": {:.0}}}",
        plan.method,
        report.skin,
        system.radii.largest(),
        median(0),
        median(1),
        median(2),
        median(3),
        median(4),
        1e3 / median(0),
        report.steps_per_list().unwrap_or_default(),
        report.dangerous_builds,
        report.tolerant_lists.map_or("null".into(), |lists| format!("\"{lists:?}\"")),
        totals.kinetic_energy * 2.0 / (3.0 * n as f64),
        report.bytes as f64 / n as f64,
    );
}
