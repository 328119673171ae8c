//! Neighbours of one set of points in another, against those that the CPU finds. Ignored where the emulator was built
//! without a C++ compiler.

mod emulated;

use nearfield::NeighborSearch;
use nearfield_conformance::{cases, plans};
use nearfield_core::{Boundary, Dynamics, Engine, ListKind, ListRequest, Method, Plan, Quantities, Radii, System};
use nearfield_cuda::CudaEngine;
use nearfield_emulator::Emulator;
use std::sync::Arc;

const BOUNDARIES: [[Boundary; 3]; 3] =
    [[Boundary::Periodic; 3], [Boundary::Wall; 3], [Boundary::Open, Boundary::Periodic, Boundary::Wall]];

/// Everything that can be asked for, in a fixed order.
const ALL: ListRequest = ListRequest { kind: ListKind::Full, shifts: true, distances: true, sorted: true };

fn loaded(system: &System, plan: &Plan) -> CudaEngine {
    let mut engine = CudaEngine::on(Arc::new(Emulator::new().expect("an emulator")));
    engine.load(system, plan).expect("a load");
    engine
}

/// Asks both engines for the points near queries, at the positions of a run.
fn compare(system: &System, plan: &Plan, points: &[[f32; 3]], radii: &Radii, what: &str) {
    let mut engine = loaded(system, plan);
    if !system.particles.is_empty() {
        engine.advance(&Dynamics::nve(0.002), 0, 2, Quantities::FORCES).expect("a run");
    }
    let mut present = system.particles.clone();
    engine.snapshot(&mut present).expect("a copy");
    let search = NeighborSearch::with_radii(system.sim_box, present.position.iter(), system.radii.clone());
    let search = search.expect("the same particles");
    let expected = search.query(points.iter().copied(), radii.clone(), ALL).expect("the same queries");
    let found = engine.query(points.iter().copied(), radii.clone(), ALL).expect("an answer");
    assert!(found == expected, "{what}: {} entries for {}", found.n_entries(), expected.n_entries());
    let counts = engine.query_count_on_device(points.iter().copied(), radii.clone()).expect("an answer");
    let rows = expected.offsets.windows(2).map(|ends| (ends[1] - ends[0]) as u32);
    assert_eq!(counts.download().expect("a copy"), rows.collect::<Vec<_>>(), "{what}");
}

fn radii_up_to(largest: f32, n: usize) -> Radii {
    Radii::PerParticle((0..n).map(|k| largest * ((1 + k) as f32 / n as f32).powi(4)).collect())
}

fn queries_of_one_radius_and_of_many_find_what_the_cpu_finds() {
    for (seed, boundary) in BOUNDARIES.into_iter().enumerate() {
        let sim_box = cases::cube(10.0, boundary);
        let points = cases::uniform(333, &sim_box, 100 + seed as u64);
        for n in [1, 9, 1000] {
            let own = [Radii::Uniform(0.7), radii_up_to(3.0, n)];
            for own in own {
                let system = cases::soft(sim_box, cases::uniform(n, &sim_box, seed as u64), own);
                for radii in [Radii::Uniform(0.4), Radii::Uniform(5.0), radii_up_to(5.0, points.len())] {
                    let what = format!("{n} among {boundary:?}, radii up to {}", radii.largest());
                    compare(&system, &Plan::new(Method::Cell), &points, &radii, &what);
                }
            }
        }
    }
}

/// Queries where particles are, far from them, and at faces; few for a cluster or scattered.
fn queries_may_lie_anywhere() {
    let sim_box = cases::cube(8.0, [Boundary::Open, Boundary::Periodic, Boundary::Open]);
    let places = cases::uniform(200, &cases::cube(3.0, [Boundary::Open; 3]), 3);
    let system = cases::soft(sim_box, places.clone(), Radii::Uniform(1.0));
    let far = [[1e6, 0.0, 3.0], [-50.0, 7.999, 2.0], [0.0, 0.0, 0.0], [1.0, 8.0, -1e-3], [2.0, -31.0, 9.0]];
    let scattered: Vec<_> = places.iter().step_by(3).copied().chain(far).collect();
    for points in [&places[..], &far, &scattered] {
        for radii in [Radii::Uniform(1.5), radii_up_to(4.0, points.len())] {
            compare(&system, &Plan::new(Method::Cell), points, &radii, "anywhere");
        }
    }
}

fn any_method_of_the_run_gives_the_same_answers() {
    let sim_box = cases::cube(9.0, [Boundary::Periodic; 3]);
    let system = cases::soft(sim_box, cases::uniform(300, &sim_box, 8), Radii::Uniform(1.2));
    let points = cases::uniform(100, &sim_box, 9);
    for plan in plans::each_method() {
        compare(&system, &plan, &points, &Radii::Uniform(2.0), &format!("{plan:?}"));
    }
}

fn no_queries_and_no_particles_give_empty_rows() {
    let sim_box = cases::cube(9.0, [Boundary::Periodic; 3]);
    let some = cases::uniform(20, &sim_box, 8);
    let plan = Plan::new(Method::Cell);
    let none = || Vec::<[f32; 3]>::new();
    for (places, points) in [(none(), some.clone()), (some, none()), (none(), none())] {
        let radii = Radii::Uniform(2.0);
        compare(&cases::soft(sim_box, places, radii.clone()), &plan, &points, &radii, "nothing");
    }
}

fn wrong_queries_are_named() {
    let sim_box = cases::cube(9.0, [Boundary::Wall; 3]);
    let mut engine = loaded(&cases::soft(sim_box, vec![[1.0; 3]], Radii::Uniform(1.0)), &Plan::new(Method::Cell));
    let wrong = [[[1.0; 3], [f32::NAN, 0.0, 0.0]], [[1.0; 3], [1.0, 1.0, 10.0]]];
    for points in wrong {
        let error = engine.query(points, Radii::Uniform(1.0), ALL).expect_err("a wrong query").to_string();
        assert!(error.contains("particle 1"), "{error}");
    }
    let radii = Radii::PerParticle(vec![1.0, -1.0]);
    assert!(engine.query([[1.0; 3], [2.0; 3]], radii, ALL).is_err());
    let mut empty = CudaEngine::on(Arc::new(Emulator::new().expect("an emulator")));
    assert!(empty.query([[1.0; 3]], Radii::Uniform(1.0), ALL).is_err());
}

fn main() {
    let tests: [(&str, fn()); 5] = [
        (
            "queries_of_one_radius_and_of_many_find_what_the_cpu_finds",
            queries_of_one_radius_and_of_many_find_what_the_cpu_finds,
        ),
        ("queries_may_lie_anywhere", queries_may_lie_anywhere),
        ("any_method_of_the_run_gives_the_same_answers", any_method_of_the_run_gives_the_same_answers),
        ("no_queries_and_no_particles_give_empty_rows", no_queries_and_no_particles_give_empty_rows),
        ("wrong_queries_are_named", wrong_queries_are_named),
    ];
    emulated::run(tests);
}
