//! Bodies and rays: what stands for a particle in a structure, and what is sent to find it.

use super::Scene;
use nearfield_core::Boundary;
use nearfield_kernels::{
    ByForce, RayProgram, kernels,
    layouts::{ForceRays, Geometry, ListRays},
};

/// Which bodies and rays. All but points need one radius for all particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probe {
    /// Boxes of half width r, met by infinitesimal rays.
    Point,
    /// Spheres of radius √(2/3) r, met by three rays along the axes (paper B, section 4.2).
    Axes,
    /// Two squares each, opposite faces of a cube of width r, met by rays along the cube's other edges (paper B, section
    /// 4.3).
    Edges,
}

impl Probe {
    /// Programs that sum forces.
    pub(super) fn gather(self) -> ByForce<RayProgram<ForceRays>> {
        match self {
            Self::Point => kernels::RAY_GATHER,
            Self::Axes => kernels::AXIS_GATHER,
            Self::Edges => kernels::EDGE_GATHER,
        }
    }

    /// Program that counts neighbours.
    pub(super) fn count(self) -> RayProgram<ListRays> {
        match self {
            Self::Point => kernels::RAY_COUNT,
            Self::Axes => kernels::AXIS_COUNT,
            Self::Edges => kernels::EDGE_COUNT,
        }
    }

    /// Program that lists neighbours.
    pub(super) fn fill(self) -> RayProgram<ListRays> {
        match self {
            Self::Point => kernels::RAY_FILL,
            Self::Axes => kernels::AXIS_FILL,
            Self::Edges => kernels::EDGE_FILL,
        }
    }

    /// Sizes and places of bodies and rays.
    ///
    /// A ray that is to meet a body passes at least one margin inside of its rim, begins and ends at least one margin
    /// away from it. A third of the margin is more than all roundings of coordinates come to, ten of numbers up to the
    /// extent; the rest is for the intersection, of whose rounding devices promise nothing. Proof in docs/rays.md.
    pub(super) fn geometry(self, scene: &Scene) -> Geometry {
        let reach = scene.largest + scene.skin;
        let (lo, hi) = bounds(scene);
        let largest = |values: [f32; 3]| values.into_iter().fold(0.0, |m: f32, x| m.max(x.abs()));
        let extent = largest(lo).max(largest(hi)) + largest(scene.space.length) + 2.0 * reach;
        let margin = reach / 256.0 + 32.0 * f32::EPSILON * extent;
        match self {
            Self::Point => Geometry::default(),
            Self::Axes => {
                let radius = (2.0f32 / 3.0).sqrt() * reach + 2.0 * margin;
                // Before the spheres of all neighbours: a ray that begins inside meets only the far side.
                let start = -(reach + radius + 2.0 * margin);
                let end = (1.0f32 / 3.0).sqrt() * reach + 2.0 * margin;
                Geometry { lo, hi, body: radius, start, length: end - start, ..Geometry::default() }
            }
            Self::Edges => {
                let offset = 0.5 * reach;
                let body = offset + 2.0 * margin;
                Geometry { lo, hi, body, offset, overlap: 3.0 * margin, start: -body, length: 2.0 * body, unused: 0 }
            }
        }
    }
}

/// The box, and on open axes, where particles may be anywhere, one length beyond it.
fn bounds(scene: &Scene) -> ([f32; 3], [f32; 3]) {
    let boundary = scene.sim_box.boundary();
    let beyond = |axis: usize| if boundary[axis] == Boundary::Open { scene.space.length[axis] } else { 0.0 };
    (
        std::array::from_fn(|axis| scene.space.lo[axis] - beyond(axis)),
        std::array::from_fn(|axis| scene.space.hi[axis] + beyond(axis)),
    )
}
