//! Neighbour search in a program, against brute force over all pairs in all images.

use nearfield::{Boundary, Error, ListKind, ListRequest, NeighborSearch, Particles, Radii, SimBox};
use nearfield_core::{oracle, predicate};
use proptest::prelude::*;
use std::ops::ControlFlow;

fn boundary() -> impl Strategy<Value = Boundary> {
    prop_oneof![Just(Boundary::Periodic), Just(Boundary::Wall), Just(Boundary::Open)]
}

prop_compose! {
    /// Points in a box of lengths 4 to 12, some of them coincident, some on faces and on a lattice.
    fn cloud()(
        lengths in prop::array::uniform3(4.0f32..12.0),
        boundaries in prop::array::uniform3(boundary()),
        fractions in prop::collection::vec(prop::array::uniform3(prop_oneof![
            3 => 0.0f32..1.0,
            1 => (0u8..=4).prop_map(|k| f32::from(k) / 4.0),
        ]), 0..120),
        cutoff in 0.1f32..2.0,
        radii in prop::collection::vec(0.1f32..2.0, 120),
        has_radii in any::<bool>(),
    ) -> (SimBox, Vec<[f32; 3]>, Radii) {
        let sim_box = SimBox::new([0.0; 3], lengths, boundaries).unwrap();
        let points: Vec<_> = fractions
            .iter()
            .map(|f| std::array::from_fn(|axis| (f[axis] * lengths[axis]).min(lengths[axis])))
            .collect();
        let radii = if has_radii { Radii::PerParticle(radii[..points.len()].to_vec()) } else { Radii::Uniform(cutoff) };
        (sim_box, points, radii)
    }
}

/// What the search must find: brute force over the wrapped points.
fn expected(sim_box: &SimBox, points: &[[f32; 3]], radii: &Radii) -> Vec<oracle::Pair> {
    oracle::pairs(sim_box, &Particles::at(points.iter().map(|&p| sim_box.wrap(p).0)), radii)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_way_of_asking_gives_the_pairs_of_brute_force((sim_box, points, radii) in cloud()) {
        let expected = expected(&sim_box, &points, &radii);
        let search = NeighborSearch::with_radii(sim_box, points.clone(), radii).unwrap();
        prop_assert_eq!(search.n_points(), points.len());

        for kind in [ListKind::Half, ListKind::Full] {
            let list = search.neighbor_list(ListRequest { kind, shifts: true, distances: true, sorted: true });
            prop_assert_eq!(oracle::canonical(&list), expected.clone());
            prop_assert!((0..points.len()).all(|i| list.row(i).is_sorted()));
        }

        let mut visited = Vec::new();
        let flow = search.for_each_pair(|pair| {
            visited.push(oracle::Pair { i: pair.i, j: pair.j, image: pair.image });
            ControlFlow::<()>::Continue(())
        });
        prop_assert_eq!(flow, ControlFlow::Continue(()));
        visited.sort_unstable();
        prop_assert_eq!(&visited, &expected);

        let counts = search.counts();
        prop_assert_eq!(counts.pairs, expected.len() as u64);
        let mut neighbors = vec![0; points.len()];
        for pair in &expected {
            neighbors[pair.i as usize] += 1;
            neighbors[pair.j as usize] += 1;
        }
        prop_assert_eq!(counts.neighbors, neighbors);
    }

    #[test]
    fn a_query_finds_the_points_within_its_own_radius((sim_box, points, radii) in cloud(), split in 0usize..120) {
        let split = split.min(points.len());
        let (queries, indexed) = points.split_at(split);
        let radii = match radii {
            Radii::PerParticle(radii) => Radii::PerParticle(radii[..split].to_vec()),
            uniform => uniform,
        };
        let search = NeighborSearch::new(sim_box, indexed.to_vec(), 1.0).unwrap();
        let request = ListRequest { shifts: true, sorted: true, ..ListRequest::new(ListKind::Full) };
        let list = search.query(queries.to_vec(), radii.clone(), request).unwrap();
        prop_assert_eq!(list.n_particles(), queries.len());
        for (q, &query) in queries.iter().enumerate() {
            let from = sim_box.wrap(query).0;
            let mut near = Vec::new();
            for (j, &point) in indexed.iter().enumerate() {
                for image in sim_box.images() {
                    let dr = predicate::displacement(from, sim_box.wrap(point).0, sim_box.shift(image));
                    if predicate::is_neighbor(predicate::squared_length(dr), radii.get(q)) {
                        near.push((j as u32, image));
                    }
                }
            }
            let shifts = list.shifts.as_ref().unwrap();
            let mut found: Vec<_> = list.row_range(q).map(|entry| (list.indices[entry], shifts[entry])).collect();
            near.sort_unstable();
            found.sort_unstable();
            prop_assert_eq!(found, near, "query {}", q);
        }
    }

    #[test]
    fn a_visit_that_breaks_is_the_last((sim_box, points, radii) in cloud(), stop in 1usize..50) {
        let n_pairs = expected(&sim_box, &points, &radii).len();
        let search = NeighborSearch::with_radii(sim_box, points, radii).unwrap();
        let mut visits = 0;
        let flow = search.for_each_pair(|_| {
            visits += 1;
            if visits == stop { ControlFlow::Break(visits) } else { ControlFlow::Continue(()) }
        });
        prop_assert_eq!(visits, stop.min(n_pairs));
        prop_assert_eq!(flow.is_break(), stop <= n_pairs);
    }
}

fn message(result: Result<NeighborSearch, Error>) -> String {
    let error = result.expect_err("refused");
    assert!(error.is_request());
    error.to_string()
}

#[test]
fn wrong_points_and_cutoffs_are_named() {
    let periodic = SimBox::cubic(10.0, Boundary::Periodic).unwrap();
    let walls = SimBox::cubic(10.0, Boundary::Wall).unwrap();
    let two = |second: [f32; 3]| [[1.0; 3], second];
    let nan = NeighborSearch::new(periodic, two([1.0, 1.0, f32::NAN]), 1.0);
    assert!(message(nan).contains("particle 1: coordinate z is NaN"));
    let infinite = NeighborSearch::new(periodic, two([f32::INFINITY, 1.0, 1.0]), 1.0);
    assert!(message(infinite).contains("particle 1: coordinate x is inf"));
    assert!(message(NeighborSearch::new(walls, two([1.0, -0.1, 1.0]), 1.0)).contains("outside the walls [0, 10]"));
    for cutoff in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let text = message(NeighborSearch::new(periodic, two([2.0; 3]), cutoff));
        assert!(text.contains("must be positive and finite"), "{text}");
    }
    assert!(message(NeighborSearch::new(periodic, two([2.0; 3]), 5.1)).contains("exceeds half the periodic length"));
    let radii = |radii: &[f32]| NeighborSearch::with_radii(periodic, two([2.0; 3]), Radii::PerParticle(radii.to_vec()));
    assert!(message(radii(&[1.0, 0.0])).contains("particle 1: radius 0"));
    assert!(message(radii(&[6.0, 1.0])).contains("radius of particle 0"));
    assert!(message(radii(&[1.0])).contains("radii has 1 entries, but there are 2 particles"));

    let search = NeighborSearch::new(periodic, two([2.0; 3]), 1.0).unwrap();
    let query = |point: [f32; 3], cutoff| {
        let error =
            search.query([point], Radii::Uniform(cutoff), ListRequest::new(ListKind::Full)).expect_err("refused");
        error.to_string()
    };
    assert!(query([0.0, f32::NAN, 0.0], 1.0).contains("particle 0: coordinate y"));
    assert!(query([0.0; 3], 0.0).contains("must be positive and finite"));
}

#[test]
fn no_points_have_no_neighbours() {
    for boundary in [Boundary::Periodic, Boundary::Wall, Boundary::Open] {
        let sim_box = SimBox::cubic(10.0, boundary).unwrap();
        let search = NeighborSearch::new(sim_box, [], 1.0).unwrap();
        assert_eq!(search.counts().pairs, 0);
        assert_eq!(search.neighbor_list(ListRequest::new(ListKind::Full)).offsets, [0]);
        let list = search.query([[1.0; 3]], Radii::Uniform(1.0), ListRequest::new(ListKind::Full)).unwrap();
        assert_eq!(list.offsets, [0, 0]);
        let search = NeighborSearch::new(sim_box, [[1.0; 3]], 1.0).unwrap();
        let list = search.query([], Radii::Uniform(1.0), ListRequest::new(ListKind::Full)).unwrap();
        assert_eq!(list.offsets, [0]);
    }
}
