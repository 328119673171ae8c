//! The candidates of one group: what its runs hold near its box, in contiguous arrays that stay in the cache.
//!
//! One test against the box saves a test against each query of the group for about half of what runs propose.

use crate::lanes::Lanes;
use crate::{GroupBox, LANES, Run, Slots};
use nearfield_core::SimBox;
use nearfield_core::predicate::conservative_range;

/// Candidates seen in one periodic image: whole chunks of lanes, padded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub start: usize,
    pub end: usize,
    pub image: [i8; 3],
}

/// Candidates of a group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
    pub radius: Vec<f32>,
    pub kind: Vec<u32>,
    pub particle: Vec<u32>,
    pub segments: Vec<Segment>,
}

/// What candidates must be near to: a group of queries, conservatively.
#[derive(Clone, Copy)]
struct Reach<L: Lanes> {
    lo: [L::F; 3],
    hi: [L::F; 3],
    radius: L::F,
    /// Allowance for rounding: a factor and a length.
    slack: [L::F; 2],
}

impl<L: Lanes> Reach<L> {
    #[inline(always)]
    fn new(lanes: L, group: &GroupBox, shift: [f32; 3], slack: [f32; 2]) -> Self {
        let [x, y, z] = shift;
        let (lo, hi) = (group.lo, group.hi);
        Self {
            lo: [lanes.splat(lo[0] - x), lanes.splat(lo[1] - y), lanes.splat(lo[2] - z)],
            hi: [lanes.splat(hi[0] - x), lanes.splat(hi[1] - y), lanes.splat(hi[2] - z)],
            radius: lanes.splat(group.radius),
            slack: [lanes.splat(slack[0]), lanes.splat(slack[1])],
        }
    }

    /// Distance from the box along one axis.
    #[inline(always)]
    fn distance(&self, lanes: L, axis: usize, x: L::F) -> L::F {
        let outside = lanes.max(lanes.sub(self.lo[axis], x), lanes.sub(x, self.hi[axis]));
        lanes.max(outside, lanes.splat(0.0))
    }

    /// The lanes within range of the group's box.
    #[inline(always)]
    fn holds(&self, lanes: L, position: [L::F; 3], radius: Option<L::F>) -> u16 {
        let x = self.distance(lanes, 0, position[0]);
        let y = self.distance(lanes, 1, position[1]);
        let z = self.distance(lanes, 2, position[2]);
        let d2 = lanes.mul_add(x, x, lanes.mul_add(y, y, lanes.mul(z, z)));
        let range = match radius {
            Some(radius) => lanes.max(self.radius, radius),
            None => self.radius,
        };
        let range = lanes.mul_add(range, self.slack[0], self.slack[1]);
        lanes.lt(d2, lanes.mul(range, range))
    }
}

#[inline(always)]
fn chunk_mut<T>(values: &mut [T], at: usize) -> &mut [T; LANES] {
    values[at..].first_chunk_mut().expect("room was made for whole chunks")
}

impl Candidates {
    /// Number of candidates with padding.
    pub fn len(&self) -> usize {
        self.segments.last().map_or(0, |segment| segment.end)
    }

    /// Replaces the candidates by those slots of `runs` that are near the box of `group`, one segment for each
    /// stretch of runs of the same image. Radii are those of the slots, where they have any and `with_radii`; types
    /// likewise.
    #[inline(always)]
    pub fn gather<L: Lanes>(
        &mut self,
        lanes: L,
        structure: (&Slots, &SimBox),
        group: &GroupBox,
        runs: &[Run],
        with_radii: bool,
        with_kinds: bool,
    ) {
        match (with_radii, with_kinds) {
            (false, false) => self.gather_as::<L, false, false>(lanes, structure, group, runs),
            (false, true) => self.gather_as::<L, false, true>(lanes, structure, group, runs),
            (true, false) => self.gather_as::<L, true, false>(lanes, structure, group, runs),
            (true, true) => self.gather_as::<L, true, true>(lanes, structure, group, runs),
        }
    }

    #[inline(always)]
    fn gather_as<L: Lanes, const RADII: bool, const KINDS: bool>(
        &mut self,
        lanes: L,
        (slots, sim_box): (&Slots, &SimBox),
        group: &GroupBox,
        runs: &[Run],
    ) {
        self.make_room(runs.iter().map(|run| (run.end - run.start) as usize + LANES).sum::<usize>() + LANES);
        let slack = slack(sim_box, group);
        self.segments.clear();
        // Slices of their own, so that a store to one does not make the others be looked up again, and of one length, so
        // that one test of a place does for all.
        let room = self.x.len();
        let (to_x, to_y, to_z) = (&mut self.x[..room], &mut self.y[..room], &mut self.z[..room]);
        let (to_particle, to_radius) = (&mut self.particle[..room], &mut self.radius[..room]);
        let to_kind = &mut self.kind[..room];
        let (mut at, mut start) = (0, 0);
        let mut reach = Reach::new(lanes, group, [0.0; 3], slack);
        for (k, run) in runs.iter().enumerate() {
            if at == start {
                reach = Reach::new(lanes, group, sim_box.shift(run.image), slack);
            }
            let n = (run.end - run.start) as usize;
            let slice = run.start as usize..run.start as usize + n.next_multiple_of(LANES);
            let x = slots.x[slice.clone()].as_chunks::<LANES>().0;
            let y = slots.y[slice.clone()].as_chunks::<LANES>().0;
            let z = slots.z[slice.clone()].as_chunks::<LANES>().0;
            let particle = slots.particle[slice.clone()].as_chunks::<LANES>().0;
            let radii = if RADII { slots.radius[slice.clone()].as_chunks::<LANES>().0 } else { &[] };
            let kinds = if KINDS { slots.kind[slice].as_chunks::<LANES>().0 } else { &[] };
            let mut left = n;
            for (c, (((x, y), z), particle)) in x.iter().zip(y).zip(z).zip(particle).enumerate() {
                let in_run = if left < LANES { (1u16 << left) - 1 } else { u16::MAX };
                left = left.saturating_sub(LANES);
                let (x, y, z) = (lanes.load(x), lanes.load(y), lanes.load(z));
                let radius = if RADII { Some(lanes.load(&radii[c])) } else { None };
                let mask = reach.holds(lanes, [x, y, z], radius) & in_run;
                lanes.compress(mask, x, chunk_mut(to_x, at));
                lanes.compress(mask, y, chunk_mut(to_y, at));
                lanes.compress(mask, z, chunk_mut(to_z, at));
                lanes.compress_u(mask, lanes.load_u(particle), chunk_mut(to_particle, at));
                if let Some(radius) = radius {
                    lanes.compress(mask, radius, chunk_mut(to_radius, at));
                }
                if KINDS {
                    lanes.compress_u(mask, lanes.load_u(&kinds[c]), chunk_mut(to_kind, at));
                }
                at += mask.count_ones() as usize;
            }
            if runs.get(k + 1).is_none_or(|next| next.image != run.image) && at > start {
                to_x[at..at + LANES].fill(Slots::FAR);
                at = at.next_multiple_of(LANES);
                self.segments.push(Segment { start, end: at, image: run.image });
                start = at;
            }
        }
    }

    fn make_room(&mut self, most: usize) {
        if self.x.len() < most {
            let len = most.next_power_of_two();
            for array in [&mut self.x, &mut self.y, &mut self.z, &mut self.radius] {
                array.resize(len, 0.0);
            }
            self.particle.resize(len, 0);
            self.kind.resize(len, 0);
        }
    }
}

/// Factor and length by which a range grows so that rounding loses no pair.
fn slack(sim_box: &SimBox, group: &GroupBox) -> [f32; 2] {
    let largest = |values: [f32; 3]| values.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    // Whatever is in range has coordinates no larger than this.
    let extent = largest(group.lo).max(largest(group.hi)) + largest(sim_box.lengths()) + group.radius;
    let offset = conservative_range(0.0, extent);
    [conservative_range(1.0, 0.0), offset]
}
