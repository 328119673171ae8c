//! What the ray-tracing methods put around particles, drawn as tinted glass, and the rays they send.
//!
//! The shapes are those of paper B, for a cutoff C: a sphere of radius C √(2/3) for three axis rays of that half
//! length; squares of width C at x ± C/2 for the four edges along x of the cube of width C; a box of half width C for a
//! point.

use super::spheres::tree;
use glam::Vec3;
use nearfield_core::{Radii, Vec3s};
use nearfield_cpu::{Bvh, Ray};

/// What is drawn for a particle, beside the particle itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// Nothing.
    #[default]
    Point,
    /// The sphere of `rt-spheres`, which axis rays meet.
    Sphere,
    /// The two squares of `rt-squares`, which edge rays meet.
    Squares,
    /// The box of `rt-boxes`, which points lie in.
    Box,
}

impl Shape {
    /// Half the width of the shape for a cutoff.
    pub(super) fn half_width(self, cutoff: f32) -> f32 {
        match self {
            Self::Point | Self::Box => cutoff,
            Self::Sphere => cutoff * (2.0_f32 / 3.0).sqrt(),
            Self::Squares => 0.5 * cutoff,
        }
    }

    /// The rays, from end to end, by which a particle at `from` finds the shapes around it.
    pub(super) fn rays(self, from: Vec3, cutoff: f32) -> Vec<[Vec3; 2]> {
        let half = self.half_width(cutoff);
        match self {
            Self::Point | Self::Box => Vec::new(),
            Self::Sphere => Vec3::AXES.map(|axis| [from - half * axis, from + half * axis]).to_vec(),
            Self::Squares => [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)]
                .map(|(y, z)| [-1.0, 1.0].map(|x| from + half * Vec3::new(x, y, z)))
                .to_vec(),
        }
    }
}

/// Panes that a ray passes: more would not be seen behind these.
const MOST_PANES: usize = 32;
/// Opacity of panes, and of their edges.
const PANE: f32 = 0.13;
const EDGE: f32 = 0.85;

/// A pane of glass that a ray passes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pane {
    /// From the ray's origin, \[length\].
    pub distance: f32,
    /// Of the surface; either side.
    pub normal: Vec3,
    /// The part of the light that it reflects.
    pub color: Vec3,
    /// The part of what is behind that it hides.
    pub opacity: f32,
}

/// The nearest panes along a ray, in order.
#[derive(Default)]
pub(super) struct Panes {
    panes: [Pane; MOST_PANES],
    n: usize,
}

impl Panes {
    /// The panes, nearest first.
    pub fn as_slice(&self) -> &[Pane] {
        &self.panes[..self.n]
    }

    fn push(&mut self, pane: Pane) {
        if self.n == MOST_PANES {
            if pane.distance >= self.panes[MOST_PANES - 1].distance {
                return;
            }
            self.n -= 1;
        }
        let mut place = self.n;
        while place > 0 && self.panes[place - 1].distance > pane.distance {
            self.panes[place] = self.panes[place - 1];
            place -= 1;
        }
        self.panes[place] = pane;
        self.n += 1;
    }

    /// How far panes can still be among the nearest.
    fn reach(&self, reach: f32) -> f32 {
        if self.n == MOST_PANES { reach.min(self.panes[MOST_PANES - 1].distance) } else { reach }
    }
}

/// Shapes of one sort, indexed for rays.
pub(super) struct Shapes {
    bvh: Bvh,
    shape: Shape,
    half_width: Radii,
    color: Vec<Vec3>,
    /// Width of the frame around panes, \[length\].
    frame: f32,
}

impl Shapes {
    /// Shapes around particles, each with a cutoff and a colour.
    pub fn new(shape: Shape, center: &Vec3s, cutoff: &Radii, color: Vec<Vec3>, frame: f32) -> Self {
        let half_width = match cutoff {
            Radii::Uniform(cutoff) => Radii::Uniform(shape.half_width(*cutoff)),
            Radii::PerParticle(cutoffs) => {
                Radii::PerParticle(cutoffs.iter().map(|&cutoff| shape.half_width(cutoff)).collect())
            }
        };
        Self { bvh: tree(center, &half_width), shape, half_width, color, frame }
    }

    /// The nearest panes within reach of a ray.
    pub fn panes(&self, ray: &Ray, reach: f32) -> Panes {
        let mut panes = Panes::default();
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        self.bvh.cast(ray, reach, |slots, range, reach| {
            for slot in range {
                let particle = slots.particle[slot] as usize;
                if particle >= self.color.len() {
                    continue;
                }
                let half = self.half_width.get(particle);
                let offset = origin - Vec3::new(slots.x[slot], slots.y[slot], slots.z[slot]);
                let mut push = |distance: f32, normal: Vec3, opacity: f32| {
                    if distance > 0.0 && distance < reach {
                        panes.push(Pane { distance, normal, color: self.color[particle], opacity });
                    }
                };
                match self.shape {
                    Shape::Point | Shape::Sphere => sphere(offset, direction, half, &mut push),
                    Shape::Squares => squares(offset, direction, half, self.frame, &mut push),
                    Shape::Box => cube(offset, direction, half, self.frame, &mut push),
                }
            }
            panes.reach(reach)
        });
        panes
    }
}

/// The near side of a sphere, denser towards its rim as a soap bubble is.
fn sphere(offset: Vec3, direction: Vec3, radius: f32, push: &mut impl FnMut(f32, Vec3, f32)) {
    let along = -offset.dot(direction);
    let square = radius * radius - (offset + along * direction).length_squared();
    if square > 0.0 {
        let distance = along - square.sqrt();
        let normal = (offset + distance * direction) / radius;
        let rim = (1.0 - normal.dot(direction).abs()).powi(4);
        push(distance, normal, 0.5 * PANE + 0.6 * rim);
    }
}

/// Squares across x, one on each side.
fn squares(offset: Vec3, direction: Vec3, half: f32, frame: f32, push: &mut impl FnMut(f32, Vec3, f32)) {
    for side in [-half, half] {
        let distance = (side - offset.x) / direction.x;
        let at = (offset + distance * direction).abs();
        if at.y <= half && at.z <= half {
            let opacity = if at.y.max(at.z) > half - frame { EDGE } else { 2.0 * PANE };
            push(distance, Vec3::X, opacity);
        }
    }
}

/// Both faces of a cube that a ray passes.
fn cube(offset: Vec3, direction: Vec3, half: f32, frame: f32, push: &mut impl FnMut(f32, Vec3, f32)) {
    let inverse = direction.recip();
    let (one, other) = ((-half - offset) * inverse, (half - offset) * inverse);
    let (enter, exit) = (one.min(other).max_element(), one.max(other).min_element());
    if enter > exit {
        return;
    }
    for distance in [enter, exit] {
        let point = offset + distance * direction;
        let mut at = point.abs().to_array();
        let face = (0..3).fold(0, |face, axis| if at[axis] > at[face] { axis } else { face });
        at.sort_by(f32::total_cmp);
        // The largest coordinate is the face's own; the next says how near an edge is.
        let opacity = if at[1] > half - frame { EDGE } else { 0.5 * PANE };
        push(distance, Vec3::AXES[face], opacity);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distances(shape: Shape, ray: &Ray) -> Vec<f32> {
        let center: Vec3s = [[0.0; 3]].into_iter().collect();
        let shapes = Shapes::new(shape, &center, &Radii::Uniform(3.0), vec![Vec3::ONE], 0.01);
        shapes.panes(ray, f32::INFINITY).as_slice().iter().map(|pane| pane.distance).collect()
    }

    #[test]
    fn panes_are_where_the_shapes_of_a_cutoff_are() {
        let along_x = Ray { origin: [-10.0, 0.5, 0.5], direction: [1.0, 0.0, 0.0] };
        let near = |found: Vec<f32>, expected: &[f32]| {
            let same = found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
            assert!(same, "{found:?}, expected {expected:?}");
        };
        near(distances(Shape::Sphere, &along_x), &[10.0 - (6.0_f32 - 0.5).sqrt()]);
        near(distances(Shape::Squares, &along_x), &[8.5, 11.5]);
        near(distances(Shape::Box, &along_x), &[7.0, 13.0]);
        let beside = Ray { origin: [-10.0, 1.6, 0.0], direction: [1.0, 0.0, 0.0] };
        near(distances(Shape::Squares, &beside), &[]);
        near(distances(Shape::Box, &beside), &[7.0, 13.0]);
    }

    #[test]
    fn rays_have_the_ends_of_paper_b() {
        let half = (2.0_f32 / 3.0).sqrt() * 3.0;
        let rays = Shape::Sphere.rays(Vec3::ONE, 3.0);
        assert_eq!(rays.len(), 3);
        assert_eq!(rays[1], [Vec3::new(1.0, 1.0 - half, 1.0), Vec3::new(1.0, 1.0 + half, 1.0)]);
        let rays = Shape::Squares.rays(Vec3::ONE, 3.0);
        assert_eq!(rays.len(), 4);
        assert_eq!(rays[0], [Vec3::splat(-0.5), Vec3::new(2.5, -0.5, -0.5)]);
        assert!(Shape::Box.rays(Vec3::ONE, 3.0).is_empty());
    }

    #[test]
    fn of_very_many_panes_the_nearest_are_kept_in_order() {
        let center: Vec3s = (0..500).map(|i| [((i * 37) % 500) as f32, 0.0, 0.0]).collect();
        let shapes = Shapes::new(Shape::Squares, &center, &Radii::Uniform(1.0), vec![Vec3::ONE; 500], 0.01);
        let ray = Ray { origin: [-2.0, 0.1, 0.1], direction: [1.0, 0.0, 0.0] };
        let panes = shapes.panes(&ray, f32::INFINITY);
        // Squares of neighbours coincide.
        let expected: Vec<f32> = (0..MOST_PANES).map(|pane| 1.5 + pane.div_ceil(2) as f32).collect();
        let found: Vec<f32> = panes.as_slice().iter().map(|pane| pane.distance).collect();
        assert_eq!(found, expected);
    }
}
