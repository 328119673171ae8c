//! Gamma rays (paper A, section 3.3): queries near a face are traced once more, from an origin on the other side.
//!
//! A ray is needed for each face, edge and corner within the trigger distance, which is the largest radius in the
//! system: a large particle across the face may hold a query whose own radius does not reach it.

use super::{Aabb, Scene};

/// When to send gamma rays.
#[derive(Clone, Debug, Default)]
pub(in crate::bvh) struct Gamma {
    images: Vec<[i8; 3]>,
    /// Queries above this reach an upper face, where image +1 begins.
    upper: [f32; 3],
    /// Queries below this reach a lower face.
    lower: [f32; 3],
}

impl Gamma {
    pub fn update(&mut self, scene: &Scene) {
        let Scene { sim_box, largest, .. } = *scene;
        self.images = sim_box.images();
        self.upper = sim_box.hi().map(|face| face - largest);
        self.lower = sim_box.lo().map(|face| face + largest);
    }

    /// The images to which `query` sends rays, as bits.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "kernels index, see node.rs")]
    pub fn visible(&self, query: &Aabb) -> u32 {
        // For each axis, whether the query is near the lower face, anywhere, near the upper face.
        let mut near = [[false, true, false]; 3];
        for axis in 0..3 {
            near[axis][0] = query.lo[axis] <= self.lower[axis];
            near[axis][2] = query.hi[axis] >= self.upper[axis];
        }
        let mut visible = 0;
        for (bit, image) in self.images.iter().enumerate() {
            let mut triggered = true;
            for axis in 0..3 {
                triggered &= near[axis][(image[axis] + 1) as usize];
            }
            visible |= u32::from(triggered) << bit;
        }
        visible
    }
}
