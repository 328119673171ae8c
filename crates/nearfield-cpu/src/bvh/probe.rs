//! Bodies and rays: what stands for a particle in the tree, and what is traced from a particle to find it.
//!
//! Beside the boxes and points of paper A there are the spheres and squares of paper B (sections 4.2 and 4.3). With r
//! the one radius and `dr` the displacement from the ray's particle to the body's, |dr| < r:
//!
//! - *Axes.* Let a be the axis on which |dr| is largest, x = |dr_a|. The ray along it, of half length r/√3, comes
//!   within √(2/3) r of the body's centre: if x <= r/√3, at distance √(|dr|² - x²) <= √2 x; else at its end, at
//!   distance² (x - r/√3)² + |dr|² - x² < 4/3 r² - 2 x r/√3 <= 2/3 r².
//! - *Edges.* The edge of the ray's cube of width r that lies towards the body along y and z meets the body's cube,
//!   because cubes of width r around points less than r apart on each axis overlap.
//!
//! Bodies are solid here, since boxes around them are what a tree holds. The rays of a particle are traced together
//! and the predicate decides, so that it does not matter how many of them meet a body. On a GPU bodies are shells of
//! built-in primitives, which takes more care: see docs/rays.md.

use super::node::Aabb;

/// Half lengths of axis rays, in radii: 1/√3, rounded up.
const AXIS_RAY: f32 = 0.577_350_3;
/// Radius of spheres, in search radii: √(2/3), rounded up.
const SPHERE: f32 = 0.816_496_6;
/// Half the width of cubes, of which squares are two faces, in search radii.
const CUBE: f32 = 0.5;

/// Bodies in a [`crate::Bvh`], and the rays that find them. All but points need one radius for all particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Probe {
    /// Boxes of half width r, met by infinitesimal rays.
    #[default]
    Point,
    /// Spheres of radius √(2/3) r, met by three rays along the axes (paper B, section 4.2).
    Axes,
    /// Pairs of squares, opposite faces of a cube of width r, met by rays along the cube's four other edges (paper B,
    /// section 4.3).
    Edges,
}

impl Probe {
    /// Every probe.
    pub const ALL: [Self; 3] = [Self::Point, Self::Axes, Self::Edges];

    /// Half the width of a body, in search radii.
    #[inline(always)]
    pub(super) fn body(self) -> f32 {
        match self {
            Self::Point => 1.0,
            Self::Axes => SPHERE,
            Self::Edges => CUBE,
        }
    }

    /// How often the rounding of coordinates counts: rays that leave their particle are rounded once more, on a body's
    /// side and on their own.
    pub(super) fn roundings(self) -> f32 {
        match self {
            Self::Point => 1.0,
            Self::Axes | Self::Edges => 2.0,
        }
    }
}

/// Boxes around the axis rays of all points in `query`; `reach` is the search radius.
#[inline(always)]
pub(super) fn axis_rays(query: &Aabb, reach: f32) -> [Aabb; 3] {
    let mut rays = [*query; 3];
    for (axis, ray) in rays.iter_mut().enumerate() {
        ray.lo[axis] -= AXIS_RAY * reach;
        ray.hi[axis] += AXIS_RAY * reach;
    }
    rays
}

/// Boxes around the edge rays of all points in `query`.
#[inline(always)]
pub(super) fn edge_rays(query: &Aabb, reach: f32) -> [Aabb; 4] {
    let half = CUBE * reach;
    let mut rays = [*query; 4];
    for (edge, ray) in rays.iter_mut().enumerate() {
        let y = if edge & 1 == 0 { half } else { -half };
        let z = if edge & 2 == 0 { half } else { -half };
        *ray = ray.translated([0.0, y, z]);
        ray.lo[0] -= half;
        ray.hi[0] += half;
    }
    rays
}
