//! Inner lists: what the next few evaluations need of the outer ones.

use super::{
    BLOCK,
    blocks::Blocks,
    list::{Task, any_within, squared_lengths},
    quad::{self, Quad, VECTORS, own_pairs, twice},
};
use crate::{
    lanes::{self, Lanes},
    list::copy,
};
use nearfield_core::predicate::conservative_range;

/// Keeps what is within `reach`, and where there are `BUDGETS` those of both particles.
pub(super) struct Prune<'a, const BUDGETS: bool> {
    pub blocks: &'a Blocks,
    pub reach: f32,
    pub task: &'a mut Task,
}

impl<const BUDGETS: bool> lanes::Kernel for Prune<'_, BUDGETS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { blocks, reach, task } = self;
        // Slices of one length need but one test of an index.
        let n = blocks.len();
        let outlook = &blocks.outlook[..n];
        let crossed = &blocks.crossed[..n];
        let fixed = lanes.splat(conservative_range(reach, blocks.extent).powi(2));
        let Task { outer, inner, .. } = task;
        inner.segments.clear();
        // What is beyond the last segment is left over.
        inner.blocks.resize(outer.blocks.len(), 0);
        let mut end = 0;
        for segment in &outer.segments {
            let cluster = segment.cluster as usize;
            let (block, at) = (cluster / 2, cluster % 2 * quad::CLUSTER);
            let quad = (
                Quad::new(lanes, blocks, cluster, segment.image),
                quad::position(lanes, &outlook[block].midway, cluster),
            );
            let range = |lane: usize| conservative_range(reach + outlook[block].budget[at + lane], blocks.extent);
            let ranges = [lanes.halves(range(0), range(1)), lanes.halves(range(2), range(3))];
            let with_images = segment.image != [0; 3] || crossed[block];
            let kept = &mut inner.blocks[..];
            let listed = &outer.blocks[segment.start as usize..segment.end as usize];
            let (staying, mut others) = listed.split_at(segment.staying as usize);
            let start = end;
            copy(staying, &mut kept[end..end + staying.len()]);
            end += staying.len();
            if let (true, true, Some((&own, rest))) = (segment.own, staying.is_empty(), others.split_first()) {
                let mut reach2 = [fixed; VECTORS];
                if BUDGETS {
                    let reach = reach_of_pairs(lanes, ranges, &outlook[block].budget);
                    reach2 = [lanes.mul(reach[0], reach[0]), lanes.mul(reach[1], reach[1])];
                }
                let at = twice(lanes, &outlook[block].midway);
                let r2 = squared_lengths::<L, true>(lanes, blocks, &quad, block, at);
                kept[end] = own;
                end += usize::from(any_within(lanes, r2, reach2, own_pairs(cluster)));
                others = rest;
            }
            for &j in others {
                let b = j as usize;
                let at = twice(lanes, &outlook[b].midway);
                let r2 = if with_images || crossed[b] {
                    squared_lengths::<L, true>(lanes, blocks, &quad, b, at)
                } else {
                    squared_lengths::<L, false>(lanes, blocks, &quad, b, at)
                };
                // One compare of a vector for the two of a cluster.
                let near = if BUDGETS {
                    let reach = reach_of_pairs(lanes, ranges, &outlook[b].budget);
                    let spare = [lanes.mul_sub(reach[0], reach[0], r2[0]), lanes.mul_sub(reach[1], reach[1], r2[1])];
                    lanes.lt(lanes.splat(0.0), lanes.max(spare[0], spare[1]))
                } else {
                    lanes.lt(lanes.min(r2[0], r2[1]), fixed)
                };
                // Written and then kept or not: a branch would be foretold wrongly half of the time.
                kept[end] = j;
                end += usize::from(near != 0);
            }
            inner.close(segment.cluster, segment.image, start, end, end - start);
        }
    }
}

/// How far the particles of a cluster, of `ranges`, and those of a block with their budgets reach together.
#[inline(always)]
fn reach_of_pairs<L: Lanes>(lanes: L, ranges: [L::F; VECTORS], budget: &[f32; BLOCK]) -> [L::F; VECTORS] {
    let theirs = lanes.twice(budget);
    [lanes.add(ranges[0], theirs), lanes.add(ranges[1], theirs)]
}
