//! Gamma rays (paper A, section 3.3): queries near a face are traced once more, from an origin on the other side.
//!
//! A ray is needed for each face, edge and corner within the trigger distance, which is the largest radius in the
//! system: a large particle across the face may hold a query whose own radius does not reach it.

use super::{Aabb, Scene};

/// When to send gamma rays.
#[derive(Clone, Debug, Default)]
pub(in crate::bvh) struct Gamma {
    rays: Vec<Ray>,
    /// Queries above this reach an upper face, where image +1 begins.
    upper: [f32; 3],
    /// Queries below this reach a lower face.
    lower: [f32; 3],
}

#[derive(Clone, Copy, Debug)]
struct Ray {
    image: [i8; 3],
    shift: [f32; 3],
}

impl Gamma {
    pub fn update(&mut self, scene: &Scene) {
        let Scene { sim_box, largest, .. } = *scene;
        self.rays.clear();
        self.rays.extend(sim_box.images().into_iter().map(|image| Ray { image, shift: sim_box.shift(image) }));
        self.upper = sim_box.hi().map(|face| face - largest);
        self.lower = sim_box.lo().map(|face| face + largest);
    }

    #[inline(always)]
    pub fn for_each(&self, query: &Aabb, mut visit: impl FnMut([i8; 3], [f32; 3])) {
        for ray in &self.rays {
            let triggered = (0..3).all(|axis| match ray.image[axis] {
                0 => true,
                1.. => query.hi[axis] >= self.upper[axis],
                _ => query.lo[axis] <= self.lower[axis],
            });
            if triggered {
                visit(ray.image, ray.shift);
            }
        }
    }
}
