//! Neighbour lists: exactly the pairs of the predicate, on every input, by every plan.

use crate::{
    Factory,
    cases::{self, Case},
    plans,
};
use nearfield_core::{
    Dynamics, Engine, ListKind, ListRequest, NeighborList, Particles, Plan, Quantities, Skin, System,
    oracle::{self, Pair},
    predicate,
};

/// Half and full lists with shifts and distances.
pub fn half_and_full_lists_equal_the_oracle_bit_for_bit(factory: Factory) {
    compare_lists(factory, cases::all(), &plans::every());
}

/// Random boxes, boundaries, radii and positions, some of them on a grid so that ties are common.
pub fn lists_of_random_systems_equal_the_oracle(factory: Factory) {
    let cases = (0..80).map(|seed| Case { name: format!("random seed {seed}"), system: cases::random(seed) });
    compare_lists(factory, cases.collect(), &plans::each_structure());
}

/// The same on larger inputs, by one memory order.
pub fn lists_of_thousands_of_particles_equal_the_oracle(factory: Factory) {
    compare_lists(factory, cases::thousands(), &plans::each_structure());
}

fn compare_lists(factory: Factory, cases: Vec<Case>, plans: &[Plan]) {
    let mut engine = factory();
    for Case { name, system } in cases {
        let expected = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
        plans::run(&mut *engine, &system, plans, |engine, plan| {
            for kind in [ListKind::Half, ListKind::Full] {
                let request = ListRequest { kind, shifts: true, distances: true, sorted: kind == ListKind::Full };
                let list = engine.neighbor_list(request).unwrap_or_else(|error| panic!("{name}, {plan:?}: {error}"));
                check_list(&list, request, &system, &expected, &format!("{name}, {kind:?}, {plan:?}"));
            }
        });
    }
}

/// Checks the form of a list and every entry.
fn check_list(list: &NeighborList, request: ListRequest, system: &System, expected: &[Pair], what: &str) {
    let n = system.particles.len();
    assert_eq!((list.kind, list.offsets.len(), list.offsets[0]), (request.kind, n + 1, 0), "{what}");
    assert!(list.offsets.is_sorted(), "{what}: offsets descend");
    assert_eq!(list.offsets[n], list.indices.len() as u64, "{what}");
    let (shifts, distances) = (list.shifts.as_ref().expect("shifts"), list.distances.as_ref().expect("distances"));
    assert_eq!((shifts.len(), distances.len()), (list.n_entries(), list.n_entries()), "{what}");
    for i in 0..n {
        assert!(!request.sorted || list.row(i).is_sorted(), "{what}: row {i} is not sorted");
        for entry in list.row_range(i) {
            let j = list.indices[entry] as usize;
            assert!(j < n && j != i, "{what}: row {i} holds {j}");
            assert!(request.kind == ListKind::Full || j > i, "{what}: row {i} of a half list holds {j}");
            let position = &system.particles.position;
            let shift = system.sim_box.shift(shifts[entry]);
            let dr = predicate::displacement(position.get(i), position.get(j), shift);
            let distance = predicate::squared_length(dr).sqrt();
            assert_eq!(distances[entry].to_bits(), distance.to_bits(), "{what}: distance of {i} and {j}");
        }
    }
    assert_same_pairs(&oracle::canonical(list), expected, what);
}

/// Names the first difference: thousands of pairs are no message.
fn assert_same_pairs(found: &[Pair], expected: &[Pair], what: &str) {
    let missing = expected.iter().find(|pair| found.binary_search(pair).is_err());
    let surplus = found.iter().find(|pair| expected.binary_search(pair).is_err());
    assert!(
        missing.is_none() && surplus.is_none(),
        "{what}: {} pairs for {}; first missing {missing:?}, first too many {surplus:?}",
        found.len(),
        expected.len()
    );
}

/// Shifts and distances are optional.
pub fn a_list_holds_only_what_was_asked_for(factory: Factory) {
    let system = cases::lattice(4, 1.0, 1.5, cases::BOUNDARIES[0].1);
    let n_pairs = oracle::pairs(&system.sim_box, &system.particles, &system.radii).len();
    plans::run(&mut *factory(), &system, &plans::each_structure(), |engine, plan| {
        for kind in [ListKind::Half, ListKind::Full] {
            let plain = engine.neighbor_list(ListRequest::new(kind)).expect("a list");
            assert!(plain.shifts.is_none() && plain.distances.is_none(), "{plan:?}");
            assert_eq!(plain.n_pairs(), n_pairs, "{plan:?}");
            let shifts = engine.neighbor_list(ListRequest { shifts: true, ..ListRequest::new(kind) }).expect("a list");
            assert!(shifts.shifts.is_some() && shifts.distances.is_none(), "{plan:?}");
            assert_eq!(plain.offsets, shifts.offsets, "{plan:?}");
        }
    });
}

/// Neighbours of each particle and pairs in all, as an evaluation reports them.
pub fn counts_of_neighbors_equal_the_oracle(factory: Factory) {
    let mut engine = factory();
    for Case { name, system } in cases::all().into_iter().chain(cases::thousands()) {
        let expected = oracle::evaluate(&system);
        plans::run(&mut *engine, &system, &plans::each_structure(), |engine, plan| {
            let totals = engine.evaluate(Quantities::ALL).unwrap_or_else(|error| panic!("{name}, {plan:?}: {error}"));
            assert_eq!(totals.pairs, expected.pairs, "{name}, {plan:?}");
            let mut found = Default::default();
            engine.per_particle(&mut found).expect("a copy");
            assert_eq!(found.neighbors, expected.neighbors, "{name}, {plan:?}");
        });
    }
}

/// A list asked for after steps, when a stored structure or list belongs to older positions.
pub fn a_list_after_a_run_is_that_of_the_present_positions(factory: Factory) {
    let mut system = cases::liquid(4, 3.0, 0.1, 2.2, 3);
    let mut moved = Particles::default();
    let plans: Vec<_> = plans::every().into_iter().map(|plan| Plan { skin: Skin::Fixed(1.0), ..plan }).collect();
    let start = system.particles.clone();
    plans::run(&mut *factory(), &system.clone(), &plans, |engine: &mut dyn Engine, plan| {
        engine.advance(&Dynamics::nve(0.004), 0, 25, Quantities::FORCES).expect("a run");
        engine.snapshot(&mut moved).expect("a copy");
        assert_ne!(moved.position, start.position, "{plan:?}: nothing moved");
        system.particles.clone_from(&moved);
        let expected = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
        let request = ListRequest { kind: ListKind::Full, shifts: true, distances: true, sorted: true };
        let list = engine.neighbor_list(request).expect("a list");
        check_list(&list, request, &system, &expected, &format!("after a run, {plan:?}"));
    });
}
