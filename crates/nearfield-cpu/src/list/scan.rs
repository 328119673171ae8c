//! The kernel: candidates tested against each query of a group, those within range appended to its row.

use super::rows::{Contents, Output, Queries, Room, Rows};
use super::rule::{Acting, Bipartite, Full, Half, Keep, Lane, Query, Rule};
use crate::candidates::{Candidates, Segment};
use crate::lanes::{Kernel, Lanes};
use crate::{GroupBox, LANES, Structure};
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
        let Rows { runs, candidates, output } = self.rows;
        output.clear(self.contents);
        for g in self.groups {
            let group = self.queries.structure.group(g);
            let Some(bounds) = GroupBox::around(self.queries.structure.slots(), group.clone(), self.queries.uniform)
            else {
                continue;
            };
            runs.clear();
            self.structure.runs(&bounds, runs);
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
        let slots = self.queries.structure.slots();
        let Room { n_rows, len: end, particle: particles, ends, indices, r2: r2s, images } =
            output.room_for(self.group.len(), self.candidates.len());
        let (mut row, mut len) = (*n_rows, *end);
        for slot in self.group {
            let particle = slots.particle[slot];
            if particle == u32::MAX {
                continue;
            }
            let radius = slots.radius.get(slot).copied().unwrap_or(self.queries.uniform);
            let [x, y, z] = slots.at(slot);
            let query = Query {
                position: [lanes.splat(x), lanes.splat(y), lanes.splat(z)],
                radius: lanes.splat(radius),
                radius2: lanes.splat(radius * radius),
                particle: lanes.splat_u(particle),
            };
            for segment in &self.candidates.segments {
                let shift = self.sim_box.shift(segment.image);
                let shift = [lanes.splat(shift[0]), lanes.splat(shift[1]), lanes.splat(shift[2])];
                let shift = (segment.image != [0; 3]).then_some(shift);
                let block = Block { lanes, query, candidates: self.candidates, segment };
                len = match (self.contents, shift) {
                    (Contents::Count, None) => block.each_chunk::<K>(
                        None,
                        len,
                        #[inline(always)]
                        |_, _, _, _| (),
                    ),
                    (Contents::Count, shift) => block.each_chunk::<K>(
                        shift,
                        len,
                        #[inline(always)]
                        |_, _, _, _| (),
                    ),
                    (Contents::Rows { distances: false, .. }, None) => block.each_chunk::<K>(
                        None,
                        len,
                        #[inline(always)]
                        |at, mask, _, particle| {
                            lanes.compress_u(mask, particle, chunk_mut(indices, at));
                        },
                    ),
                    (Contents::Rows { distances, .. }, shift) => block.each_chunk::<K>(
                        shift,
                        len,
                        #[inline(always)]
                        |at, mask, r2, particle| {
                            lanes.compress_u(mask, particle, chunk_mut(indices, at));
                            if distances {
                                lanes.compress(mask, r2, chunk_mut(r2s, at));
                            }
                        },
                    ),
                };
                if let Contents::Rows { images: true, .. } = self.contents {
                    images.resize(len, segment.image);
                }
            }
            (particles[row], ends[row]) = (particle, len);
            row += 1;
        }
        (*n_rows, *end) = (row, len);
    }
}

#[inline(always)]
fn chunk_mut<T>(values: &mut [T], at: usize) -> &mut [T; LANES] {
    values[at..].first_chunk_mut().expect("room was made for whole chunks")
}

/// One query and the candidates of one image.
struct Block<'a, L: Lanes> {
    lanes: L,
    query: Query<L>,
    candidates: &'a Candidates,
    segment: &'a Segment,
}

impl<L: Lanes> Block<'_, L> {
    /// Tests whole chunks and hands each to `sink` with the length so far; gives the length after.
    #[inline(always)]
    fn each_chunk<K: Keep>(
        &self,
        shift: Option<[L::F; 3]>,
        mut len: usize,
        mut sink: impl FnMut(usize, u16, L::F, L::U),
    ) -> usize {
        let Self { lanes, query, candidates, .. } = self;
        let range = self.segment.start..self.segment.end;
        let x = candidates.x[range.clone()].as_chunks::<LANES>().0;
        let y = candidates.y[range.clone()].as_chunks::<LANES>().0;
        let z = candidates.z[range.clone()].as_chunks::<LANES>().0;
        let radius = candidates.radius[range.clone()].as_chunks::<LANES>().0;
        let particle = candidates.particle[range].as_chunks::<LANES>().0;
        for ((((x, y), z), radius), particle) in x.iter().zip(y).zip(z).zip(radius).zip(particle) {
            // The shared predicate (nearfield_core::predicate), operation by operation.
            let mut dx = lanes.sub(lanes.load(x), query.position[0]);
            let mut dy = lanes.sub(lanes.load(y), query.position[1]);
            let mut dz = lanes.sub(lanes.load(z), query.position[2]);
            if let Some(shift) = shift {
                dx = lanes.add(dx, shift[0]);
                dy = lanes.add(dy, shift[1]);
                dz = lanes.add(dz, shift[2]);
            }
            let r2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, lanes.mul(dz, dz)));
            let particle = lanes.load_u(particle);
            let (radius, range2) = if K::RADII {
                let radius = lanes.load(radius);
                let range = lanes.max(query.radius, radius);
                (radius, lanes.mul(range, range))
            } else {
                (query.radius, query.radius2)
            };
            let mask = lanes.lt(r2, range2) & K::keep(*lanes, query, Lane { radius, particle });
            sink(len, mask, r2, particle);
            len += mask.count_ones() as usize;
        }
        len
    }
}
