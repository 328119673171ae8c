//! Bodies and rays: what stands for a particle in a structure, and what is sent to find it.

use nearfield_core::{Boundary, SimBox};
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
    /// Two squares each, opposite faces of a cube of width r, met by rays along the cube's other edges (paper B,
    /// section 4.3).
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

    /// Sizes and places of bodies and rays for the search radius `reach`.
    ///
    /// A ray that is to meet a body passes at least one margin inside of its rim, begins and ends at least one margin
    /// away from it. A third of the margin is more than all roundings of coordinates come to, ten of numbers up to the
    /// extent; the rest is for the intersection, of whose rounding devices promise nothing. Proof in docs/rays.md.
    pub(super) fn geometry(self, reach: f32, sim_box: &SimBox) -> Geometry {
        let (lo, hi) = bounds(sim_box);
        let margin = margin(reach, sim_box);
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

fn margin(reach: f32, sim_box: &SimBox) -> f32 {
    let (lo, hi) = bounds(sim_box);
    let largest = |values: [f32; 3]| values.into_iter().fold(0.0, |m: f32, x| m.max(x.abs()));
    let extent = largest(lo).max(largest(hi)) + largest(sim_box.lengths()) + 2.0 * reach;
    reach / 256.0 + 32.0 * f32::EPSILON * extent
}

/// The box, and on open axes, where particles may be anywhere, one length beyond it.
fn bounds(sim_box: &SimBox) -> ([f32; 3], [f32; 3]) {
    let (boundary, length) = (sim_box.boundary(), sim_box.lengths());
    let beyond = |axis: usize| if boundary[axis] == Boundary::Open { length[axis] } else { 0.0 };
    (
        std::array::from_fn(|axis| sim_box.lo()[axis] - beyond(axis)),
        std::array::from_fn(|axis| sim_box.hi()[axis] + beyond(axis)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const REACH: f32 = 2.5;

    fn sim_box() -> SimBox {
        SimBox::cubic(20.0, Boundary::Periodic).expect("a valid box")
    }

    /// Displacements up to the search radius, those on axes and diagonals included.
    fn displacements() -> impl Iterator<Item = [f64; 3]> {
        let steps = || (-20..=20).map(|k| f64::from(k) / 20.0);
        let directions = steps().flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])));
        directions.filter(|d| d.iter().any(|&c| c != 0.0)).flat_map(|d| {
            let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
            [0.0, 1e-6, 0.3, 0.577, 0.58, 0.82, 1.0].map(|k| d.map(|c| k * f64::from(REACH) * c / length))
        })
    }

    #[test]
    fn the_nearest_axis_ray_enters_the_sphere_of_every_neighbour_two_margins_within_its_ends() {
        let g = Probe::Axes.geometry(REACH, &sim_box());
        let margin = f64::from(margin(REACH, &sim_box()));
        for d in displacements() {
            let along = d.into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).expect("three axes");
            let distance2 = d.iter().map(|c| c * c).sum::<f64>() - along * along;
            let half_chord = (f64::from(g.body).powi(2) - distance2).sqrt();
            let entry = along - half_chord - f64::from(g.start);
            assert!(half_chord > 0.1 * f64::from(REACH), "{d:?}");
            assert!(entry > 1.99 * margin && entry < f64::from(g.length) - 1.99 * margin, "{d:?}: {entry}");
        }
    }

    #[test]
    fn the_owning_edge_ray_passes_two_margins_within_the_owning_triangle() {
        let g = Probe::Edges.geometry(REACH, &sim_box());
        let margin = f64::from(margin(REACH, &sim_box()));
        let [body, offset, overlap] = [g.body, g.offset, g.overlap].map(f64::from);
        for d in displacements() {
            let along = if d[0] < 0.0 { d[0] + offset } else { d[0] - offset } - f64::from(g.start);
            let [y, z] = [d[1], d[2]].map(|c| if c < 0.0 { -offset - c } else { offset - c });
            // Mirrored, the second triangle is the first.
            let (y, z) = if z > y { (z, y) } else { (y, z) };
            let to_edges = [body - y, z + body, (y - z + overlap) / 2f64.sqrt()];
            let to_ends = [along, f64::from(g.length) - along];
            let nearest = to_edges.into_iter().chain(to_ends).fold(f64::INFINITY, f64::min);
            assert!(nearest > 1.99 * margin, "{d:?}: {to_edges:?}, {to_ends:?}");
        }
    }

    #[test]
    fn bodies_are_placed_within_a_length_of_open_faces_and_within_others() {
        let slab = SimBox::new([0.0; 3], [4.0; 3], [Boundary::Open, Boundary::Periodic, Boundary::Wall]);
        let g = Probe::Axes.geometry(1.0, &slab.expect("a valid box"));
        assert_eq!((g.lo, g.hi), ([-4.0, 0.0, 0.0], [8.0, 4.0, 4.0]));
    }
}
