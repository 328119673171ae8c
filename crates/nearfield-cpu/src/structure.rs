//! What every search structure does: turn a group of queries into runs of candidates.

use crate::{Slots, Vicinity};
use std::ops::Range;

/// Consecutive slots that may hold neighbours, seen in a periodic image:
/// `dr = (x_j - x_i) + image * box length`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Run {
    /// First slot.
    pub start: u32,
    /// One past the last slot.
    pub end: u32,
    /// The periodic image.
    pub image: [i8; 3],
}

/// The bounds of a group of query points and the largest search radius among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupBox {
    /// Lower corner of the points.
    pub lo: [f32; 3],
    /// Upper corner of the points.
    pub hi: [f32; 3],
    /// Largest radius of the queries.
    pub radius: f32,
}

impl GroupBox {
    /// The box around the particles in `group`, padding left out; `None` when it holds nothing else. `uniform` is the
    /// radius where slots carry none.
    #[inline]
    pub fn around(slots: &Slots, group: Range<usize>, uniform: f32) -> Option<Self> {
        let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let [x, y, z] = [&slots.x, &slots.y, &slots.z].map(|axis| &axis[group.clone()]);
        let particles = &slots.particle[group.clone()];
        for (((x, y), z), &particle) in x.iter().zip(y).zip(z).zip(particles) {
            // Padding is far away: with it, the last group would be proposed everything.
            if particle == u32::MAX {
                continue;
            }
            for (axis, x) in [*x, *y, *z].into_iter().enumerate() {
                // Not `min` and `max`, whose treatment of NaN takes twice as long.
                lo[axis] = if x < lo[axis] { x } else { lo[axis] };
                hi[axis] = if x > hi[axis] { x } else { hi[axis] };
            }
        }
        let radius = match slots.radius.get(group) {
            Some(radii) => radii.iter().zip(particles).fold(0.0f32, |largest, (&radius, &particle)| {
                if particle == u32::MAX { largest } else { largest.max(radius) }
            }),
            None => uniform,
        };
        (lo[0] <= hi[0]).then_some(Self { lo, hi, radius })
    }
}

/// A search structure over slots.
///
/// Work is done by groups of nearby queries: the runs of a group are found once, then each of its queries is tested
/// against them. The calls are coarse, so the trait is object-safe and kernels need not be compiled for each structure.
pub trait Structure: Sync {
    /// The slots that runs refer to.
    fn slots(&self) -> &Slots;

    /// Number of groups the particles themselves are queried in.
    fn n_groups(&self) -> usize;

    /// The slots of group `g`: each particle is in exactly one group, a group may also hold padding (to be skipped).
    fn group(&self, g: usize) -> Range<usize>;

    /// Appends runs that together hold, for every query point in `group`, every slot within range of it, in the image
    /// it is within range at. A slot-image pair appears in at most one run; candidates out of range are allowed.
    /// `out` is cleared by the caller, who hands the same `vicinity` in for one group after the other.
    fn runs(&self, group: &GroupBox, vicinity: &mut Vicinity, out: &mut Vec<Run>);

    /// Whether runs hold every j with distance < max(r_i, r_j). Otherwise they hold only those with distance < r_j:
    /// every pair is proposed to its particle of smaller radius, but not always to both.
    fn complete(&self) -> bool {
        true
    }
}
