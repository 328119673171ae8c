//! Instances: a top level over translated copies of the one tree.
//!
//! Whether a copy is entered is decided by its own box, not by the largest radius, so a large particle in the middle
//! of the box costs nothing at the faces.

use super::{Aabb, Scene};
use crate::{LANES, bvh::node::Node};

/// The top level: the tree's box in each image, sixteen to a node.
#[derive(Clone, Debug, Default)]
pub(in crate::bvh) struct Instances {
    top: Vec<Node>,
    instances: Vec<([i8; 3], [f32; 3])>,
}

impl Instances {
    pub fn update(&mut self, scene: &Scene) {
        self.instances.clear();
        self.instances.extend(scene.sim_box.images().into_iter().map(|image| (image, scene.sim_box.shift(image))));
        self.top.clear();
        for instances in self.instances.chunks(LANES) {
            let mut node = Node::EMPTY;
            for (lane, (_, shift)) in instances.iter().enumerate() {
                node.set(lane, &scene.root.translated(*shift));
            }
            self.top.push(node);
        }
    }

    #[inline(always)]
    pub fn for_each(&self, query: &Aabb, mut visit: impl FnMut([i8; 3], [f32; 3])) {
        for (node, instances) in self.top.iter().zip(self.instances.chunks(LANES)) {
            let mut hits = node.overlap(query);
            while hits != 0 {
                let (image, shift) = instances[hits.trailing_zeros() as usize];
                visit(image, shift);
                hits &= hits - 1;
            }
        }
    }
}
