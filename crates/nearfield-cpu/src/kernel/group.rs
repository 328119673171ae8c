//! A group of queries with the candidates of all of them, near in memory.

use super::{
    Query,
    block::{Block, Lanes},
};
use crate::{
    GroupBox, LANES, Run, Slots, Structure, Vicinity,
    candidates::{Candidates, Segment},
    lanes,
    physics::Physics,
};
use nearfield_core::{SimBox, interaction::Coefficients};
use std::ops::Range;

/// Groups one task handles: about 500 particles, tens of microseconds.
pub(super) const GROUPS_PER_TASK: usize = 48;

/// What a task keeps from group to group.
#[derive(Default)]
pub(super) struct Buffers {
    vicinity: Vicinity,
    runs: Vec<Run>,
    candidates: Candidates,
}

/// A group whose candidates have been gathered.
pub(super) struct Group<'a> {
    from: &'a Slots,
    sim_box: &'a SimBox,
    cutoff: f32,
    /// The slots of the queries.
    pub slots: Range<usize>,
    pub candidates: &'a Candidates,
}

/// Gathers the candidates of group `g`; `None` when it holds only padding.
#[inline(always)]
pub(super) fn each_group<'a, S: lanes::Lanes, C: Coefficients>(
    lanes: S,
    structure: &'a dyn Structure,
    physics: &'a Physics,
    g: usize,
    buffers: &'a mut Buffers,
) -> Option<Group<'a>> {
    let (from, slots, cutoff) = (structure.slots(), structure.group(g), physics.cutoff());
    let bounds = GroupBox::around(from, slots.clone(), cutoff)?;
    let Buffers { vicinity, runs, candidates } = buffers;
    runs.clear();
    structure.runs(&bounds, vicinity, runs);
    let typed = C::TYPED && !from.kind.is_empty();
    candidates.gather(lanes, (from, &physics.sim_box), &bounds, runs, C::VARIABLE_RANGE, typed);
    Some(Group { from, sim_box: &physics.sim_box, cutoff, slots, candidates })
}

impl<'a> Group<'a> {
    /// The query of a slot's particle; `None` for padding.
    #[inline(always)]
    pub fn query(&self, slot: usize) -> Option<Query> {
        let particle = self.from.particle[slot];
        (particle != u32::MAX).then(|| Query {
            position: self.from.at(slot),
            radius: if self.from.radius.is_empty() { self.cutoff } else { self.from.radius[slot] },
            kind: if self.from.kind.is_empty() { 0 } else { self.from.kind[slot] },
            particle,
        })
    }

    /// The displacement of a segment's image, for each lane.
    #[inline(always)]
    pub fn shift(&self, segment: &Segment) -> [Lanes<f32>; 3] {
        let shift = self.sim_box.shift(segment.image);
        [[shift[0]; LANES], [shift[1]; LANES], [shift[2]; LANES]]
    }

    /// The block of candidates from `at` on.
    #[inline(always)]
    pub fn block(&self, at: usize, shift: &'a [Lanes<f32>; 3]) -> Block<'a> {
        let c = self.candidates;
        Block {
            x: chunk(&c.x, at),
            y: chunk(&c.y, at),
            z: chunk(&c.z, at),
            radius: chunk(&c.radius, at),
            kind: chunk(&c.kind, at),
            particle: chunk(&c.particle, at),
            shift,
        }
    }
}

#[inline(always)]
fn chunk<T>(values: &[T], at: usize) -> &Lanes<T> {
    values[at..].first_chunk().expect("candidates are whole chunks")
}
