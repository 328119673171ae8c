//! Rows of neighbours of a range of groups, in the structure's order: the unit of parallel and of batched work.

use super::rule::Rule;
use super::scan::Scan;
use crate::candidates::Candidates;
use crate::lanes::Isa;
use crate::{Input, InputRadii, LANES, Run, Slots, Structure, Vicinity};
use nearfield_core::{ListKind, SimBox};
use std::ops::Range;

/// Where queries come from: a structure, read only for its slots and groups.
#[derive(Clone, Copy)]
pub(crate) struct Queries<'a> {
    pub structure: &'a dyn Structure,
    /// Its slots: to ask for them is a call, which has no place in kernels.
    pub slots: &'a Slots,
    /// The radius, where slots carry none.
    pub uniform: f32,
}

impl<'a> Queries<'a> {
    /// The particles of `input`, in the slots of `structure`.
    pub fn new(structure: &'a dyn Structure, input: &Input) -> Self {
        let uniform = match input.radii {
            InputRadii::Uniform(r) => r,
            InputRadii::PerParticle(_) => 0.0,
        };
        Self { structure, slots: structure.slots(), uniform }
    }
}

/// What is kept of each neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Contents {
    /// Nothing: rows are only counted.
    #[default]
    Count,
    /// Its index, and more where asked for.
    Rows { images: bool, distances: bool },
}

/// Neighbours of the particles of some groups. Buffers are kept for the next range.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    pub(super) vicinity: Vicinity,
    pub(super) runs: Vec<Run>,
    pub(super) candidates: Candidates,
    pub(super) output: Output,
}

/// One row of [`Rows`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<'a> {
    /// The particle, in input order.
    pub particle: u32,
    /// Its neighbours, in input order.
    pub neighbors: &'a [u32],
    /// Their periodic images: `dr = (x_j - x_i) + image * box length`. Empty where not asked for.
    pub images: &'a [[i8; 3]],
    /// Their squared distances. Empty where not asked for.
    pub r2: &'a [f32],
}

/// Rows that are written at a time, each to a stream of its own: candidates are read once for their queries.
pub(super) const TOGETHER: usize = 2;

/// Rows as two streams, even ones in the first and odd ones in the second: two rows are written at a time, the length of
/// neither of which is known before.
#[derive(Clone, Debug, Default)]
pub(super) struct Output {
    n_rows: usize,
    contents: Contents,
    particle: Vec<u32>,
    ends: Vec<usize>,
    streams: [Stream; TOGETHER],
}

/// Rows as one array after the other. Arrays but `images` are longer than what they hold: stores write whole chunks, and
/// what may call for memory has no place in kernels.
#[derive(Clone, Debug, Default)]
pub(super) struct Stream {
    pub len: usize,
    pub indices: Vec<u32>,
    pub r2: Vec<f32>,
    pub images: Vec<[i8; 3]>,
}

/// Where the rows of a group are written: number of rows so far, and arrays with room for more.
pub(super) struct Room<'a> {
    pub n_rows: &'a mut usize,
    pub particle: &'a mut [u32],
    pub ends: &'a mut [usize],
    pub streams: &'a mut [Stream; TOGETHER],
}

impl Output {
    pub fn clear(&mut self, contents: Contents) {
        self.contents = contents;
        self.n_rows = 0;
        for stream in &mut self.streams {
            stream.len = 0;
            stream.images.clear();
        }
    }

    /// Room for `n` rows of `most` neighbours.
    #[inline(always)]
    pub fn room_for(&mut self, n: usize, most: usize) -> Room<'_> {
        let Self { n_rows, particle, ends, streams, contents } = self;
        make_room(particle, *n_rows + n);
        make_room(ends, *n_rows + n);
        if let Contents::Rows { distances, .. } = *contents {
            for stream in &mut *streams {
                let needed = stream.len + n.div_ceil(TOGETHER) * most + LANES;
                make_room(&mut stream.indices, needed);
                if distances {
                    make_room(&mut stream.r2, needed);
                }
            }
        }
        Room { n_rows, particle, ends, streams }
    }
}

fn make_room<T: Copy + Default>(array: &mut Vec<T>, needed: usize) {
    if array.len() < needed {
        array.resize(needed.next_power_of_two(), T::default());
    }
}

impl Rows {
    /// Lists the neighbours of the particles in `groups` of `structure`, which was built from `input`.
    ///
    /// For callers that cannot hold all rows at once. Rows come in the order of slots; a half list keeps j > i.
    /// A structure that is not [`Structure::complete`] gives each pair once, in the row of its smaller radius (of
    /// the smaller index where equal), whatever `kind` is.
    pub fn list(
        &mut self,
        structure: &dyn Structure,
        input: &Input,
        groups: Range<usize>,
        kind: ListKind,
        images: bool,
        distances: bool,
    ) {
        let contents = Contents::Rows { images, distances };
        let rule = Rule::for_list(structure, kind);
        self.collect(structure, input.sim_box, Queries::new(structure, input), groups, rule, contents);
    }

    pub(crate) fn collect(
        &mut self,
        structure: &dyn Structure,
        sim_box: &SimBox,
        queries: Queries,
        groups: Range<usize>,
        rule: Rule,
        contents: Contents,
    ) {
        self.collect_on(Isa::detect(), structure, sim_box, queries, groups, rule, contents);
    }

    #[expect(clippy::too_many_arguments, reason = "the instruction set is chosen by tests only")]
    pub(super) fn collect_on(
        &mut self,
        isa: Isa,
        structure: &dyn Structure,
        sim_box: &SimBox,
        queries: Queries,
        groups: Range<usize>,
        rule: Rule,
        contents: Contents,
    ) {
        isa.run(Scan { structure, sim_box, queries, groups, rule, contents, rows: self });
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.output.n_rows
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of neighbours in all rows.
    pub fn n_entries(&self) -> usize {
        self.output.streams.iter().map(|stream| stream.len).sum()
    }

    /// Particle and extent of row `k`, in stream `k % TOGETHER`.
    #[inline(always)]
    pub(super) fn extent(&self, k: usize) -> (u32, Range<usize>) {
        let start = if k < TOGETHER { 0 } else { self.output.ends[k - TOGETHER] };
        (self.output.particle[k], start..self.output.ends[k])
    }

    /// The rows in order. Counted rows have no contents.
    pub fn iter(&self) -> impl Iterator<Item = Row<'_>> {
        (0..self.len()).map(|k| self.at(k))
    }

    /// Row `k`.
    #[inline(always)]
    pub(crate) fn at(&self, k: usize) -> Row<'_> {
        let (particle, extent) = self.extent(k);
        self.row(particle, k % TOGETHER, extent)
    }

    #[inline(always)]
    pub(super) fn row(&self, particle: u32, stream: usize, extent: Range<usize>) -> Row<'_> {
        let Stream { indices, images, r2, .. } = &self.output.streams[stream];
        let (rows, with_images, with_distances) = match self.output.contents {
            Contents::Count => (false, false, false),
            Contents::Rows { images, distances } => (true, images, distances),
        };
        let kept = |is_kept: bool| if is_kept { extent.clone() } else { 0..0 };
        Row {
            particle,
            neighbors: &indices[kept(rows)],
            images: &images[kept(with_images)],
            r2: &r2[kept(with_distances)],
        }
    }

    /// Indices of neighbours, of all rows of a stream.
    #[inline(always)]
    pub(super) fn indices(&self, stream: usize) -> &[u32] {
        &self.output.streams[stream].indices
    }
}

impl Rule {
    /// The rule that lists by `kind`, or finds each pair once where the structure is not complete.
    pub(crate) fn for_list(structure: &dyn Structure, kind: ListKind) -> Self {
        match kind {
            _ if !structure.complete() => Self::Acting,
            ListKind::Full => Self::Full,
            ListKind::Half => Self::Half,
        }
    }
}
