//! The engine against the float64 oracle; the full matrix is in `nearfield-conformance`.

use nearfield_core::*;
use nearfield_cpu::CpuEngine;

fn jittered(n_side: usize, spacing: f32, boundary: Boundary) -> System {
    let mut seed = 1u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut positions = Vec::new();
    for i in 0..n_side.pow(3) {
        let c = [i % n_side, i / n_side % n_side, i / n_side / n_side];
        positions.push(c.map(|c| (c as f32 + 0.5 + 0.3 * random()) * spacing));
    }
    System {
        sim_box: SimBox::cubic(n_side as f32 * spacing, boundary).unwrap(),
        particles: Particles::at(positions),
        radii: Radii::Uniform(2.5),
        interaction: Interaction::lennard_jones(),
    }
}

#[test]
fn every_method_gives_the_forces_and_energies_of_the_oracle() {
    for boundary in [Boundary::Periodic, Boundary::Wall] {
        let system = jittered(9, 1.1, boundary);
        let oracle = oracle::evaluate(&system);
        for &method in Method::ALL {
            for &images in Images::ALL {
                let mut engine = CpuEngine::new();
                engine.load(&system, &Plan { images, ..Plan::new(method) }).unwrap();
                let totals = engine.evaluate(Quantities::ALL).unwrap();
                assert_eq!(totals.pairs, oracle.pairs, "{method} {images}");
                let mut results = PerParticle::default();
                engine.per_particle(&mut results).expect("a copy");
                assert_eq!(results.neighbors, oracle.neighbors, "{method} {images}");
                let worst = results
                    .force
                    .iter()
                    .zip(&oracle.force)
                    .zip(&oracle.magnitude)
                    .map(|((a, b), m)| (0..3).map(|k| (f64::from(a[k]) - b[k]).abs()).fold(0.0, f64::max) / m);
                let worst = worst.fold(0.0, f64::max);
                assert!(worst < 1e-5, "{method} {images}: {worst:e}");
                assert!((totals.potential_energy - oracle.potential_energy).abs() < 1e-6 * oracle.energy_magnitude);
                assert!((totals.virial - oracle.virial).abs() < 1e-5 * oracle.virial_magnitude);
            }
        }
    }
}

#[test]
fn all_exact_methods_run_the_same_trajectory_bit_for_bit() {
    let system = jittered(8, 1.1, Boundary::Periodic);
    let mut states = Vec::new();
    for &method in Method::ALL {
        let mut engine = CpuEngine::new();
        engine.load(&system, &Plan { deterministic: true, ..Plan::new(method) }).unwrap();
        let totals = engine.advance(&Dynamics::nve(0.004), 0, 50, Quantities::ALL).unwrap();
        let mut particles = Particles::default();
        engine.snapshot(&mut particles).expect("a copy");
        states.push((method, totals, particles));
    }
    for (method, totals, particles) in &states[1..] {
        assert_eq!(particles, &states[0].2, "{method}");
        assert_eq!(totals, &states[0].1, "{method}");
    }
}

/// A list remembers where particles were when it was built, and f32 sums its order: both end where another engine may
/// take over, which goes on with what was learned of the best skin.
#[test]
fn a_run_of_clusters_continues_bit_for_bit_from_its_memory_order() {
    let system = jittered(8, 1.1, Boundary::Periodic);
    let dynamics = Dynamics::nve(0.004);
    for skin in [Skin::Fixed(0.4), Skin::Auto] {
        let plan = Plan { skin, ..Plan::new(Method::Cluster) };
        let mut whole = CpuEngine::new();
        whole.load(&system, &plan).unwrap();
        whole.advance(&dynamics, 0, 57, Quantities::FORCES).unwrap();
        let mut half = system.clone();
        whole.snapshot(&mut half.particles).unwrap();
        let order = whole.memory_order().unwrap();
        assert_ne!(
            order.ids,
            (0..order.ids.len() as u32).collect::<Vec<_>>(),
            "particles lie in the order of clusters"
        );
        assert_eq!(order.skin == Default::default(), skin != Skin::Auto, "{order:?}");
        whole.advance(&dynamics, 57, 90, Quantities::FORCES).unwrap();
        let mut continued = CpuEngine::new();
        continued.load(&half, &plan).unwrap();
        continued.set_memory_order(&order).unwrap();
        continued.advance(&dynamics, 57, 90, Quantities::FORCES).unwrap();
        let (mut expected, mut found) = (Particles::default(), Particles::default());
        whole.snapshot(&mut expected).unwrap();
        continued.snapshot(&mut found).unwrap();
        assert!(found == expected, "{skin}");
        assert!(whole.report().list_builds > 5, "{:?}", whole.report());
        assert_eq!(whole.report().skin, continued.report().skin, "{skin}");
    }
}

/// In one go, particles move in their blocks, each step by one pass; one at a time, by passes of their own, from where they
/// are copied to.
#[test]
fn steps_of_clusters_in_one_go_are_those_taken_one_at_a_time_bit_for_bit() {
    for boundary in [Boundary::Periodic, Boundary::Wall, Boundary::Open] {
        for list_tolerance in [0.0, 1e-3] {
            let mut system = jittered(7, 1.1, boundary);
            (0..7).for_each(|i| system.particles.velocity.set(50 * i, [9.0, -8.0, 7.0]));
            let plan = Plan { skin: Skin::Fixed(0.4), list_tolerance, ..Plan::new(Method::Cluster) };
            let [mut whole, mut pieces] = [(); 2].map(|()| {
                let mut engine = CpuEngine::new();
                engine.load(&system, &plan).unwrap();
                engine
            });
            let dynamics = Dynamics::nve(0.004);
            let (mut expected, mut found) = (Particles::default(), Particles::default());
            for piece in 0..3 {
                whole.advance(&dynamics, 40 * piece, 40, Quantities::FORCES).unwrap();
                for step in 40 * piece..40 * piece + 40 {
                    pieces.advance(&dynamics, step, 1, Quantities::FORCES).unwrap();
                    pieces.snapshot(&mut found).unwrap();
                }
                whole.snapshot(&mut expected).unwrap();
                assert!(found == expected, "{boundary:?} {list_tolerance} {piece}");
            }
            assert!(whole.report().list_builds > 3, "{:?}", whole.report());
            assert_eq!(whole.report().list_builds, pieces.report().list_builds);
            let crossed = expected.image.iter().any(|&image| image != [0; 3]);
            assert_eq!(crossed, boundary == Boundary::Periodic, "{boundary:?}");
        }
    }
}

/// Particles anywhere, fast enough to meet many others in some hundred steps.
fn gas(n: usize, length: f32, boundary: Boundary) -> System {
    let mut system = jittered(1, length, boundary);
    let mut seed = 7u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    system.particles = Particles::at((0..n).map(|_| [0; 3].map(|_: i32| length * random())).collect::<Vec<_>>());
    for i in 0..n {
        system.particles.velocity.set(i, [0; 3].map(|_: i32| 10.0 * (random() - 0.5)));
    }
    system
}

#[test]
fn sparse_systems_run_the_same_trajectory_bit_for_bit_whether_pairs_are_looked_for_or_all_are_tested() {
    for boundary in [Boundary::Periodic, Boundary::Wall, Boundary::Open] {
        let system = gas(1000, 70.0, boundary);
        let dynamics = Dynamics { max_displacement: 0.1, ..Dynamics::nve(0.01) };
        let run = |method, deterministic| {
            let mut engine = CpuEngine::new();
            let plan = Plan { deterministic, skin: Skin::NONE, ..Plan::new(method) };
            engine.load(&system, &plan).unwrap();
            // Particles are put in order at the beginning and twice more.
            let totals = engine.advance(&dynamics, 0, 230, Quantities::ALL).unwrap();
            let (mut particles, mut results) = (system.particles.clone(), PerParticle::default());
            engine.snapshot(&mut particles).unwrap();
            engine.per_particle(&mut results).unwrap();
            (particles, results, totals)
        };
        let expected = run(Method::Brute, true);
        assert!(expected.2.pairs > 50, "{}", expected.2.pairs);
        for (method, deterministic) in
            [(Method::Cell, true), (Method::Cell, false), (Method::Cluster, true), (Method::Cluster, false)]
        {
            let (particles, results, totals) = run(method, deterministic);
            assert_eq!(particles, expected.0, "{method} {boundary:?}");
            assert_eq!(results.force, expected.1.force, "{method} {boundary:?}");
            assert_eq!((results.energy, results.neighbors), (expected.1.energy.clone(), expected.1.neighbors.clone()));
            assert_eq!(totals, expected.2, "{method} {boundary:?}");
        }
    }
}
