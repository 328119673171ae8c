//! Neighbours of more particles than brute force on the host can manage.

use crate::loaded;
use nearfield::NeighborSearch;
use nearfield_conformance::cases;
use nearfield_core::{
    Boundary::{Open, Periodic, Wall},
    Engine, ListKind, ListRequest, Method, PerParticle, Plan, Quantities, Radii, System,
    oracle::{self, Pair},
};
use nearfield_cpu::CpuEngine;
use rand::SeedableRng;
use rand_distr::{Distribution, LogNormal};
use rand_pcg::Pcg64Mcg;
use std::sync::LazyLock;

const N: usize = 50_000;

/// Systems with the pairs that the CPU engine finds in them.
static SYSTEMS: LazyLock<Vec<(System, Vec<Pair>)>> = LazyLock::new(|| {
    let mut systems = Vec::new();
    for (boundary, seed) in [([Periodic; 3], 1), ([Wall; 3], 2), ([Periodic, Wall, Open], 3)] {
        let sim_box = cases::cube(40.0, boundary);
        let law = LogNormal::new(0.0f32, 0.5).expect("valid parameters");
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let radii = (0..N).map(|_| law.sample(&mut rng).min(8.0)).collect();
        for radii in [Radii::Uniform(1.7), Radii::PerParticle(radii)] {
            systems.push(cases::soft(sim_box, cases::uniform(N, &sim_box, seed), radii));
        }
    }
    let with_pairs = |system: System| {
        let mut cpu = CpuEngine::new();
        cpu.load(&system, &Plan::new(Method::Cell)).expect("the CPU engine takes it");
        let pairs = pairs(&mut cpu);
        (system, pairs)
    };
    systems.into_iter().map(with_pairs).collect()
});

fn pairs(engine: &mut dyn Engine) -> Vec<Pair> {
    let request = ListRequest { shifts: true, ..ListRequest::new(ListKind::Full) };
    oracle::canonical(&engine.neighbor_list(request).expect("a list"))
}

/// Indices, images and counts, in periodic, closed and mixed boxes, of one cutoff and of radii.
pub fn pairs_are_those_of_the_cpu(plan: &Plan) {
    for (system, expected) in SYSTEMS.iter() {
        let Some(mut engine) = loaded(system, plan) else { continue };
        let found = pairs(&mut engine);
        let boundary = system.sim_box.boundary();
        assert!(found == *expected, "{plan:?}, {boundary:?}: {} pairs for {}", found.len(), expected.len());
        let totals = engine.evaluate(Quantities::ALL).expect("an evaluation");
        let mut counted = PerParticle::default();
        engine.per_particle(&mut counted).expect("a copy");
        let mut counts = vec![0; N];
        for pair in expected {
            counts[pair.i as usize] += 1;
            counts[pair.j as usize] += 1;
        }
        assert!(counted.neighbors == counts && totals.pairs == expected.len() as u64, "{plan:?}, {boundary:?}");
    }
}

/// Indices, images and distances of queries by other points, of one radius and of many.
pub fn queries_are_answered_as_by_the_cpu() {
    const ALL: ListRequest = ListRequest { kind: ListKind::Full, shifts: true, distances: true, sorted: true };
    for (system, _) in SYSTEMS.iter() {
        let points = cases::uniform(30_001, &system.sim_box, 6);
        let of_each = (0..points.len()).map(|k| 0.1 + 4.0 * (k as f32 / points.len() as f32).powi(3)).collect();
        let search = NeighborSearch::with_radii(system.sim_box, system.particles.position.iter(), system.radii.clone());
        let search = search.expect("the system is valid");
        let mut engine = loaded(system, &Plan::new(Method::Cell)).expect("cells treat every system");
        for radii in [Radii::Uniform(1.3), Radii::PerParticle(of_each)] {
            let expected = search.query(points.iter().copied(), radii.clone(), ALL).expect("valid queries");
            let found = engine.query(points.iter().copied(), radii, ALL).expect("an answer");
            assert!(found == expected, "{} entries for {}", found.n_entries(), expected.n_entries());
        }
    }
}

/// Uniform particles and points of a sphere's surface, a million of each, with the pairs that `cell` finds in them.
static MILLIONS: LazyLock<Vec<(System, Vec<Pair>)>> = LazyLock::new(|| {
    const MILLION: usize = 1_000_000;
    let cube = cases::cube(100.0, [Periodic; 3]);
    let uniform = cases::soft(cube, cases::uniform(MILLION, &cube, 4), Radii::Uniform(1.2));
    let open = cases::cube(2.0, [Open; 3]);
    let onto_sphere = |x: [f32; 3]| {
        let from_center = x.map(|x| x - 1.0);
        let length = from_center.iter().map(|x| x * x).sum::<f32>().sqrt().max(1e-6);
        from_center.map(|x| 1.0 + 0.999 * x / length)
    };
    let points = cases::uniform(MILLION, &open, 5).into_iter().map(onto_sphere).collect();
    let sphere = cases::soft(open, points, Radii::Uniform(0.006));
    let with_pairs = |system: System| {
        let mut engine = super::engine();
        engine.load(&system, &Plan::new(Method::Cell)).expect("the system fits");
        let pairs = pairs(&mut engine);
        assert!(pairs.len() > 3 * MILLION, "{} pairs", pairs.len());
        (system, pairs)
    };
    [uniform, sphere].map(with_pairs).into()
});

/// Indices and images, of a million particles.
pub fn a_million_particles_have_the_pairs_that_cells_find(plan: &Plan) {
    for (system, expected) in MILLIONS.iter() {
        let mut engine = super::engine();
        engine.load(system, plan).expect("the system fits");
        assert!(pairs(&mut engine) == *expected, "{plan:?}");
    }
}
