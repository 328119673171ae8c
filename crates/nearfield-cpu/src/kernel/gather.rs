//! The gather consumer: each query sums the forces of its own neighbours.

use super::{
    Query, Sums,
    accumulate::{Accumulator, Exact, Fast, Summing},
    block::{Candidates, Lanes, evaluate},
    select::{Law, with_law},
};
use crate::{GroupBox, LANES, Run, Slots, Structure, physics::Physics};
use nearfield_core::interaction::{Coefficients, PairLaw};
use pulp::{Arch, NullaryFnOnce};
use std::ops::Range;

/// Receives the sums of each particle, once, in no particular order and from any thread.
pub(crate) type Finish<'a> = &'a (dyn Fn(u32, &Sums) + Sync);

/// What a gather needs beside the pair law.
#[derive(Clone, Copy)]
struct Task<'a> {
    structure: &'a dyn Structure,
    groups: &'a Range<usize>,
    physics: &'a Physics,
    finish: Finish<'a>,
}

/// Gathers forces, and energies where asked for, over groups of queries. With `exact`, sums do not depend on order.
pub(crate) fn gather(physics: &Physics, structure: &dyn Structure, exact: bool, energy: bool, finish: Finish) {
    with_law!(physics, law, coefficients => {
        crate::parallel::for_each_chunk(structure.n_groups(), GROUPS_PER_TASK, |groups, runs| {
            let task = Task { structure, groups: &groups, physics, finish };
            dispatch(task, exact, energy, law, coefficients, runs);
        });
    });
}

/// Groups one task handles: about 500 particles, tens of microseconds.
pub(super) const GROUPS_PER_TASK: usize = 48;

fn dispatch<L: Law, C: Coefficients>(
    task: Task,
    exact: bool,
    energy: bool,
    law: &L,
    coefficients: &C,
    runs: &mut Vec<Run>,
) {
    let arch = Arch::new();
    // Other potentials cost more than their sums do: only Lennard-Jones is compiled in all variants.
    match (exact || !L::FAST, energy || !L::FAST) {
        (false, false) if L::FAST => arch.dispatch(Kernel::<_, _, Fast, false>::new(task, law, coefficients, runs)),
        (false, true) if L::FAST => arch.dispatch(Kernel::<_, _, Fast, true>::new(task, law, coefficients, runs)),
        (true, false) if L::FAST => arch.dispatch(Kernel::<_, _, Exact, false>::new(task, law, coefficients, runs)),
        _ => arch.dispatch(Kernel::<_, _, Exact, true>::new(task, law, coefficients, runs)),
    }
}

struct Kernel<'a, L, C, A, const ENERGY: bool> {
    task: Task<'a>,
    law: &'a L,
    coefficients: &'a C,
    runs: &'a mut Vec<Run>,
    accumulator: std::marker::PhantomData<A>,
}

impl<'a, L, C, A, const ENERGY: bool> Kernel<'a, L, C, A, ENERGY> {
    fn new(task: Task<'a>, law: &'a L, coefficients: &'a C, runs: &'a mut Vec<Run>) -> Self {
        Self { task, law, coefficients, runs, accumulator: std::marker::PhantomData }
    }
}

impl<L: PairLaw, C: Coefficients, A: Summing, const ENERGY: bool> NullaryFnOnce for Kernel<'_, L, C, A, ENERGY> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { task, law, coefficients, runs, .. } = self;
        let (slots, physics) = (task.structure.slots(), task.physics);
        let cutoff = physics.cutoff();
        for g in task.groups.clone() {
            let group = task.structure.group(g);
            let Some(bounds) = group_box(slots, group.clone(), cutoff) else { continue };
            runs.clear();
            task.structure.runs(&bounds, runs);
            for slot in group {
                let particle = slots.particle[slot];
                if particle == u32::MAX {
                    continue;
                }
                let query = slot_query(slots, slot, cutoff);
                let mut sums = A::new(physics.grain);
                for run in runs.iter() {
                    let shift = physics.sim_box.shift(run.image);
                    gather_run::<L, C, A, ENERGY>(
                        law,
                        coefficients,
                        physics.cap,
                        &query,
                        slots,
                        run,
                        slot,
                        shift,
                        &mut sums,
                    );
                }
                (task.finish)(particle, &sums.finish());
            }
        }
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "an inlined piece of the kernel, not an interface")]
fn gather_run<L: PairLaw, C: Coefficients, A: Accumulator, const ENERGY: bool>(
    law: &L,
    coefficients: &C,
    cap: f32,
    query: &Query,
    slots: &Slots,
    run: &Run,
    own: usize,
    shift: [f32; 3],
    sums: &mut A,
) {
    let shift = [[shift[0]; LANES], [shift[1]; LANES], [shift[2]; LANES]];
    let mut s = run.start as usize;
    while s < run.end as usize {
        let block = slot_block::<C>(slots, s, run.end as usize, own, &shift);
        evaluate::<L, C, A, ENERGY>(law, coefficients, cap, query, &block, sums);
        s += LANES;
    }
}

/// The block of candidates that starts at slot `s`.
#[inline(always)]
pub(super) fn slot_block<'a, C: Coefficients>(
    slots: &'a Slots,
    s: usize,
    end: usize,
    own: usize,
    shift: &'a [Lanes<f32>; 3],
) -> Candidates<'a> {
    Candidates {
        x: lanes(&slots.x, s),
        y: lanes(&slots.y, s),
        z: lanes(&slots.z, s),
        radius: if C::VARIABLE_RANGE { lanes(&slots.radius, s) } else { &[0.0; LANES] },
        kind: if C::TYPED && !slots.kind.is_empty() { lanes(&slots.kind, s) } else { &[0; LANES] },
        shift,
        valid: (end - s) as u32,
        own: own.wrapping_sub(s).min(u32::MAX as usize) as u32,
    }
}

#[inline(always)]
fn lanes<T>(values: &[T], s: usize) -> &[T; LANES] {
    values[s..s + LANES].first_chunk().expect("the range has LANES elements")
}

/// The query that a slot's particle makes.
#[inline(always)]
pub(super) fn slot_query(slots: &Slots, slot: usize, cutoff: f32) -> Query {
    Query {
        position: slots.at(slot),
        radius: if slots.radius.is_empty() { cutoff } else { slots.radius[slot] },
        kind: if slots.kind.is_empty() { 0 } else { slots.kind[slot] },
    }
}

/// Bounds of a group's particles; `None` when it holds only padding.
#[inline(always)]
pub(crate) fn group_box(slots: &Slots, group: Range<usize>, cutoff: f32) -> Option<GroupBox> {
    let mut bounds = GroupBox { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3], radius: 0.0 };
    for slot in group.filter(|&slot| slots.particle[slot] != u32::MAX) {
        let query = slot_query(slots, slot, cutoff);
        for axis in 0..3 {
            bounds.lo[axis] = bounds.lo[axis].min(query.position[axis]);
            bounds.hi[axis] = bounds.hi[axis].max(query.position[axis]);
        }
        bounds.radius = bounds.radius.max(query.radius);
    }
    (bounds.radius > 0.0).then_some(bounds)
}
