//! Lists that may miss pairs: how many they miss of a melt, and what that does to its energy.

use nearfield_core::{
    Boundary, Dynamics, Engine, Interaction, Method, Particles, Plan, Quantities, Radii, Report, SimBox, Skin, System,
    Truncation,
};
use nearfield_cpu::CpuEngine;
use rand::{RngExt, SeedableRng};

const DT: f32 = 0.005;

/// Lennard-Jones particles of density 0.8442 and T = 0.7 or so.
fn melt() -> System {
    let (cells, spacing) = (9, (4.0f64 / 0.8442).cbrt());
    let corners = (0..9 * 9 * 9).map(|k| [k % cells, k / cells % cells, k / cells / cells]);
    let offsets = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]];
    let points = corners.flat_map(|corner| {
        offsets.map(|offset| [0, 1, 2].map(|a| ((f64::from(corner[a]) + offset[a] + 0.25) * spacing) as f32))
    });
    let mut particles = Particles::at(points.collect::<Vec<_>>());
    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    for axis in particles.velocity.axes_mut() {
        axis.iter_mut().for_each(|v| *v = 1.2 * (0..12).map(|_| rng.random::<f32>() - 0.5).sum::<f32>());
        let mean = axis.iter().sum::<f32>() / axis.len() as f32;
        axis.iter_mut().for_each(|v| *v -= mean);
    }
    let mut system = System {
        sim_box: SimBox::cubic((f64::from(cells) * spacing) as f32, Boundary::Periodic).unwrap(),
        particles,
        radii: Radii::Uniform(2.5),
        interaction: Interaction { truncation: Truncation::Energy, ..Interaction::lennard_jones() },
    };
    let mut engine = CpuEngine::new();
    engine.load(&system, &Plan::new(Method::Cluster)).unwrap();
    engine.advance(&Dynamics::nve(DT), 0, 400, Quantities::FORCES).unwrap();
    engine.snapshot(&mut system.particles).unwrap();
    system
}

/// What a run shows.
struct Run {
    report: Report,
    /// Change of the true energy for each particle and unit of time.
    drift: f64,
    /// Pairs that lists missed, of all.
    missed: f64,
}

/// Runs a system, and compares what its lists hold with a full search every few steps.
fn run(system: &System, plan: &Plan, steps: u64) -> Run {
    let (mut engine, mut full) = (CpuEngine::new(), CpuEngine::new());
    engine.load(system, plan).unwrap();
    let (mut now, n) = (system.clone(), system.particles.len() as f64);
    let (mut energies, mut pairs, mut step) = (Vec::new(), [0, 0], 0);
    while step < steps {
        let found = engine.advance(&Dynamics::nve(DT), step, 7, Quantities::ALL).unwrap();
        step += 7;
        engine.snapshot(&mut now.particles).unwrap();
        full.load(&now, &Plan::new(Method::Cell)).unwrap();
        let all = full.evaluate(Quantities::ALL).unwrap();
        assert!(found.pairs <= all.pairs);
        pairs = [pairs[0] + found.pairs, pairs[1] + all.pairs];
        energies.push((step as f64 * f64::from(DT), (all.potential_energy + found.kinetic_energy) / n));
    }
    // Slope by least squares.
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| energies.iter().map(of).sum::<f64>() / energies.len() as f64;
    let (t, e) = (mean(&|p| p.0), mean(&|p| p.1));
    let drift = mean(&|p| (p.0 - t) * (p.1 - e)) / mean(&|p| (p.0 - t).powi(2));
    Run { report: engine.report(), drift, missed: 1.0 - pairs[0] as f64 / pairs[1] as f64 }
}

fn tolerant(list_tolerance: f64) -> Plan {
    Plan { list_tolerance, ..Plan::new(Method::Cluster) }
}

#[test]
fn energy_drifts_by_less_than_the_tolerance_and_strict_lists_miss_no_pair() {
    let system = melt();
    let strict = run(&system, &tolerant(0.0), 3000);
    assert_eq!((strict.missed, strict.report.tolerant_lists), (0.0, None));
    let mut last = f64::INFINITY;
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let run = run(&system, &tolerant(tolerance), 3000);
        let lists = run.report.tolerant_lists.unwrap();
        let own = (run.drift - strict.drift).abs();
        assert!(lists.expected_drift <= tolerance);
        assert!(own < tolerance, "tolerance {tolerance}: a drift of {own}, {lists:?}");
        assert!(run.missed > 0.0 && run.missed < last.min(0.01), "tolerance {tolerance}: {} missed", run.missed);
        last = run.missed;
    }
}

#[test]
fn a_skin_of_the_user_is_the_outer_reach_and_skin_zero_misses_no_pair() {
    let system = melt();
    let of_skin = |skin: f32| run(&system, &Plan { skin: Skin::Fixed(skin), ..tolerant(1e-2) }, 210);
    let lists = of_skin(0.5).report.tolerant_lists.unwrap();
    assert!((lists.outer_reach - 3.0).abs() < 1e-6, "{lists:?}");
    let none = of_skin(0.0);
    assert_eq!((none.missed, none.report.tolerant_lists), (0.0, None));
}
