//! Periodic images: one file for each way that a BVH sees particles across a face.

mod gamma;
mod ghosts;
mod instances;

pub(super) use gamma::Gamma;
pub(super) use ghosts::Ghosts;
pub(super) use instances::Instances;

use super::node::Aabb;
use nearfield_core::{Images, SimBox};

/// What all ways need to know of the system.
pub(super) struct Scene<'a> {
    pub sim_box: &'a SimBox,
    /// The box of the whole tree.
    pub root: Aabb,
    /// How far the largest particle is seen on each axis.
    pub largest: f32,
}

/// The periodic images of a tree.
#[derive(Clone, Debug)]
pub(super) enum Views {
    Gamma(Gamma),
    Instances(Instances),
    Ghosts(Ghosts),
}

impl Views {
    pub fn new(images: Images) -> Self {
        match images {
            Images::Gamma => Self::Gamma(Gamma::default()),
            Images::Instances => Self::Instances(Instances::default()),
            Images::Ghosts => Self::Ghosts(Ghosts::default()),
        }
    }

    /// Follows a tree that was built or refitted.
    pub fn update(&mut self, scene: &Scene) {
        match self {
            Self::Gamma(gamma) => gamma.update(scene),
            Self::Instances(instances) => instances.update(scene),
            Self::Ghosts(_) => {}
        }
    }

    /// The images in which the tree is to be traced for the points in `query`, which send `rays`: bit `b` is entry `b`
    /// of [`SimBox::images`].
    #[inline(always)]
    pub fn visible<const N: usize>(&self, query: &Aabb, rays: &[Aabb; N]) -> u32 {
        match self {
            Self::Gamma(gamma) => gamma.visible(query),
            Self::Instances(instances) => instances.visible(rays),
            Self::Ghosts(_) => 1,
        }
    }

    /// The mirror particles, where there are any.
    #[inline(always)]
    pub fn ghosts(&self) -> Option<&Ghosts> {
        match self {
            Self::Ghosts(ghosts) => Some(ghosts),
            _ => None,
        }
    }

    pub fn ghosts_mut(&mut self) -> Option<&mut Ghosts> {
        match self {
            Self::Ghosts(ghosts) => Some(ghosts),
            _ => None,
        }
    }
}
