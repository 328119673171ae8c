//! The kernel: candidates tested against each query of a group, those within range appended to its row.

use super::candidates::{Candidates, chunk};
use super::rows::{Contents, Queries, Rows};
use super::rule::{Acting, Bipartite, Full, Half, Keep, Lane, Query, Rule};
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
            candidates.gather(lanes, slots, runs, per_particle);
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
    fn scan<L: Lanes, K: Keep>(self, lanes: L, output: &mut super::rows::Output) {
        let slots = self.queries.structure.slots();
        for slot in self.group {
            let particle = slots.particle[slot];
            if particle == u32::MAX {
                continue;
            }
            let radius = slots.radius.get(slot).copied().unwrap_or(self.queries.uniform);
            let query = Query {
                position: slots.at(slot).map(|x| lanes.splat(x)),
                radius: lanes.splat(radius),
                radius2: lanes.splat(radius * radius),
                particle: lanes.splat_u(particle),
            };
            output.reserve(self.candidates.len());
            let mut len = output.len;
            for segment in &self.candidates.segments {
                let range = segment.start..segment.end;
                let shift =
                    (segment.image != [0; 3]).then(|| self.sim_box.shift(segment.image).map(|s| lanes.splat(s)));
                len = match (self.contents, shift) {
                    (Contents::Count, None) => each_chunk::<L, K>(
                        lanes,
                        &query,
                        self.candidates,
                        range,
                        None,
                        len,
                        #[inline(always)]
                        |_, _, _, _| (),
                    ),
                    (Contents::Count, shift) => each_chunk::<L, K>(
                        lanes,
                        &query,
                        self.candidates,
                        range,
                        shift,
                        len,
                        #[inline(always)]
                        |_, _, _, _| (),
                    ),
                    (Contents::Rows { distances: false, .. }, None) => each_chunk::<L, K>(
                        lanes,
                        &query,
                        self.candidates,
                        range,
                        None,
                        len,
                        #[inline(always)]
                        |at, mask, _, ids| {
                            lanes.compress_u(mask, ids, output.index_chunk(at));
                        },
                    ),
                    (Contents::Rows { distances, .. }, shift) => each_chunk::<L, K>(
                        lanes,
                        &query,
                        self.candidates,
                        range,
                        shift,
                        len,
                        #[inline(always)]
                        |at, mask, r2, ids| {
                            lanes.compress_u(mask, ids, output.index_chunk(at));
                            if distances {
                                lanes.compress(mask, r2, output.r2_chunk(at));
                            }
                        },
                    ),
                };
                if let Contents::Rows { images: true, .. } = self.contents {
                    output.images.resize(len, segment.image);
                }
            }
            output.finish_row(particle, len);
        }
    }
}

/// Tests whole chunks and hands each to `sink` with the length so far; gives the length after.
#[inline(always)]
fn each_chunk<L: Lanes, K: Keep>(
    lanes: L,
    query: &Query<L>,
    candidates: &Candidates,
    range: Range<usize>,
    shift: Option<[L::F; 3]>,
    mut len: usize,
    mut sink: impl FnMut(usize, u16, L::F, L::U),
) -> usize {
    for at in range.step_by(LANES) {
        // The shared predicate (nearfield_core::predicate), operation by operation.
        let mut dx = lanes.sub(lanes.load(chunk(&candidates.x, at)), query.position[0]);
        let mut dy = lanes.sub(lanes.load(chunk(&candidates.y, at)), query.position[1]);
        let mut dz = lanes.sub(lanes.load(chunk(&candidates.z, at)), query.position[2]);
        if let Some(shift) = shift {
            dx = lanes.add(dx, shift[0]);
            dy = lanes.add(dy, shift[1]);
            dz = lanes.add(dz, shift[2]);
        }
        let r2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, lanes.mul(dz, dz)));
        let particle = lanes.load_u(chunk(&candidates.particle, at));
        let (radius, range2) = if K::RADII {
            let radius = lanes.load(chunk(&candidates.radius, at));
            let range = lanes.max(query.radius, radius);
            (radius, lanes.mul(range, range))
        } else {
            (query.radius, query.radius2)
        };
        let mask = lanes.lt(r2, range2) & K::keep(lanes, query, Lane { radius, particle });
        sink(len, mask, r2, particle);
        len += mask.count_ones() as usize;
    }
    len
}
