//! Pencils as wholes: where their particles are, and which others are near.

use super::layout::Layout;
use super::{Grid, largest};
use crate::GroupBox;
use nearfield_core::predicate::conservative_range;
use std::ops::Range;

/// A pencil seen in a periodic image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NearPencil {
    pub pencil: usize,
    pub image: [i8; 3],
}

impl Grid {
    /// Number of pencils.
    pub(crate) fn n_pencils(&self) -> usize {
        self.pencils.len().saturating_sub(1)
    }

    /// The slots of pencil `p`.
    pub(crate) fn pencil_slots(&self, p: usize) -> Range<usize> {
        self.pencils[p].slots as usize..self.pencils[p + 1].slots as usize
    }

    /// The box around the particles of pencil `p`, to be searched by `radius`; `None` where there are none.
    pub(crate) fn pencil_box(&self, p: usize, radius: f32) -> Option<GroupBox> {
        let (slots, pencil) = (self.pencil_slots(p), &self.pencils[p]);
        let last = slots.clone().next_back()?;
        let ([y0, y1], [z0, z1]) = (pencil.y, pencil.z);
        Some(GroupBox { lo: [pencil.x0, y0, z0], hi: [self.slots.x[last], y1, z1], radius })
    }

    /// Appends the pencils that may have particles within the radius of `group`, beginning with pencil `from`, in each
    /// image in which they may.
    pub(crate) fn find_pencils(&self, group: &GroupBox, from: usize, out: &mut Vec<NearPencil>) {
        let reach = conservative_range(group.radius, self.extent_with(group));
        self.for_each_image(group, reach, |image, [lo, hi]| {
            for layout in &self.layouts {
                self.for_each_pencil(layout, [lo, hi], reach, |p| {
                    let along_x = |there: GroupBox| there.lo[0] - hi[0] <= reach && lo[0] - there.hi[0] <= reach;
                    if p >= from && self.pencil_box(p, 0.0).is_some_and(along_x) {
                        out.push(NearPencil { pencil: p, image });
                    }
                });
            }
        });
    }

    /// Calls `with` for each pencil of a class that has particles, and has them within `reach` of a group across x.
    #[inline(always)]
    pub(super) fn for_each_pencil(
        &self,
        layout: &Layout,
        [lo, hi]: [[f32; 3]; 2],
        reach: f32,
        mut with: impl FnMut(usize),
    ) {
        let range =
            |axis: usize| layout.coordinate(axis, lo[axis + 1] - reach)..=layout.coordinate(axis, hi[axis + 1] + reach);
        for z in range(1) {
            for y in range(0) {
                let p = layout.first + z * layout.n[0] + y;
                let (pencil, next) = (&self.pencils[p], &self.pencils[p + 1]);
                if pencil.slots < next.slots && pencil.distance2(lo, hi) <= reach * reach {
                    with(p);
                }
            }
        }
    }

    /// The largest magnitude of a coordinate, those of a group included.
    #[inline(always)]
    pub(super) fn extent_with(&self, group: &GroupBox) -> f32 {
        self.extent.max(largest(group.lo)).max(largest(group.hi))
    }

    /// How far queries of a radius may have neighbours, of any class.
    #[inline(always)]
    pub(super) fn farthest(&self, radius: f32, extent: f32) -> f32 {
        let farthest = self.layouts.iter().fold(radius, |r, layout| r.max(layout.largest));
        conservative_range(farthest, extent)
    }
}
