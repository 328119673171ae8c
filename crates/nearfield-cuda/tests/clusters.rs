//! Each variant of the method `cluster`, on systems for which it is chosen, against the reference. Ignored where the
//! emulator was built without a C++ compiler.

mod emulated;

use nearfield_conformance::cases;
use nearfield_core::{
    Boundary, Dynamics, Engine, Ensemble, Interaction, Method, Particles, PerParticle, Plan, Quantities, Radii, Skin,
    System, Truncation, oracle,
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

fn with_skin() -> Plan {
    Plan { skin: Skin::Fixed(0.3), ..Plan::new(Method::Cluster) }
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
        let engine = follows_all_pairs(&system, &with_skin(), 2e-3);
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

/// Two atoms at each point of a lattice, all on their way through the box: nobody ever has more than one neighbour, so
/// sums are the same to the bit in any order.
fn pairs_of_atoms(spacing: f32, truncation: Truncation) -> System {
    let sim_box = cases::cube(4.0 * spacing, [Boundary::Periodic; 3]);
    let of = |k: usize| [k % 4, k / 4 % 4, k / 16].map(|k| (k as f32 + 0.5) * spacing);
    let atoms = (0..64).flat_map(|k| [of(k), [of(k)[0] + 1.1, of(k)[1], of(k)[2]]]).collect();
    let mut system = cases::soft(sim_box, atoms, Radii::Uniform(1.5));
    system.interaction = Interaction { truncation, ..Interaction::lennard_jones() };
    cases::thermalize(&mut system, 0.05, &mut cases::rng(5));
    for i in 0..system.particles.len() {
        let [x, y, z] = system.particles.velocity.get(i);
        system.particles.velocity.set(i, [x + 9.0, y + 6.0, z - 3.0]);
    }
    system
}

/// Stretches of lists and steps or of cells and steps, short ones, and steps one by one, between which lists are not made
/// at the same steps; with random numbers that belong to a step.
fn steps_do_not_depend_on_how_they_are_enqueued() {
    let ensemble = Ensemble::Langevin { temperature: 0.05, friction: 0.1 };
    let langevin = Dynamics { ensemble, seed: 9, ..Dynamics::nve(0.004) };
    // Plain Lennard-Jones is not computed alike with and without random numbers.
    let motions = [(Dynamics::nve(0.004), Truncation::Cut), (langevin, Truncation::Force)];
    let clusters = |skin| Plan { skin: Skin::Fixed(skin), ..Plan::new(Method::Cluster) };
    let cases = [
        (3.5, clusters(0.4), Some(Variant::List)),
        (8.0, clusters(0.4), Some(Variant::SparseList)),
        (8.0, clusters(0.0), Some(Variant::Pairs)),
        (8.0, Plan::new(Method::Cell), None),
    ];
    for (spacing, plan, variant) in cases {
        for (dynamics, truncation) in &motions {
            let system = pairs_of_atoms(spacing, *truncation);
            let run = |record: bool, calls: &[u64]| {
                let mut engine = loaded(&system, &plan);
                engine.record_history(record);
                let mut step = 0;
                for &steps in calls {
                    engine.advance(dynamics, step, steps, Quantities::FORCES).expect("a run");
                    step += steps;
                }
                assert_eq!(engine.cluster_variant(), variant);
                let report = engine.report();
                assert_eq!(report.evaluations, step + 1);
                if variant.is_some_and(Variant::uses_list) {
                    assert!((12..60).contains(&report.list_builds), "{report:?}");
                } else {
                    assert_eq!(report.builds, step + 1);
                }
                let mut end = Particles::default();
                engine.snapshot(&mut end).expect("a copy");
                end
            };
            let one_by_one = run(true, &[130]);
            for calls in [&[130][..], &[1, 2, 3, 17, 5, 102], &[1; 130]] {
                assert!(run(false, calls) == one_by_one, "{variant:?}, {calls:?}");
            }
        }
    }
}

/// Particles that all fly towards the centre, which makes lists longer.
fn collapsing() -> System {
    let mut system = moving(700, 18.0, [Boundary::Open; 3], 4.0, 0.01, 11);
    for i in 0..system.particles.len() {
        system.particles.velocity.set(i, system.particles.position.get(i).map(|x| -1.7 * (x - 9.0)));
    }
    system
}

fn lists_that_outgrow_their_room_within_a_call_get_more() {
    let system = collapsing();
    let mut engine = follows_all_pairs(&system, &Plan::new(Method::Cluster), 1e-4);
    let before = engine.report();
    engine.advance(&Dynamics::nve(0.004), 60, 35, Quantities::FORCES).expect("a run");
    let after = engine.report();
    assert!(after.structure_bytes > before.structure_bytes, "{before:?} {after:?}");
    assert_eq!((engine.cluster_variant(), after.evaluations), (Some(Variant::List), 96));
    compare(&mut engine, &system, "a collapse");
}

fn lists_that_outgrow_the_budget_within_a_call_are_given_up() {
    let system = collapsing();
    // Not too small for the first list.
    let plan = Plan { memory_budget: 60_000, ..with_skin() };
    let mut engine = loaded(&system, &plan);
    engine.advance(&Dynamics::nve(0.004), 0, 1, Quantities::FORCES).expect("a run");
    assert_eq!(engine.cluster_variant(), Some(Variant::List));
    engine.advance(&Dynamics::nve(0.004), 1, 94, Quantities::FORCES).expect("a run");
    let report = engine.report();
    assert_eq!((engine.cluster_variant(), report.evaluations), (Some(Variant::Pairs), 96));
    assert!(report.list_builds > 3 && report.batched_evaluations > 3, "{report:?}");
    compare(&mut engine, &system, "a collapse without lists");
    let mut by_all_pairs = loaded(&system, &Plan::new(Method::Brute));
    by_all_pairs.advance(&Dynamics::nve(0.004), 0, 95, Quantities::FORCES).expect("a run");
    let (mut found, mut expected) = (Particles::default(), Particles::default());
    engine.snapshot(&mut found).expect("a copy");
    by_all_pairs.snapshot(&mut expected).expect("a copy");
    for (a, b) in found.velocity.axes().into_iter().flatten().zip(expected.velocity.axes().into_iter().flatten()) {
        assert!((a - b).abs() < 1e-3, "{a} {b}");
    }
}

fn a_chosen_skin_follows_the_motion_and_misses_no_pair() {
    let system = cases::liquid(6, 1.0, 0.05, 2.0, 1);
    let mut engine = loaded(&system, &Plan::new(Method::Cluster));
    let mut skins = Vec::new();
    for round in 0..4 {
        engine.advance(&Dynamics::nve(0.004), 110 * round, 110, Quantities::FORCES).expect("a run");
        compare(&mut engine, &system, &format!("round {round}"));
        skins.push(engine.report().skin);
    }
    assert!(skins.windows(2).any(|pair| pair[0] != pair[1]), "{skins:?}");
    assert!(skins.iter().all(|&skin| skin > 0.1 && skin < 3.0), "{skins:?}");
    let report = engine.report();
    assert!(report.list_builds * 4 < report.evaluations, "{report:?}");
}

fn a_chosen_skin_gives_way_where_memory_is_short() {
    let system = collapsing();
    let plan = Plan { memory_budget: 60_000, ..Plan::new(Method::Cluster) };
    let mut engine = loaded(&system, &plan);
    engine.advance(&Dynamics::nve(0.004), 0, 1, Quantities::FORCES).expect("a run");
    let before = engine.report();
    engine.advance(&Dynamics::nve(0.004), 1, 120, Quantities::FORCES).expect("a run");
    let report = engine.report();
    assert!(report.skin < 0.5 * before.skin, "{before:?} {report:?}");
    assert!(report.list_builds > 3 && report.batched_evaluations < report.evaluations, "{report:?}");
    compare(&mut engine, &system, "a collapse");
}

fn one_particle_and_none_make_their_steps() {
    for n in [0, 1] {
        let system = moving(n, 20.0, [Boundary::Periodic; 3], 2.5, 3.0, 1);
        let mut engine = loaded(&system, &Plan { skin: Skin::Fixed(0.4), ..Plan::new(Method::Cluster) });
        engine.advance(&Dynamics::nve(0.004), 0, 301, Quantities::FORCES).expect("a run");
        assert_eq!(engine.report().evaluations, 302);
        let mut end = Particles::default();
        engine.snapshot(&mut end).expect("a copy");
        let mut free = loaded(&system, &Plan::new(Method::Brute));
        free.advance(&Dynamics::nve(0.004), 0, 301, Quantities::FORCES).expect("a run");
        let mut expected = Particles::default();
        free.snapshot(&mut expected).expect("a copy");
        assert!(end == expected);
    }
}

fn a_list_beyond_the_budget_is_not_kept() {
    let system = cases::liquid(4, 1.0, 0.05, 2.2, 1);
    let mut engine = loaded(&system, &Plan { memory_budget: 10_000, ..with_skin() });
    engine.advance(&Dynamics::nve(0.004), 0, 5, Quantities::FORCES).expect("a run");
    compare(&mut engine, &system, "without a list");
    assert_eq!(engine.cluster_variant(), Some(Variant::Pairs));
    let report = engine.report();
    assert_eq!((report.list_builds, report.batched_evaluations), (0, report.evaluations));
}

fn main() {
    let tests: [(&str, fn()); 12] = [
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
        ("steps_do_not_depend_on_how_they_are_enqueued", steps_do_not_depend_on_how_they_are_enqueued),
        ("lists_that_outgrow_their_room_within_a_call_get_more", lists_that_outgrow_their_room_within_a_call_get_more),
        (
            "lists_that_outgrow_the_budget_within_a_call_are_given_up",
            lists_that_outgrow_the_budget_within_a_call_are_given_up,
        ),
        ("a_chosen_skin_follows_the_motion_and_misses_no_pair", a_chosen_skin_follows_the_motion_and_misses_no_pair),
        ("a_chosen_skin_gives_way_where_memory_is_short", a_chosen_skin_gives_way_where_memory_is_short),
        ("one_particle_and_none_make_their_steps", one_particle_and_none_make_their_steps),
        ("a_list_beyond_the_budget_is_not_kept", a_list_beyond_the_budget_is_not_kept),
    ];
    emulated::run(tests);
}
