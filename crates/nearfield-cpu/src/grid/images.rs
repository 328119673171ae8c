//! Periodic images that a group of queries can reach.

use super::Grid;
use crate::GroupBox;

/// Up to three images of one axis.
pub(super) struct Images {
    list: [i8; 3],
    len: usize,
}

impl Images {
    pub fn iter(&self) -> std::slice::Iter<'_, i8> {
        self.list[..self.len].iter()
    }
}

impl Grid {
    /// Calls `with` for each image whose particles may be within `reach` of the group, and the corners of the group as
    /// seen from there. The image 0 comes first.
    #[inline(always)]
    pub(super) fn for_each_image(&self, group: &GroupBox, reach: f32, mut with: impl FnMut([i8; 3], [[f32; 3]; 2])) {
        let [along_x, along_y, along_z] = std::array::from_fn(|axis| self.images_in_reach(axis, group, reach));
        for z in along_z.iter() {
            for y in along_y.iter() {
                for x in along_x.iter() {
                    let image = [*x, *y, *z];
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
    pub(super) fn images_in_reach(&self, axis: usize, group: &GroupBox, reach: f32) -> Images {
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
}
