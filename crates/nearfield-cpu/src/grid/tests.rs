use super::*;
use crate::Slots;
use crate::testing::{Case, cases, uniform_points};
use nearfield_core::{Boundary, Radii, SimBox};

fn built(case: &Case) -> Grid {
    let mut grid = Grid::new();
    grid.build(&case.input());
    grid
}

#[test]
fn slots_are_a_permutation_of_the_particles_with_padding_behind() {
    for case in cases() {
        let kind: Vec<u32> = (0..case.particles.len() as u32).map(|i| i % 3).collect();
        let input = Input { kind: &kind, ..case.input() };
        let mut grid = Grid::new();
        grid.build(&input);
        let slots = grid.slots();
        assert_eq!(slots.len(), input.len(), "{}", case.name);
        let mut seen = vec![false; input.len()];
        for s in 0..slots.len() {
            let i = slots.particle[s] as usize;
            assert!(!std::mem::replace(&mut seen[i], true), "{}: {i} twice", case.name);
            assert_eq!(slots.at(s), input.at(i), "{}", case.name);
            assert_eq!(slots.kind[s], kind[i], "{}", case.name);
            if !slots.radius.is_empty() {
                assert_eq!(slots.radius[s], input.radius(i), "{}", case.name);
            }
        }
        assert!(slots.x[slots.len()..].iter().all(|&x| x == Slots::FAR));
        assert!(slots.particle[slots.len()..].iter().all(|&p| p == u32::MAX));
    }
}

#[test]
fn groups_cover_each_slot_once_and_are_of_one_class() {
    for case in cases() {
        let grid = built(&case);
        let mut next = 0;
        for g in 0..grid.n_groups() {
            let group = grid.group(g);
            assert_eq!(group.start, next, "{}", case.name);
            assert!((1..=GROUP_SIZE).contains(&group.len()), "{}", case.name);
            next = group.end;
            let limits: Vec<f32> = grid.layouts.iter().map(|layout| layout.limit).collect();
            let class = |s: usize| classes::class_of(&limits, case.input().radius(grid.slots().particle[s] as usize));
            assert!(group.clone().all(|s| class(s) == class(group.start)), "{}", case.name);
        }
        assert_eq!(next, case.particles.len(), "{}", case.name);
    }
}

#[test]
fn a_slot_is_proposed_at_most_once_in_an_image() {
    for case in cases() {
        let grid = built(&case);
        let (mut vicinity, mut runs) = (Vicinity::default(), Vec::new());
        for g in 0..grid.n_groups() {
            let uniform = if case.radii.is_uniform() { case.radii.largest() } else { 0.0 };
            let group = GroupBox::around(grid.slots(), grid.group(g), uniform).unwrap();
            runs.clear();
            grid.runs(&group, &mut vicinity, &mut runs);
            runs.sort_unstable_by_key(|run| (run.image, run.start));
            assert!(runs.iter().all(|run| run.start < run.end), "{}", case.name);
            for pair in runs.windows(2) {
                assert!(pair[0].image != pair[1].image || pair[0].end <= pair[1].start, "{}: {pair:?}", case.name);
            }
        }
    }
}

#[test]
fn what_is_kept_from_group_to_group_changes_no_run() {
    for case in cases() {
        let grid = built(&case);
        let uniform = if case.radii.is_uniform() { case.radii.largest() } else { 0.0 };
        let mut kept = Vicinity::default();
        for g in 0..grid.n_groups() {
            let own = GroupBox::around(grid.slots(), grid.group(g), uniform).unwrap();
            // Also across the bounds of pencils, of other radii, and far outside.
            let wider = GroupBox { lo: own.lo.map(|x| x - 0.3 * own.radius), radius: 0.7 * own.radius, ..own };
            let elsewhere = GroupBox { lo: own.hi.map(|x| x - 1e3), hi: own.hi.map(|x| x - 1e3), ..own };
            for group in [own, wider, own, elsewhere] {
                let (mut runs, mut expected) = (Vec::new(), Vec::new());
                grid.runs(&group, &mut kept, &mut runs);
                grid.runs(&group, &mut Vicinity::default(), &mut expected);
                assert_eq!(runs, expected, "{}, group {g}", case.name);
            }
        }
    }
}

#[test]
fn the_order_of_slots_does_not_depend_on_the_number_of_threads() {
    let sim_box = SimBox::cubic(50.0, Boundary::Periodic).unwrap();
    let case = Case::new("uniform, seed 21", sim_box, uniform_points(21, 40_000, [50.0; 3]), Radii::Uniform(1.0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let grid = pool.install(|| built(&case));
        (grid.slots.particle, grid.cells, grid.groups)
    };
    let one = on(1);
    for threads in [2, 3, 8] {
        assert!(on(threads) == one, "{threads} threads");
    }
}

#[test]
fn rebuilding_with_another_system_leaves_nothing_of_the_first() {
    let cases = cases();
    let mut reused = Grid::new();
    for case in cases.iter().chain(cases.iter().rev()) {
        reused.build(&case.input());
        let fresh = built(case);
        assert_eq!(reused.slots.particle, fresh.slots.particle, "{}", case.name);
        assert_eq!((&reused.groups, &reused.cells), (&fresh.groups, &fresh.cells), "{}", case.name);
        assert_eq!(reused.slots.radius, fresh.slots.radius, "{}", case.name);
    }
}

#[test]
fn memory_follows_the_particles_and_not_the_box() {
    for (length, clustered) in [(1e3, false), (1e6, false), (1e6, true), (30.0, false)] {
        let sim_box = SimBox::cubic(length, Boundary::Periodic).unwrap();
        let mut points = uniform_points(22, 100_000, [length; 3]);
        if clustered {
            points.iter_mut().skip(1000).for_each(|p| *p = p.map(|x| 0.5 * length + 1e-5 * x));
        }
        let grid = built(&Case::new("seed 22", sim_box, points, Radii::Uniform(1.0)));
        let per_particle = grid.bytes() as f64 / 1e5;
        assert!(per_particle < 60.0, "box {length}, clustered {clustered}: {per_particle} bytes per particle");
    }
}
