//! What every search structure does: turn a group of queries into runs of candidates.

use crate::Slots;
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
    /// `out` is cleared by the caller.
    fn runs(&self, group: &GroupBox, out: &mut Vec<Run>);
}
