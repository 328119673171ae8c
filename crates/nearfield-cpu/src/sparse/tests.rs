use super::*;
use crate::testing::{Case, cases, uniform_points};
use nearfield_core::{Boundary, Radii, oracle};

fn built(case: &Case) -> Grid {
    let mut grid = Grid::new();
    grid.build(&case.input());
    grid
}

fn sorted(pairs: &[Pair]) -> Vec<oracle::Pair> {
    let mut pairs: Vec<oracle::Pair> = pairs
        .iter()
        .map(|&Pair { i, j, image }| match i < j {
            true => oracle::Pair { i, j, image },
            false => oracle::Pair { i: j, j: i, image: image.map(|s| -s) },
        })
        .collect();
    pairs.sort_unstable();
    pairs
}

#[test]
fn each_pair_is_found_once_whatever_the_system_and_the_instruction_set() {
    for case in cases().into_iter().filter(|case| case.radii.is_uniform()) {
        let grid = built(&case);
        let expected = oracle::pairs(&case.sim_box, &case.particles, &case.radii);
        for isa in Isa::available() {
            let mut found = SparsePairs::default();
            assert!(found.find_on(isa, &grid, &case.sim_box, case.radii.largest(), usize::MAX), "{}", case.name);
            assert_eq!(sorted(&found.pairs), expected, "{}, {}", case.name, isa.name());
        }
    }
}

#[test]
fn pairs_across_faces_are_found_where_there_are_many_pencils() {
    for boundary in [Boundary::Periodic, Boundary::Wall, Boundary::Open] {
        let sim_box = SimBox::new([-60.0, 1e3, 0.0], [60.0, 1.1e3, 110.0], [boundary; 3]).unwrap();
        let points = uniform_points(31, 20_000, [120.0, 100.0, 110.0]);
        let points = points.into_iter().map(|[x, y, z]| [x - 60.0, y + 1e3, z]).collect();
        let case = Case::new(&format!("gas, seed 31, {boundary:?}"), sim_box, points, Radii::Uniform(1.2));
        let grid = built(&case);
        assert!(grid.n_pencils() > 100 && is_sparse(&grid, 1.2));
        let expected = oracle::pairs(&case.sim_box, &case.particles, &case.radii);
        assert!(expected.len() > 500);
        let mut found = SparsePairs::default();
        assert!(found.find(&grid, &case.sim_box, 1.2));
        assert_eq!(sorted(&found.pairs), expected, "{}", case.name);
    }
}

#[test]
fn a_clump_that_density_does_not_show_is_given_up() {
    let mut points = uniform_points(32, 20_000, [1e3; 3]);
    points[..4000].iter_mut().for_each(|p| *p = p.map(|x| 500.0 + 1e-4 * x));
    let sim_box = SimBox::cubic(1e3, Boundary::Wall).unwrap();
    let case = Case::new("clump, seed 32", sim_box, points, Radii::Uniform(1.0));
    let mut found = SparsePairs::default();
    assert!(!found.find(&built(&case), &case.sim_box, 1.0));
    assert!(found.pairs.is_empty());
}
