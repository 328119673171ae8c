//! The search: which part of each pencil a group of queries can reach.

use super::layout::{Layout, Pencil};
use super::{Grid, largest};
use crate::{GroupBox, Run};
use nearfield_core::predicate::conservative_range;

impl Pencil {
    /// Cell number of `x`; it never decreases with `x`, and values beyond the last cell give larger numbers.
    #[inline(always)]
    pub(super) fn cell_of(&self, x: f32) -> usize {
        (((x - self.x0) * self.cells_per_length) as i32).max(0) as usize
    }

    /// Squared distance from a group to the particles' bounds across x.
    #[inline(always)]
    pub(super) fn distance2(&self, lo: [f32; 3], hi: [f32; 3]) -> f32 {
        let dy = (self.y[0] - hi[1]).max(lo[1] - self.y[1]).max(0.0);
        let dz = (self.z[0] - hi[2]).max(lo[2] - self.z[1]).max(0.0);
        dy * dy + dz * dz
    }
}

/// Up to three images of one axis.
struct Images {
    list: [i8; 3],
    len: usize,
}

impl Images {
    fn iter(&self) -> impl Iterator<Item = i8> + '_ {
        self.list[..self.len].iter().copied()
    }
}

impl Grid {
    /// Appends the runs of `group`, without pencils that end before slot `from`: see [`crate::Structure::runs`].
    pub(crate) fn find_rows(&self, group: &GroupBox, from: u32, out: &mut Vec<Run>) {
        let extent = self.extent.max(largest(group.lo)).max(largest(group.hi));
        let farthest = self.layouts.iter().fold(group.radius, |r, layout| r.max(layout.largest));
        let farthest = conservative_range(farthest, extent);
        self.for_each_image(group, farthest, |image, bounds| {
            for layout in &self.layouts {
                let reach = conservative_range(group.radius.max(layout.largest), extent);
                self.find_rows_of_class(layout, bounds, reach, image, from, out);
            }
        });
    }

    /// Calls `with` for each image whose particles may be within `reach` of the group, and the corners of the group as
    /// seen from there. The image 0 comes first.
    #[inline(always)]
    pub(super) fn for_each_image(&self, group: &GroupBox, reach: f32, mut with: impl FnMut([i8; 3], [[f32; 3]; 2])) {
        let [along_x, along_y, along_z] = std::array::from_fn(|axis| self.images_in_reach(axis, group, reach));
        for z in along_z.iter() {
            for y in along_y.iter() {
                for x in along_x.iter() {
                    let image = [x, y, z];
                    // The image of the particles is searched by moving the group the other way.
                    let shift: [f32; 3] = std::array::from_fn(|a| f32::from(image[a]) * self.period[a]);
                    let lo = std::array::from_fn(|axis| group.lo[axis] - shift[axis]);
                    let hi = std::array::from_fn(|axis| group.hi[axis] - shift[axis]);
                    with(image, [lo, hi]);
                }
            }
        }
    }

    /// Images whose particles may be within reach; 0 comes first.
    fn images_in_reach(&self, axis: usize, group: &GroupBox, reach: f32) -> Images {
        let mut images = Images { list: [0; 3], len: 1 };
        let period = self.period[axis];
        if period > 0.0 {
            for image in [-1i8, 1] {
                let shift = f32::from(image) * period;
                if group.lo[axis] - shift - reach <= self.bounds.hi[axis]
                    && group.hi[axis] - shift + reach >= self.bounds.lo[axis]
                {
                    images.list[images.len] = image;
                    images.len += 1;
                }
            }
        }
        images
    }

    #[inline]
    fn find_rows_of_class(
        &self,
        layout: &Layout,
        [lo, hi]: [[f32; 3]; 2],
        reach: f32,
        image: [i8; 3],
        from: u32,
        out: &mut Vec<Run>,
    ) {
        let range =
            |axis: usize| layout.coordinate(axis, lo[axis + 1] - reach)..=layout.coordinate(axis, hi[axis + 1] + reach);
        let along_y = range(0);
        let reach2 = reach * reach;
        for z in range(1) {
            let first = layout.first + z * layout.n[0] + along_y.start();
            let pencils = &self.pencils[first..first + along_y.clone().count() + 1];
            if pencils[pencils.len() - 1].slots <= from {
                continue;
            }
            for pair in pencils.windows(2) {
                let (pencil, next) = (&pair[0], &pair[1]);
                let distance2 = pencil.distance2(lo, hi);
                if pencil.slots == next.slots || next.slots <= from || distance2 > reach2 {
                    continue;
                }
                let half_length = (reach2 - distance2).sqrt();
                let (least, to) = (lo[0] - half_length, hi[0] + half_length);
                let n_cells = (next.cells - pencil.cells) as usize;
                let begin = pencil.cell_of(least);
                if to < pencil.x0 || begin > n_cells {
                    continue;
                }
                let begin = begin.min(n_cells - 1);
                let end = pencil.cell_of(to).min(n_cells - 1) + 1;
                let start = self.cells[pencil.cells as usize + begin];
                let end = self.cells[pencil.cells as usize + end];
                if start == end {
                    continue;
                }
                match out.last_mut() {
                    Some(last) if last.end == start && last.image == image => last.end = end,
                    _ => out.push(Run { start, end, image }),
                }
            }
        }
    }
}
