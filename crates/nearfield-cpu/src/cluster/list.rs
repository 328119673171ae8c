//! The lists of cluster pairs, built from the grid.

use super::{
    balance::{self, Piece},
    blocks::{Blocks, PAGE},
    prune::Prune,
    quad::{self, Position, Quad, VECTORS, displacement, own_pairs, squared_length, twice},
};
use crate::{
    Grid, GroupBox, Run, Vicinity,
    lanes::{self, Lanes},
};
use nearfield_core::predicate::conservative_range;
use rayon::prelude::*;
use std::{
    ops::Range,
    sync::atomic::{AtomicU64, Ordering::Relaxed},
};

/// Tasks for each thread: enough for those that end early to help the others.
pub(super) const TASKS_PER_THREAD: usize = 4;

/// Entries of a list that is made for one use: they stay in the cache.
const BATCH: usize = 8192;

/// By what part of the skin blocks are nearer than the cutoff that each inner list has without a test, which nearly all of
/// them would pass.
const STAYING: f32 = 0.2;

/// Pairs of clusters and blocks that take as long as what else there is to do for each block: setting up and folding its
/// clusters, 4.7 ns a particle where a pair takes 9 to 12.
const WORK_OF_BLOCK: f64 = 4.0;

/// Fewest blocks worth a task.
const LEAST_BLOCKS: usize = 16;

/// Blocks listed with one cluster in one image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Two clusters to a block.
    pub cluster: u32,
    pub image: [i8; 3],
    /// Whether the first of the blocks is the cluster's own.
    pub own: bool,
    pub start: u32,
    pub end: u32,
    /// How many blocks, the first ones, are so near that each inner list has them.
    pub staying: u32,
}

/// A list of cluster pairs. Segments of a cluster follow each other.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    pub segments: Vec<Segment>,
    pub blocks: Vec<u32>,
}

impl Pairs {
    fn clear(&mut self) {
        self.segments.clear();
        self.blocks.clear();
    }

    /// Marks the pages of all blocks.
    fn mark_pages(&self, seen: &mut [bool]) {
        self.segments.iter().for_each(|segment| seen[segment.cluster as usize / 2 / PAGE] = true);
        // What is beyond the last segment is left over from a longer list.
        let end = self.segments.last().map_or(0, |segment| segment.end as usize);
        self.blocks[..end].iter().for_each(|&b| seen[b as usize / PAGE] = true);
    }

    /// Closes a segment of the blocks from `start` to `end`.
    pub fn close(&mut self, cluster: u32, image: [i8; 3], start: usize, end: usize, staying: usize) {
        if end > start {
            let own = self.blocks[start] == cluster / 2;
            let (start, end, staying) = (start as u32, end as u32, staying as u32);
            self.segments.push(Segment { cluster, image, own, start, end, staying });
        }
    }

    /// Appends a segment of what was found.
    fn push(&mut self, cluster: u32, image: [i8; 3], found: &Found) {
        let start = self.blocks.len();
        let (staying, mut others) = (&found.staying[..found.ends[0]], &found.others[..found.ends[1]]);
        // Its own block comes first, so where others stay it does, too.
        if let (false, Some((&first, rest))) = (staying.is_empty(), others.split_first())
            && first == cluster / 2
        {
            self.blocks.push(first);
            others = rest;
        }
        self.blocks.extend_from_slice(staying);
        let n_staying = if staying.is_empty() { 0 } else { self.blocks.len() - start };
        self.blocks.extend_from_slice(others);
        self.close(cluster, image, start, self.blocks.len(), n_staying);
    }

    /// Puts the segments of `other` after its own.
    fn append(&mut self, other: &Self) {
        let n = self.blocks.len() as u32;
        self.blocks.extend_from_slice(&other.blocks);
        self.segments.extend(other.segments.iter().map(|s| Segment { start: s.start + n, end: s.end + n, ..*s }));
    }

    fn bytes(&self) -> usize {
        self.segments.capacity() * size_of::<Segment>() + 4 * self.blocks.capacity()
    }
}

/// Blocks near a cluster: those that stay near it and the others, as far as the two ends.
#[derive(Default)]
struct Found {
    staying: Vec<u32>,
    others: Vec<u32>,
    ends: [usize; 2],
}

impl Found {
    /// Makes room for up to `most`, none of which is found yet.
    fn prepare(&mut self, most: usize) {
        self.ends = [0; 2];
        for blocks in [&mut self.staying, &mut self.others] {
            if blocks.len() < most {
                blocks.resize(most, 0);
            }
        }
    }

    /// Takes block `j` where it is near. It is written and then kept or not: a branch would be foretold wrongly half of the
    /// time.
    #[inline(always)]
    fn take(&mut self, j: u32, stays: bool, near: bool) {
        self.staying[self.ends[0]] = j;
        self.ends[0] += usize::from(stays);
        self.others[self.ends[1]] = j;
        self.ends[1] += usize::from(near & !stays);
    }
}

/// What pages of sums must be there for.
#[derive(Clone, Copy)]
pub(super) enum Reach<'a> {
    /// The outer lists, and whatever inner ones are made of them.
    Outer,
    /// The inner lists as they are.
    Inner,
    /// All that is within the cutoff: there is no list.
    Grid(&'a Grid),
}

/// The lists of consecutive blocks: the work of one task.
#[derive(Default)]
pub(super) struct Task {
    pub clusters_of: Range<usize>,
    /// All within cutoff and skin.
    pub outer: Pairs,
    /// What may be within the cutoff before the next pruning.
    pub inner: Pairs,
    vicinity: Vicinity,
    runs: Vec<Run>,
    /// What is near the second cluster of the block at hand.
    second: Pairs,
    /// What is near the two clusters in the image at hand.
    found: [Found; 2],
}

/// The list of all pairs, by task.
#[derive(Default)]
pub(super) struct PairList {
    pub tasks: Vec<Task>,
}

impl PairList {
    /// Divides the blocks among `per_thread` tasks for each thread, so that all are the same work if that is distributed as
    /// in some `pieces`.
    pub fn divide(&mut self, blocks: &Blocks, per_thread: usize, pieces: &[Piece]) {
        let n = blocks.len();
        let n_tasks = (per_thread * rayon::current_num_threads()).min(n.div_ceil(LEAST_BLOCKS)).max(1);
        let ends = balance::ends(pieces, n, n_tasks);
        self.tasks.resize_with(n_tasks, Task::default);
        let mut start = 0;
        for (task, end) in self.tasks.iter_mut().zip(ends) {
            task.clusters_of = start..end;
            start = end;
        }
    }

    /// Lists all pairs of clusters and blocks with particles within `reach`; false when that takes more than `budget`
    /// bytes.
    pub fn build(&mut self, grid: &Grid, blocks: &Blocks, reach: f32, budget: u64) -> bool {
        // As in the last list. Evenly is not enough: pairs through periodic faces are those of the first blocks, and the last
        // ones have few after them.
        let pieces: Vec<_> = self.tasks.iter().map(Task::piece).collect();
        self.divide(blocks, TASKS_PER_THREAD, &pieces);
        let bytes = AtomicU64::new(0);
        self.tasks.par_iter_mut().with_max_len(1).for_each(|task| {
            let (mut from, mut counted) = (task.clusters_of.start, 0);
            task.outer.clear();
            while from < task.clusters_of.end {
                let enough = task.outer.blocks.len() + BATCH;
                from = super::isa().run(Build { grid, blocks, reach, task, from, enough });
                let now = (task.outer.segments.len() * size_of::<Segment>() + 4 * task.outer.blocks.len()) as u64;
                // Twice: the inner list takes no more than the outer one.
                if bytes.fetch_add(2 * (now - counted), Relaxed) > budget {
                    return;
                }
                counted = now;
            }
        });
        bytes.into_inner() <= budget
    }

    /// Takes from the outer lists what may come within the cutoff while particles keep to their budgets, or what is within
    /// one `reach` of where they are expected.
    pub fn prune(&mut self, blocks: &Blocks, reach: Option<f32>) {
        self.tasks.par_iter_mut().with_max_len(1).for_each(|task| match reach {
            None => super::isa().run(Prune::<true> { blocks, reach: blocks.cutoff, task }),
            Some(reach) => super::isa().run(Prune::<false> { blocks, reach, task }),
        });
    }

    /// Pairs of clusters and blocks in the outer lists.
    pub fn entries(&self) -> u64 {
        self.tasks.iter().map(|task| task.outer.blocks.len() as u64).sum()
    }

    /// Pairs of clusters and blocks in the inner lists.
    pub fn entries_of_inner(&self) -> u64 {
        self.tasks.iter().map(|task| task.inner.segments.last().map_or(0, |last| u64::from(last.end))).sum()
    }

    /// Takes the outer lists as they are for the inner ones, for a single use.
    pub fn use_once(&mut self) {
        self.tasks.iter_mut().for_each(|task| std::mem::swap(&mut task.outer, &mut task.inner));
    }

    pub fn bytes(&self) -> usize {
        self.tasks.iter().map(|t| t.outer.bytes() + t.inner.bytes() + t.second.bytes()).sum()
    }
}

impl Task {
    /// Its blocks and the work that they are, in pairs of clusters and blocks.
    fn piece(&self) -> Piece {
        let blocks = self.clusters_of.len();
        Piece { blocks, work: self.outer.blocks.len() as f64 + WORK_OF_BLOCK * blocks as f64 }
    }

    /// Lists the pairs within the cutoff of some blocks after the others, each time in the place of those before.
    pub fn for_each_batch(&mut self, grid: &Grid, blocks: &Blocks, mut with: impl FnMut(&Pairs)) {
        let mut from = self.clusters_of.start;
        while from < self.clusters_of.end {
            self.outer.clear();
            from = super::isa().run(Build { grid, blocks, reach: blocks.cutoff, task: self, from, enough: BATCH });
            with(&self.outer);
        }
    }

    /// Marks the pages of blocks that are listed, or that may come to be where there is no list.
    pub fn mark_pages(&mut self, reach: Reach, blocks: &Blocks, seen: &mut [bool]) {
        let grid = match reach {
            Reach::Outer => return self.outer.mark_pages(seen),
            Reach::Inner => return self.inner.mark_pages(seen),
            Reach::Grid(grid) => grid,
        };
        self.clusters_of.clone().for_each(|b| seen[b / PAGE] = true);
        self.vicinity.clear();
        for first in self.clusters_of.clone().step_by(PAGE) {
            let some = first..(first + PAGE).min(self.clusters_of.end);
            let all = some.map(|b| bounds(blocks, b, blocks.cutoff)).reduce(|a, b| GroupBox {
                lo: std::array::from_fn(|axis| a.lo[axis].min(b.lo[axis])),
                hi: std::array::from_fn(|axis| a.hi[axis].max(b.hi[axis])),
                ..a
            });
            self.runs.clear();
            if let Some(all) = all {
                grid.find_runs_from(&all, blocks.first[first], &mut self.vicinity, &mut self.runs);
            }
            for run in &self.runs {
                let (from, to) = (blocks.block_of[run.start as usize], blocks.block_of[run.end as usize - 1]);
                seen[from as usize / PAGE..=to as usize / PAGE].fill(true);
            }
        }
    }
}

/// Lists the pairs of blocks beginning with `from`, until there are `enough` entries. Gives the block to go on with.
struct Build<'a> {
    grid: &'a Grid,
    blocks: &'a Blocks,
    reach: f32,
    task: &'a mut Task,
    from: usize,
    enough: usize,
}

impl lanes::Kernel for Build<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        let Self { grid, blocks, reach, task, from, enough } = self;
        let Task { clusters_of, outer, vicinity, runs, second, found, .. } = task;
        vicinity.clear();
        let staying = blocks.cutoff - STAYING * (reach - blocks.cutoff);
        let limits = Limits {
            reach2: lanes.splat(conservative_range(reach, blocks.extent).powi(2)),
            staying2: lanes.splat(if staying > 0.0 { staying * staying } else { 0.0 }),
        };
        let mut b = from;
        while b < clusters_of.end && outer.blocks.len() < enough {
            // Blocks are near by where they are expected, rows by where they are.
            let group = bounds(blocks, b, reach + blocks.lead);
            let midway = &blocks.midway[b];
            let positions = [quad::position(lanes, midway, 2 * b), quad::position(lanes, midway, 2 * b + 1)];
            runs.clear();
            second.clear();
            grid.find_runs(lanes, &group, blocks.first[b], vicinity, runs);
            for runs in runs.chunk_by(|a, b| a.image == b.image) {
                let image = runs[0].image;
                let quads = [
                    (Quad::new(lanes, blocks, 2 * b, image), positions[0]),
                    (Quad::new(lanes, blocks, 2 * b + 1, image), positions[1]),
                ];
                let most = runs.iter().map(|run| later_blocks(blocks, run, b).len()).sum();
                found.iter_mut().for_each(|found| found.prepare(most));
                for run in runs {
                    let run = later_blocks(blocks, run, b);
                    if image == [0; 3] {
                        find_near::<L, false>(lanes, blocks, &quads, &limits, b as u32, run, found);
                    } else {
                        find_near::<L, true>(lanes, blocks, &quads, &limits, b as u32, run, found);
                    }
                }
                outer.push(2 * b as u32, image, &found[0]);
                second.push(2 * b as u32 + 1, image, &found[1]);
            }
            outer.append(second);
            b += 1;
        }
        b
    }
}

/// Squares of how far pairs are listed and of how near they are to stay.
struct Limits<L: Lanes> {
    reach2: L::F,
    staying2: L::F,
}

/// Blocks of a run that are not before block `b`.
#[inline(always)]
fn later_blocks(blocks: &Blocks, run: &Run, b: usize) -> Range<u32> {
    blocks.block_of[run.start as usize].max(b as u32)..blocks.block_of[run.end as usize - 1] + 1
}

/// Finds the blocks of a run that are near either cluster of block `b`. No particle has crossed a face yet.
#[inline(always)]
fn find_near<L: Lanes, const IMAGES: bool>(
    lanes: L,
    blocks: &Blocks,
    quads: &[(Quad<L>, Position<L>); 2],
    limits: &Limits<L>,
    b: u32,
    run: Range<u32>,
    found: &mut [Found; 2],
) {
    for j in run {
        let at = twice(lanes, &blocks.midway[j as usize]);
        for half in 0..2 {
            let [first, second] = squared_lengths::<L, IMAGES>(lanes, blocks, &quads[half], j as usize, at);
            let (stays, near) = if j == b {
                let pairs = own_pairs(half);
                (
                    any_within(lanes, [first, second], [limits.staying2; VECTORS], pairs),
                    any_within(lanes, [first, second], [limits.reach2; VECTORS], pairs),
                )
            } else {
                let least = lanes.min(first, second);
                (lanes.lt(least, limits.staying2) != 0, lanes.lt(least, limits.reach2) != 0)
            };
            found[half].take(j, stays, near);
        }
    }
}

/// Whether any of the `pairs` of a cluster and a block is within its reach, by squares.
#[inline(always)]
pub(super) fn any_within<L: Lanes>(
    lanes: L,
    r2: [L::F; VECTORS],
    reach2: [L::F; VECTORS],
    pairs: [u16; VECTORS],
) -> bool {
    lanes.lt(r2[0], reach2[0]) & pairs[0] | lanes.lt(r2[1], reach2[1]) & pairs[1] != 0
}

/// Squared distances of a cluster and the particles of block `j`, which are `at`.
#[inline(always)]
pub(super) fn squared_lengths<L: Lanes, const IMAGES: bool>(
    lanes: L,
    blocks: &Blocks,
    (quad, own): &(Quad<L>, Position<L>),
    j: usize,
    at: [L::F; 3],
) -> [L::F; VECTORS] {
    let shifts = if IMAGES { quad.shifts(lanes, blocks, j) } else { [at; VECTORS] };
    let first = squared_length(lanes, displacement::<L, IMAGES>(lanes, &own[0], at, &shifts[0]));
    let second = squared_length(lanes, displacement::<L, IMAGES>(lanes, &own[1], at, &shifts[1]));
    [first, second]
}

/// The box around the particles of block `b` where they are expected.
fn bounds(blocks: &Blocks, b: usize, radius: f32) -> GroupBox {
    let n = blocks.particles(b).len();
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for axis in 0..3 {
        for &x in &blocks.midway[b].0[axis][..n] {
            lo[axis] = if x < lo[axis] { x } else { lo[axis] };
            hi[axis] = if x > hi[axis] { x } else { hi[axis] };
        }
    }
    GroupBox { lo, hi, radius }
}
