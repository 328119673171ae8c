//! Each variant of the method `cluster`, on systems for which it is chosen, against the reference. Ignored where the
//! emulator was built without a C++ compiler.

mod emulated;

use nearfield_conformance::cases;
use nearfield_core::{
    Boundary, Dynamics, Engine, Interaction, Method, Particles, PerParticle, Plan, Quantities, Radii, Skin, System,
    oracle,
    potentials::{Potential, Wca},
};
use nearfield_cuda::{CudaEngine, Variant};
use nearfield_emulator::Emulator;
use std::sync::Arc;

const BOUNDARIES: [[Boundary; 3]; 3] = [
    [Boundary::Periodic; 3],
    [Boundary::Open, Boundary::Periodic, Boundary::Wall],
    [Boundary::Wall, Boundary::Wall, Boundary::Periodic],
];

fn loaded(system: &System, plan: &Plan) -> CudaEngine {
    let mut engine = CudaEngine::on(Arc::new(Emulator::new().expect("an emulator")));
    engine.load(system, plan).expect("a load");
    engine
}

/// `n` uniform points that move at about `speed` and hardly feel each other.
fn moving(n: usize, length: f32, boundary: [Boundary; 3], cutoff: f32, speed: f32, seed: u64) -> System {
    let sim_box = cases::cube(length, boundary);
    let mut system = cases::soft(sim_box, cases::uniform(n, &sim_box, seed), Radii::Uniform(cutoff));
    system.interaction.types[0].epsilon = 1e-3;
    cases::thermalize(&mut system, speed * speed, &mut cases::rng(seed));
    system
}

/// Compares neighbours and forces with those of the reference at the positions where the engine is.
fn compare(engine: &mut CudaEngine, system: &System, what: &str) {
    let (mut present, mut found, mut fast) = (system.clone(), PerParticle::default(), PerParticle::default());
    engine.snapshot(&mut present.particles).expect("a copy");
    engine.evaluate(Quantities::ALL).expect("an evaluation");
    engine.per_particle(&mut found).expect("a copy");
    engine.evaluate(Quantities::FORCES).expect("an evaluation");
    engine.per_particle(&mut fast).expect("a copy");
    let mut counts = vec![0; found.neighbors.len()];
    for pair in oracle::pairs(&present.sim_box, &present.particles, &present.radii) {
        counts[pair.i as usize] += 1;
        counts[pair.j as usize] += 1;
    }
    assert_eq!(found.neighbors, counts, "{what}");
    let expected = oracle::evaluate(&present);
    let scale = expected.force.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
    for (i, force) in expected.force.iter().enumerate() {
        for found in [&found, &fast] {
            for (found, exact) in found.force.get(i).into_iter().zip(force) {
                let difference = (f64::from(found) - exact).abs();
                assert!(difference <= 3e-5 * scale, "{what}: force {difference} off on {i} where {scale} is largest");
            }
        }
    }
}

/// Steps by lists that age, in boxes where particles see two images of each other and where none does, with particles
/// that cross faces.
fn check_lists(cases: &[(usize, f32, f32, f32)], variant: Variant, steps: u64) {
    for (case, &(n, length, cutoff, speed)) in cases.iter().enumerate() {
        for (b, boundary) in BOUNDARIES.into_iter().enumerate() {
            let what = format!("{n} in {length}, cutoff {cutoff}, {boundary:?}");
            let system = moving(n, length, boundary, cutoff, speed, (10 * case + b) as u64);
            let mut engine = loaded(&system, &Plan { skin: Skin::Fixed(0.4), ..Plan::new(Method::Cluster) });
            compare(&mut engine, &system, &what);
            assert_eq!(engine.cluster_variant(), Some(variant), "{what}");
            for round in 0..3 {
                engine.advance(&Dynamics::nve(0.002), round * steps, steps, Quantities::FORCES).expect("a run");
                compare(&mut engine, &system, &format!("{what}, round {round}"));
            }
            let report = engine.report();
            // A skin that the box leaves no room for serves one step.
            let thick = 0.5 * length - cutoff > 0.3;
            assert!(report.list_builds > 1 && (!thick || report.list_builds < report.evaluations / 2), "{report:?}");
        }
    }
}

fn lists_of_any_age_hold_every_pair() {
    // 2.4 in 5 leaves a skin of 0.1; lists of 1000 in 6 are longer than a segment.
    let cases = [(150, 5.0, 2.4, 3.0), (300, 8.0, 2.5, 3.0), (1000, 6.0, 2.0, 3.0), (700, 20.0, 2.5, 4.0)];
    check_lists(&cases, Variant::List, 17);
}

fn sparse_lists_of_any_age_hold_every_pair() {
    check_lists(&[(300, 30.0, 1.2, 4.0), (1001, 50.0, 1.5, 5.0)], Variant::SparseList, 25);
}

fn pairs_are_found_once_in_dense_systems() {
    for (seed, boundary) in BOUNDARIES.into_iter().enumerate() {
        for cutoff in [3.0, 4.9] {
            let system = moving(3000, 10.0, boundary, cutoff, 1.0, seed as u64);
            let mut engine = loaded(&system, &Plan::new(Method::Cluster));
            compare(&mut engine, &system, &format!("cutoff {cutoff}, {boundary:?}"));
            assert_eq!(engine.cluster_variant(), Some(Variant::Pairs));
        }
    }
}

/// Kernels of their own, for forces alone and for steps.
fn lennard_jones_liquids_follow_the_trajectory_of_all_pairs() {
    let mut wca = cases::lattice(4, 1.5, 1.2, [Boundary::Wall; 3]);
    wca.interaction = Interaction { potential: Potential::Wca(Wca), ..Interaction::lennard_jones() };
    cases::thermalize(&mut wca, 1.5, &mut cases::rng(3));
    let mut gas = cases::lattice(6, 4.0, 1.5, [Boundary::Periodic; 3]);
    gas.interaction = Interaction::lennard_jones();
    cases::thermalize(&mut gas, 4.0, &mut cases::rng(4));
    let systems =
        [(cases::liquid(5, 1.0, 0.05, 2.5, 1), Variant::List), (wca, Variant::List), (gas, Variant::SparseList)];
    for (system, variant) in systems {
        let engine = follows_all_pairs(&system, &Plan::new(Method::Cluster), 2e-3);
        assert_eq!(engine.cluster_variant(), Some(variant));
        assert!(engine.report().list_builds < 30, "{:?}", engine.report());
    }
}

/// Cells that hold about one particle, where forces and steps are one kernel.
fn particles_with_few_neighbors_follow_the_trajectory_of_all_pairs() {
    let mut gas = cases::lattice(6, 4.0, 1.5, [Boundary::Periodic; 3]);
    gas.interaction = Interaction::lennard_jones();
    cases::thermalize(&mut gas, 4.0, &mut cases::rng(4));
    let soft = BOUNDARIES.map(|boundary| {
        let mut system = moving(500, 20.0, boundary, 1.3, 3.0, 7);
        system.interaction.types[0].epsilon = 5.0;
        system
    });
    for system in [gas].into_iter().chain(soft) {
        follows_all_pairs(&system, &Plan::new(Method::Cell), 2e-3);
        let engine = follows_all_pairs(&system, &Plan { skin: Skin::NONE, ..Plan::new(Method::Cluster) }, 2e-3);
        assert_eq!(engine.cluster_variant(), Some(Variant::Pairs));
    }
}

/// Compares velocities after a run with those of a run that tests all pairs.
fn follows_all_pairs(system: &System, plan: &Plan, tolerance: f32) -> CudaEngine {
    let run = |plan| {
        let mut engine = loaded(system, plan);
        engine.advance(&Dynamics::nve(0.004), 0, 60, Quantities::FORCES).expect("a run");
        let mut end = Particles::default();
        engine.snapshot(&mut end).expect("a copy");
        (engine, end.velocity)
    };
    let ((_, expected), (engine, found)) = (run(&Plan::new(Method::Brute)), run(plan));
    for i in 0..expected.len() {
        let (a, b) = (expected.get(i), found.get(i));
        let same = (0..3).all(|axis| (a[axis] - b[axis]).abs() < tolerance);
        assert!(same, "{}: particle {i} has {b:?}, not {a:?}", plan.method);
    }
    engine
}

fn steps_recorded_one_by_one_are_those_of_lists() {
    let system = cases::liquid(4, 1.0, 0.05, 2.2, 1);
    let ends = [false, true].map(|record| {
        let mut engine = loaded(&system, &Plan::new(Method::Cluster));
        engine.record_history(record);
        engine.advance(&Dynamics::nve(0.004), 0, 30, Quantities::FORCES).expect("a run");
        assert_eq!(engine.report().evaluations, 31);
        let mut end = Particles::default();
        engine.snapshot(&mut end).expect("a copy");
        end
    });
    // The emulator adds in a fixed order, so they are the same to the bit.
    assert!(ends[0] == ends[1]);
}

fn a_list_beyond_the_budget_is_not_kept() {
    let system = cases::liquid(4, 1.0, 0.05, 2.2, 1);
    let mut engine = loaded(&system, &Plan { memory_budget: 10_000, ..Plan::new(Method::Cluster) });
    engine.advance(&Dynamics::nve(0.004), 0, 5, Quantities::FORCES).expect("a run");
    compare(&mut engine, &system, "without a list");
    assert_eq!(engine.cluster_variant(), Some(Variant::Pairs));
    let report = engine.report();
    assert_eq!((report.list_builds, report.batched_evaluations), (0, report.evaluations));
}

fn main() {
    let tests: [(&str, fn()); 7] = [
        ("lists_of_any_age_hold_every_pair", lists_of_any_age_hold_every_pair),
        ("sparse_lists_of_any_age_hold_every_pair", sparse_lists_of_any_age_hold_every_pair),
        ("pairs_are_found_once_in_dense_systems", pairs_are_found_once_in_dense_systems),
        (
            "lennard_jones_liquids_follow_the_trajectory_of_all_pairs",
            lennard_jones_liquids_follow_the_trajectory_of_all_pairs,
        ),
        (
            "particles_with_few_neighbors_follow_the_trajectory_of_all_pairs",
            particles_with_few_neighbors_follow_the_trajectory_of_all_pairs,
        ),
        ("steps_recorded_one_by_one_are_those_of_lists", steps_recorded_one_by_one_are_those_of_lists),
        ("a_list_beyond_the_budget_is_not_kept", a_list_beyond_the_budget_is_not_kept),
    ];
    emulated::run(tests);
}
