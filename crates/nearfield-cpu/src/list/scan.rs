//! The kernel: candidates tested against each query of a group, those within range appended to its row.

use super::rows::{Contents, Output, Queries, Room, Rows, Stream, TOGETHER};
use super::rule::{Acting, Bipartite, Full, Half, Keep, Lane, Query, Rule};
use crate::candidates::{Candidates, Segment};
use crate::lanes::{Kernel, Lanes};
use crate::{GroupBox, LANES, Slots, Structure};
use nearfield_core::SimBox;
use std::ops::Range;

/// Fills `rows` with the neighbours of the queries in some groups.
pub(super) struct Scan<'a> {
    pub structure: &'a dyn Structure,
    pub sim_box: &'a SimBox,
    pub queries: Queries<'a>,
    pub groups: Range<usize>,
    pub rule: Rule,
    pub contents: Contents,
    pub rows: &'a mut Rows,
}

impl Kernel for Scan<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let slots = self.structure.slots();
        let per_particle = !slots.radius.is_empty() && self.rule != Rule::Bipartite;
        let Rows { vicinity, runs, candidates, output } = self.rows;
        vicinity.clear();
        output.clear(self.contents);
        for g in self.groups {
            let group = self.queries.structure.group(g);
            let Some(bounds) = GroupBox::around(self.queries.slots, group.clone(), self.queries.uniform) else {
                continue;
            };
            runs.clear();
            self.structure.runs(&bounds, vicinity, runs);
            candidates.gather(lanes, (slots, self.sim_box), &bounds, runs, per_particle, false);
            let work =
                Group { queries: self.queries, group, sim_box: self.sim_box, candidates, contents: self.contents };
            match (self.rule, per_particle) {
                (Rule::Full, false) => work.scan::<L, Full<false>>(lanes, output),
                (Rule::Full, true) => work.scan::<L, Full<true>>(lanes, output),
                (Rule::Half, false) => work.scan::<L, Half<false>>(lanes, output),
                (Rule::Half, true) => work.scan::<L, Half<true>>(lanes, output),
                (Rule::Acting, _) => work.scan::<L, Acting>(lanes, output),
                (Rule::Bipartite, _) => work.scan::<L, Bipartite>(lanes, output),
            }
        }
    }
}

struct Group<'a> {
    queries: Queries<'a>,
    group: Range<usize>,
    sim_box: &'a SimBox,
    candidates: &'a Candidates,
    contents: Contents,
}

impl Group<'_> {
    #[inline(always)]
    fn scan<L: Lanes, K: Keep>(self, lanes: L, output: &mut Output) {
        let slots = self.queries.slots;
        let Room { n_rows, particle: particles, ends, streams } =
            output.room_for(self.group.len(), self.candidates.len());
        let [even, odd] = streams;
        let mut slot = self.group.start;
        while let Some(first) = next_particle(slots, slot..self.group.end) {
            let second = next_particle(slots, first + 1..self.group.end);
            slot = second.map_or(
                self.group.end,
                #[inline(always)]
                |slot| slot + 1,
            );
            // In place of a second one that there is not: nothing is within range of it.
            let nowhere = Query::new(lanes, [Slots::FAR; 3], 0.0, u32::MAX);
            let queries = [
                self.query(lanes, first),
                second.map_or(
                    nowhere,
                    #[inline(always)]
                    |slot| self.query(lanes, slot),
                ),
            ];
            let streams = if *n_rows % 2 == 0 { [&mut *even, &mut *odd] } else { [&mut *odd, &mut *even] };
            let lens = self.scan_together::<L, K>(lanes, queries, streams);
            for (slot, len) in [Some(first), second].into_iter().flatten().zip(lens) {
                (particles[*n_rows], ends[*n_rows]) = (slots.particle[slot], len);
                *n_rows += 1;
            }
        }
    }

    #[inline(always)]
    fn query<L: Lanes>(&self, lanes: L, slot: usize) -> Query<L> {
        let slots = self.queries.slots;
        let radius = slots.radius.get(slot).copied().unwrap_or(self.queries.uniform);
        Query::new(lanes, slots.at(slot), radius, slots.particle[slot])
    }

    /// Appends the rows of two queries to a stream each, and gives the lengths of these then.
    #[inline(always)]
    fn scan_together<L: Lanes, K: Keep>(
        &self,
        lanes: L,
        queries: [Query<L>; TOGETHER],
        [first, second]: [&mut Stream; TOGETHER],
    ) -> [usize; TOGETHER] {
        let mut lens = [first.len, second.len];
        let (indices, r2s) =
            ([&mut first.indices[..], &mut second.indices[..]], [&mut first.r2[..], &mut second.r2[..]]);
        for segment in &self.candidates.segments {
            let shift = self.sim_box.shift(segment.image);
            let shift = [lanes.splat(shift[0]), lanes.splat(shift[1]), lanes.splat(shift[2])];
            let shift = (segment.image != [0; 3]).then_some(shift);
            let block = Block { lanes, queries, candidates: self.candidates, segment };
            lens = match (self.contents, shift) {
                (Contents::Count, None) => block.each_chunk::<K>(
                    None,
                    lens,
                    #[inline(always)]
                    |_, _, _, _, _| (),
                ),
                (Contents::Count, shift) => block.each_chunk::<K>(
                    shift,
                    lens,
                    #[inline(always)]
                    |_, _, _, _, _| (),
                ),
                (Contents::Rows { distances: false, .. }, None) => block.each_chunk::<K>(
                    None,
                    lens,
                    #[inline(always)]
                    |query, at, mask, _, particle| {
                        lanes.compress_u(mask, particle, chunk_mut(indices[query], at));
                    },
                ),
                (Contents::Rows { distances, .. }, shift) => block.each_chunk::<K>(
                    shift,
                    lens,
                    #[inline(always)]
                    |query, at, mask, r2, particle| {
                        lanes.compress_u(mask, particle, chunk_mut(indices[query], at));
                        if distances {
                            lanes.compress(mask, r2, chunk_mut(r2s[query], at));
                        }
                    },
                ),
            };
            if let Contents::Rows { images: true, .. } = self.contents {
                first.images.resize(lens[0], segment.image);
                second.images.resize(lens[1], segment.image);
            }
        }
        (first.len, second.len) = (lens[0], lens[1]);
        lens
    }
}

/// The first slot that is no padding.
#[inline(always)]
fn next_particle(slots: &Slots, mut range: Range<usize>) -> Option<usize> {
    range.find(
        #[inline(always)]
        |&slot| slots.particle[slot] != u32::MAX,
    )
}

#[inline(always)]
fn chunk_mut<T>(values: &mut [T], at: usize) -> &mut [T; LANES] {
    values[at..].first_chunk_mut().expect("room was made for whole chunks")
}

/// Two queries and the candidates of one image.
struct Block<'a, L: Lanes> {
    lanes: L,
    queries: [Query<L>; TOGETHER],
    candidates: &'a Candidates,
    segment: &'a Segment,
}

impl<L: Lanes> Block<'_, L> {
    /// Tests whole chunks and hands each to `sink` with the query and the length of its stream so far; gives the lengths
    /// after.
    #[inline(always)]
    fn each_chunk<K: Keep>(
        &self,
        shift: Option<[L::F; 3]>,
        mut lens: [usize; TOGETHER],
        mut sink: impl FnMut(usize, usize, u16, L::F, L::U),
    ) -> [usize; TOGETHER] {
        let Self { lanes, queries, candidates, .. } = self;
        let range = self.segment.start..self.segment.end;
        let x = candidates.x[range.clone()].as_chunks::<LANES>().0;
        let y = candidates.y[range.clone()].as_chunks::<LANES>().0;
        let z = candidates.z[range.clone()].as_chunks::<LANES>().0;
        let radius = candidates.radius[range.clone()].as_chunks::<LANES>().0;
        let particle = candidates.particle[range].as_chunks::<LANES>().0;
        for ((((x, y), z), radius), particle) in x.iter().zip(y).zip(z).zip(radius).zip(particle) {
            let (x, y, z) = (lanes.load(x), lanes.load(y), lanes.load(z));
            let (radius, particle) = (lanes.load(radius), lanes.load_u(particle));
            for (k, query) in queries.iter().enumerate() {
                // The shared predicate (nearfield_core::predicate), operation by operation.
                let mut dx = lanes.sub(x, query.position[0]);
                let mut dy = lanes.sub(y, query.position[1]);
                let mut dz = lanes.sub(z, query.position[2]);
                if let Some(shift) = shift {
                    dx = lanes.add(dx, shift[0]);
                    dy = lanes.add(dy, shift[1]);
                    dz = lanes.add(dz, shift[2]);
                }
                let r2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, lanes.mul(dz, dz)));
                let (radius, range2) = if K::RADII {
                    let range = lanes.max(query.radius, radius);
                    (radius, lanes.mul(range, range))
                } else {
                    (query.radius, query.radius2)
                };
                let mask = lanes.lt(r2, range2) & K::keep(*lanes, query, Lane { radius, particle });
                sink(k, lens[k], mask, r2, particle);
                lens[k] += mask.count_ones() as usize;
            }
        }
        lens
    }
}
