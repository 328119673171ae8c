//! The gather consumer: each query sums the forces of its own neighbours.

use super::{
    Finish, Query,
    accumulate::{Exact, Fast, Summing},
    group::{Buffers, GROUPS_PER_TASK, Group, each_group},
    select::{Law, with_law},
};
use crate::{
    Structure,
    lanes::{self, Isa},
    parallel::for_each_chunk,
    physics::Physics,
};
use nearfield_core::interaction::Coefficients;
use std::{marker::PhantomData, ops::Range};

/// What a gather needs beside the pair law.
#[derive(Clone, Copy)]
struct Task<'a> {
    structure: &'a dyn Structure,
    physics: &'a Physics,
    finish: Finish<'a>,
}

/// Gathers forces, and energies where asked for, of every particle. With `exact`, sums do not depend on order.
pub(crate) fn gather(physics: &Physics, structure: &dyn Structure, exact: bool, energy: bool, finish: Finish) {
    let task = Task { structure, physics, finish };
    with_law!(physics, law, coefficients => {
        for_each_chunk(structure.n_groups(), GROUPS_PER_TASK, |groups, buffers: &mut Buffers| {
            dispatch(task, groups, exact, energy, law, coefficients, buffers);
        });
    });
}

fn dispatch<L: Law, C: Coefficients>(
    task: Task,
    groups: Range<usize>,
    exact: bool,
    energy: bool,
    law: &L,
    coefficients: C,
    buffers: &mut Buffers,
) {
    let isa = Isa::detect();
    // Other potentials cost more than their sums do: only Lennard-Jones is compiled in all variants.
    match (exact || !L::FAST, energy || !L::FAST) {
        (false, false) if L::FAST => {
            isa.run(Kernel::<_, _, Fast, false> { task, groups, law, coefficients, buffers, sums: PhantomData });
        }
        (false, true) if L::FAST => {
            isa.run(Kernel::<_, _, Fast, true> { task, groups, law, coefficients, buffers, sums: PhantomData });
        }
        (true, false) if L::FAST => {
            isa.run(Kernel::<_, _, Exact, false> { task, groups, law, coefficients, buffers, sums: PhantomData });
        }
        _ => isa.run(Kernel::<_, _, Exact, true> { task, groups, law, coefficients, buffers, sums: PhantomData }),
    }
}

struct Kernel<'a, L, C, A, const ENERGY: bool> {
    task: Task<'a>,
    groups: Range<usize>,
    law: &'a L,
    coefficients: C,
    buffers: &'a mut Buffers,
    sums: PhantomData<A>,
}

impl<L: Law, C: Coefficients, A: Summing, const ENERGY: bool> lanes::Kernel for Kernel<'_, L, C, A, ENERGY> {
    type Output = ();

    #[inline(always)]
    fn run<S: lanes::Lanes>(self, lanes: S) {
        let Self { task, groups, law, coefficients, buffers, .. } = self;
        let physics = task.physics;
        for g in groups {
            let Some(group) = each_group::<S, C>(lanes, task.structure, physics, g, buffers) else { continue };
            for slot in group.slots.clone() {
                let Some(query) = group.query(slot) else { continue };
                let mut sums = A::new(physics.grain);
                gather_query::<L, C, A, ENERGY>(law, coefficients, physics, &group, &query, &mut sums);
                (task.finish)(query.particle, &sums.finish());
            }
        }
    }
}

#[inline(always)]
fn gather_query<L: Law, C: Coefficients, A: Summing, const ENERGY: bool>(
    law: &L,
    coefficients: C,
    physics: &Physics,
    group: &Group,
    query: &Query,
    sums: &mut A,
) {
    for segment in &group.candidates.segments {
        let shift = group.shift(segment);
        let mut at = segment.start;
        if segment.image == [0; 3] {
            while at < segment.end {
                let block = group.block(at, &shift);
                super::evaluate::<L, C, A, ENERGY, false>(law, coefficients, physics.cap, query, &block, sums);
                at += crate::LANES;
            }
        } else {
            while at < segment.end {
                let block = group.block(at, &shift);
                super::evaluate::<L, C, A, ENERGY, true>(law, coefficients, physics.cap, query, &block, sums);
                at += crate::LANES;
            }
        }
    }
}
