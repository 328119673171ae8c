use super::rows::Contents;
use super::*;
use crate::lanes::Isa;
use crate::testing::{Case, SeesLarger, cases, uniform_points};
use crate::{Brute, Grid, Structure, count_neighbors};
use nearfield_core::{Boundary, ListKind, ListRequest, NeighborList, Radii, SimBox, oracle, predicate};

fn request(kind: ListKind) -> ListRequest {
    ListRequest { shifts: true, ..ListRequest::new(kind) }
}

/// Every structure over a case, named.
fn structures(case: &Case) -> Vec<(&'static str, Box<dyn Structure>)> {
    let input = case.input();
    let mut grid = Grid::new();
    grid.build(&input);
    let mut brute = Brute::new();
    brute.build(&input);
    let mut structures: Vec<(&'static str, Box<dyn Structure>)> = vec![("grid", Box::new(grid))];
    if !case.radii.is_uniform() {
        let mut inner = Brute::new();
        inner.build(&input);
        structures.push(("incomplete", Box::new(SeesLarger(inner))));
    }
    structures.push(("brute", Box::new(brute)));
    structures
}

#[test]
fn lists_of_every_structure_hold_exactly_the_pairs_of_the_oracle() {
    for case in cases() {
        let expected = oracle::pairs(&case.sim_box, &case.particles, &case.radii);
        for (name, structure) in structures(&case) {
            for kind in [ListKind::Half, ListKind::Full] {
                let list = neighbor_list(&*structure, &case.input(), request(kind));
                assert_eq!(oracle::canonical(&list), expected, "{}, {name}, {kind:?}", case.name);
                if kind == ListKind::Half {
                    assert!(list.pairs().all(|(i, j)| i < j), "{}, {name}", case.name);
                }
            }
        }
    }
}

#[test]
fn counts_agree_with_the_full_list() {
    for case in cases() {
        for (name, structure) in structures(&case) {
            let list = neighbor_list(&*structure, &case.input(), ListRequest::new(ListKind::Full));
            let counts = count_neighbors(&*structure, &case.input());
            let rows: Vec<u32> = (0..list.n_particles()).map(|i| list.row(i).len() as u32).collect();
            assert_eq!(counts.neighbors, rows, "{}, {name}", case.name);
            assert_eq!(counts.pairs, list.n_pairs() as u64, "{}, {name}", case.name);
        }
    }
}

#[test]
fn sorted_rows_ascend_and_keep_images_and_distances_with_their_neighbor() {
    for case in cases() {
        for (name, structure) in structures(&case) {
            let request = ListRequest { kind: ListKind::Full, shifts: true, distances: true, sorted: true };
            let list = neighbor_list(&*structure, &case.input(), request);
            let shifts = list.shifts.as_ref().unwrap();
            let distances = list.distances.as_ref().unwrap();
            for i in 0..list.n_particles() {
                assert!(list.row(i).is_sorted(), "{}, {name}", case.name);
                for entry in list.row_range(i) {
                    let [xi, xj] = [i, list.indices[entry] as usize].map(|k| case.particles.position.get(k));
                    let dr = predicate::displacement(xi, xj, case.sim_box.shift(shifts[entry]));
                    assert_eq!(distances[entry], predicate::squared_length(dr).sqrt(), "{}, {name}", case.name);
                }
            }
        }
    }
}

#[test]
fn every_instruction_set_lists_the_same_rows() {
    let contents = [
        Contents::Count,
        Contents::Rows { images: false, distances: false },
        Contents::Rows { images: true, distances: true },
    ];
    for case in cases() {
        let mut grid = Grid::new();
        grid.build(&case.input());
        let queries = Queries::new(&grid, &case.input());
        for rule in [Rule::Full, Rule::Half, Rule::Acting, Rule::Bipartite] {
            if rule == Rule::Acting && case.radii.is_uniform() {
                continue;
            }
            for contents in contents {
                let rows = |isa: Isa| {
                    let mut rows = Rows::default();
                    rows.collect_on(isa, &grid, &case.sim_box, queries, 0..grid.n_groups(), rule, contents);
                    rows
                };
                let expected = rows(Isa::Portable);
                assert_eq!(expected.len(), case.particles.len());
                for isa in Isa::available() {
                    let found = rows(isa);
                    assert!(found.iter().eq(expected.iter()), "{}, {rule:?}, {contents:?}, {isa:?}", case.name);
                    assert_eq!(found.n_entries(), expected.n_entries());
                }
            }
        }
    }
}

#[test]
fn batches_of_groups_together_give_the_whole_list() {
    let sim_box = SimBox::cubic(12.0, Boundary::Periodic).unwrap();
    let case = Case::new("uniform, seed 31", sim_box, uniform_points(31, 2000, [12.0; 3]), Radii::Uniform(1.5));
    let mut grid = Grid::new();
    grid.build(&case.input());
    let list = neighbor_list(&grid, &case.input(), ListRequest::new(ListKind::Half));
    let mut rows = Rows::default();
    let mut n_rows = 0;
    for first in (0..grid.n_groups()).step_by(37) {
        rows.list(&grid, &case.input(), first..(first + 37).min(grid.n_groups()), ListKind::Half, true, false);
        for row in rows.iter() {
            assert_eq!(row.neighbors, list.row(row.particle as usize));
            assert_eq!((row.images.len(), row.r2.len()), (row.neighbors.len(), 0));
            n_rows += 1;
        }
    }
    assert_eq!(n_rows, 2000);
}

#[test]
fn a_builder_reused_gives_the_list_of_a_fresh_one() {
    let mut builder = ListBuilder::default();
    let mut list =
        NeighborList { kind: ListKind::Half, offsets: vec![0], indices: Vec::new(), shifts: None, distances: None };
    for (k, case) in cases().iter().enumerate() {
        let (_, structure) = structures(case).swap_remove(0);
        let request = ListRequest {
            kind: [ListKind::Half, ListKind::Full][k % 2],
            shifts: k % 3 == 0,
            distances: k % 5 == 0,
            sorted: k % 7 == 0,
        };
        builder.build(&*structure, &case.input(), request, &mut list);
        assert!(list == neighbor_list(&*structure, &case.input(), request), "{}", case.name);
    }
}

#[test]
fn a_large_system_on_many_threads_is_listed_as_on_one() {
    let sim_box = SimBox::cubic(40.0, Boundary::Periodic).unwrap();
    let case = Case::new("uniform, seed 32", sim_box, uniform_points(32, 30_000, [40.0; 3]), Radii::Uniform(1.5));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut grid = Grid::new();
            grid.build(&case.input());
            neighbor_list(&grid, &case.input(), request(ListKind::Full))
        })
    };
    let one = on(1);
    assert!(one.n_pairs() > 90_000, "{}", one.n_pairs());
    assert!(on(7) == one);
}

#[test]
fn a_grid_sorted_by_several_tasks_counts_what_all_pairs_count() {
    let sim_box = SimBox::cubic(60.0, Boundary::Periodic).unwrap();
    let radii = (0..12_000).map(|k| 0.1 * 200f32.powf((k % 101) as f32 / 100.0)).collect();
    let points = uniform_points(33, 12_000, [60.0; 3]);
    for radii in [Radii::PerParticle(radii), Radii::Uniform(3.0)] {
        let case = Case::new("uniform, seed 33", sim_box, points.clone(), radii);
        let mut brute = Brute::new();
        brute.build(&case.input());
        let expected = count_neighbors(&brute, &case.input());
        assert!(expected.pairs > 30_000, "{}", expected.pairs);
        for group_size in [1, 8, 16, 100] {
            let mut grid = Grid::with_group_size(group_size);
            grid.build(&case.input());
            assert!(count_neighbors(&grid, &case.input()) == expected, "groups of {group_size}");
        }
    }
}
