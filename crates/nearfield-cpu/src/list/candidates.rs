//! The candidates of one group, gathered from its runs into contiguous arrays that stay in the first-level cache.

use crate::lanes::Lanes;
use crate::{LANES, Run, Slots};

/// Candidates seen in one periodic image: whole chunks of lanes, padded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub start: usize,
    pub end: usize,
    pub image: [i8; 3],
}

/// Candidates of a group.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
    pub radius: Vec<f32>,
    pub particle: Vec<u32>,
    pub segments: Vec<Segment>,
}

/// The sixteen values from `at`.
#[inline(always)]
pub(super) fn chunk<T>(values: &[T], at: usize) -> &[T; LANES] {
    values[at..].first_chunk().expect("arrays are padded to whole chunks")
}

#[inline(always)]
fn chunk_mut<T>(values: &mut [T], at: usize) -> &mut [T; LANES] {
    values[at..].first_chunk_mut().expect("arrays are padded to whole chunks")
}

impl Candidates {
    /// Number of candidates with padding.
    pub fn len(&self) -> usize {
        self.segments.last().map_or(0, |segment| segment.end)
    }

    /// Replaces the candidates by those of `runs`, one segment for each stretch of runs of the same image.
    #[inline(always)]
    pub fn gather<L: Lanes>(&mut self, lanes: L, slots: &Slots, runs: &[Run], with_radii: bool) {
        let most = runs.iter().map(|run| (run.end - run.start) as usize + LANES).sum::<usize>() + LANES;
        if self.x.len() < most {
            let len = most.next_power_of_two();
            for array in [&mut self.x, &mut self.y, &mut self.z, &mut self.radius] {
                array.resize(len, 0.0);
            }
            self.particle.resize(len, 0);
        }
        self.segments.clear();
        let (mut at, mut start) = (0, 0);
        for (k, run) in runs.iter().enumerate() {
            let n = (run.end - run.start) as usize;
            // Whole chunks are copied: what is too much is overwritten by the next run or the padding.
            for offset in (0..n).step_by(LANES) {
                let (from, to) = (run.start as usize + offset, at + offset);
                lanes.store(lanes.load(chunk(&slots.x, from)), chunk_mut(&mut self.x, to));
                lanes.store(lanes.load(chunk(&slots.y, from)), chunk_mut(&mut self.y, to));
                lanes.store(lanes.load(chunk(&slots.z, from)), chunk_mut(&mut self.z, to));
                if with_radii {
                    lanes.store(lanes.load(chunk(&slots.radius, from)), chunk_mut(&mut self.radius, to));
                }
                lanes.store_u(lanes.load_u(chunk(&slots.particle, from)), chunk_mut(&mut self.particle, to));
            }
            at += n;
            if runs.get(k + 1).is_none_or(|next| next.image != run.image) {
                lanes.store(lanes.splat(f32::NAN), chunk_mut(&mut self.x, at));
                at = at.next_multiple_of(LANES);
                self.segments.push(Segment { start, end: at, image: run.image });
                start = at;
            }
        }
    }
}
