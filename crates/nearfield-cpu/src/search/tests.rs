use super::*;
use crate::Brute;
use crate::testing::{Case, SeesLarger, cases, uniform_points};
use nearfield_core::{Boundary, Radii, SimBox, oracle, predicate};

fn visited(structure: &dyn Structure, case: &Case) -> Vec<oracle::Pair> {
    let mut pairs = Vec::new();
    let end = for_each_pair(structure, &case.input(), |pair| {
        let [xi, xj] = [pair.i, pair.j].map(|k| case.particles.position.get(k as usize));
        let dr = predicate::displacement(xi, xj, case.sim_box.shift(pair.image));
        assert_eq!(pair.r2, predicate::squared_length(dr), "{}", case.name);
        pairs.push(oracle::Pair { i: pair.i, j: pair.j, image: pair.image });
        ControlFlow::<()>::Continue(())
    });
    assert_eq!(end, ControlFlow::Continue(()));
    pairs.sort_unstable();
    pairs
}

#[test]
fn each_pair_is_visited_once_on_every_structure() {
    for case in cases() {
        let expected = oracle::pairs(&case.sim_box, &case.particles, &case.radii);
        let mut grid = Grid::new();
        grid.build(&case.input());
        assert_eq!(visited(&grid, &case), expected, "{}", case.name);
        if !case.radii.is_uniform() {
            let mut brute = Brute::new();
            brute.build(&case.input());
            assert_eq!(visited(&SeesLarger(brute), &case), expected, "{}", case.name);
        }
    }
}

#[test]
fn visiting_stops_at_the_first_break() {
    let sim_box = SimBox::cubic(5.0, Boundary::Periodic).unwrap();
    let case = Case::new("uniform, seed 41", sim_box, uniform_points(41, 500, [5.0; 3]), Radii::Uniform(1.0));
    let mut grid = Grid::new();
    grid.build(&case.input());
    let mut n = 0;
    let end = for_each_pair(&grid, &case.input(), |_| {
        n += 1;
        if n == 10 { ControlFlow::Break("enough") } else { ControlFlow::Continue(()) }
    });
    assert_eq!((n, end), (10, ControlFlow::Break("enough")));
}

#[test]
fn queries_of_another_set_find_the_points_within_their_own_radius() {
    for points in cases() {
        let lengths = points.sim_box.lengths();
        let lo = points.sim_box.lo();
        let largest = lengths.iter().fold(f32::INFINITY, |m, &l| m.min(l)) / 2.0;
        let places: Vec<_> =
            uniform_points(42, 60, lengths).iter().map(|p| std::array::from_fn(|a| lo[a] + p[a])).collect();
        let radii = (0..60).map(|k| largest * (1.0 + k as f32) / 60.0).collect();
        for radii in [Radii::PerParticle(radii), Radii::Uniform(0.3 * largest)] {
            let queries = Case::new("queries, seed 42", points.sim_box, places.clone(), radii);
            let mut grid = Grid::new();
            grid.build(&points.input());
            let request =
                ListRequest { shifts: true, distances: true, sorted: true, ..ListRequest::new(ListKind::Half) };
            let list = bipartite_list(&grid, &queries.input(), request);
            assert_eq!(list.n_particles(), queries.particles.len());
            for q in 0..queries.particles.len() {
                let found: Vec<_> = list
                    .row_range(q)
                    .map(|k| {
                        let shift = list.shifts.as_ref().unwrap()[k];
                        (list.indices[k], shift, list.distances.as_ref().unwrap()[k])
                    })
                    .collect();
                assert_eq!(found, within(&queries, q, &points), "{}, query {q}", points.name);
            }
        }
    }
}

/// Points within the radius of query `q`, by brute force.
fn within(queries: &Case, q: usize, points: &Case) -> Vec<(u32, [i8; 3], f32)> {
    let xq = queries.particles.position.get(q);
    let mut found = Vec::new();
    for j in 0..points.particles.len() {
        for image in points.sim_box.images() {
            let shift = points.sim_box.shift(image);
            let r2 = predicate::squared_length(predicate::displacement(xq, points.particles.position.get(j), shift));
            if predicate::is_neighbor(r2, queries.radii.get(q)) {
                found.push((j as u32, image, r2.sqrt()));
            }
        }
    }
    found
}
