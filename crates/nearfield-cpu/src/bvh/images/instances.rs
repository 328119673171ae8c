//! Instances: a top level over translated copies of the one tree.
//!
//! Whether a copy is entered is decided by its own box, not by the largest radius, so a large particle in the middle
//! of the box costs nothing at the faces.

use super::{Aabb, Scene};
use crate::{LANES, bvh::node::Node};

/// The top level: the tree's box in each image, sixteen to a node.
#[derive(Clone, Debug)]
pub(in crate::bvh) struct Instances {
    top: Box<[Node; 2]>,
}

impl Default for Instances {
    fn default() -> Self {
        Self { top: Box::new([Node::EMPTY; 2]) }
    }
}

impl Instances {
    pub fn update(&mut self, scene: &Scene) {
        self.top.fill(Node::EMPTY);
        for (bit, image) in scene.sim_box.images().into_iter().enumerate() {
            self.top[bit / LANES].set(bit % LANES, &scene.root.translated(scene.sim_box.shift(image)));
        }
    }

    /// The images whose box any of `rays` overlaps, as bits.
    #[inline(always)]
    pub fn visible<const N: usize>(&self, rays: &[Aabb; N]) -> u32 {
        self.top[0].overlap_any(rays) | self.top[1].overlap_any(rays) << LANES
    }
}
