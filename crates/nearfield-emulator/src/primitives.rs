//! What rays meet: boxes, spheres and triangles, found through a tree and tested in f32.
//!
//! Where devices leave open what happens, the worst is done: rays meet a sphere both where they enter and where they
//! leave it, and triangles include their edges.

use crate::{launch::Segment, tree::Tree};
use nearfield_cuda::gpu::{Aabb, Triangle};
use nearfield_kernels::Primitive;

/// Primitives of one kind, as they were at the last build or refit.
pub enum Shapes {
    Boxes(Vec<Aabb>),
    Spheres { centers: Vec<[f32; 3]>, radius: f32 },
    Triangles(Vec<Triangle>),
}

impl Shapes {
    pub fn len(&self) -> usize {
        match self {
            Self::Boxes(boxes) => boxes.len(),
            Self::Spheres { centers, .. } => centers.len(),
            Self::Triangles(triangles) => triangles.len(),
        }
    }

    /// What they are called in messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Boxes(_) => "boxes",
            Self::Spheres { .. } => "spheres",
            Self::Triangles(_) => "triangles",
        }
    }

    fn kind(&self) -> Primitive {
        match self {
            Self::Boxes(_) => Primitive::Box,
            Self::Spheres { .. } => Primitive::Sphere,
            Self::Triangles(_) => Primitive::Triangle,
        }
    }

    /// A box around each.
    fn bounds(&self) -> Vec<Aabb> {
        match self {
            Self::Boxes(boxes) => boxes.clone(),
            Self::Spheres { centers, radius } => {
                let around = |c: &[f32; 3]| {
                    std::array::from_fn(
                        |k| if k < 3 { (c[k] - radius).next_down() } else { (c[k - 3] + radius).next_up() },
                    )
                };
                centers.iter().map(around).collect()
            }
            Self::Triangles(triangles) => {
                let around = |[a, b, c]: &Triangle| {
                    std::array::from_fn(|k| {
                        if k < 3 { a[k].min(b[k]).min(c[k]) } else { a[k - 3].max(b[k - 3]).max(c[k - 3]) }
                    })
                };
                triangles.iter().map(around).collect()
            }
        }
    }
}

/// Primitives in a tree.
pub struct Primitives {
    shapes: Shapes,
    tree: Tree,
}

impl Primitives {
    pub fn new(shapes: Shapes) -> Self {
        let tree = Tree::new(&shapes.bounds());
        Self { shapes, tree }
    }

    pub fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// Fits the tree to as many others of the same kind.
    pub fn refit(&mut self, shapes: Shapes) {
        self.tree.refit(&shapes.bounds());
        self.shapes = shapes;
    }

    /// Whether they are what a program is for.
    pub fn are(&self, kind: Primitive) -> bool {
        self.shapes.kind() == kind
    }

    /// Calls `found` with the number of each primitive that the ray meets and the distance along it; of boxes only the
    /// ray's origin is asked.
    pub fn meet(&self, ray: &Segment, mut found: impl FnMut(u32, f32)) {
        match &self.shapes {
            Shapes::Boxes(_) => {
                let [x, y, z] = ray.origin;
                self.tree.overlapping(&[x, y, z, x, y, z], |number| found(number, 0.0));
            }
            Shapes::Spheres { centers, radius } => self.tree.overlapping(&around(ray), |number| {
                for distance in cross_sphere(ray, centers[number as usize], *radius).into_iter().flatten() {
                    found(number, distance);
                }
            }),
            Shapes::Triangles(triangles) => self.tree.overlapping(&around(ray), |number| {
                if let Some(distance) = cross_triangle(ray, &triangles[number as usize]) {
                    found(number, distance);
                }
            }),
        }
    }
}

/// A box around a ray.
fn around(ray: &Segment) -> Aabb {
    let end: [f32; 3] = std::array::from_fn(|axis| ray.origin[axis] + ray.length * ray.direction[axis]);
    std::array::from_fn(|k| match k {
        0..3 => ray.origin[k].min(end[k]).next_down(),
        _ => ray.origin[k - 3].max(end[k - 3]).next_up(),
    })
}

/// Where a ray enters and where it leaves a sphere.
fn cross_sphere(ray: &Segment, center: [f32; 3], radius: f32) -> [Option<f32>; 2] {
    let from_center = subtract(ray.origin, center);
    let half = dot(from_center, ray.direction);
    let discriminant = half * half - (dot(from_center, from_center) - radius * radius);
    if discriminant.is_nan() || discriminant < 0.0 {
        return [None; 2];
    }
    let root = discriminant.sqrt();
    [-half - root, -half + root].map(|t| (0.0..=ray.length).contains(&t).then_some(t))
}

/// Where a ray passes through a triangle, from either side: T. Moeller and B. Trumbore, J. Graphics Tools 2 (1997) 21.
fn cross_triangle(ray: &Segment, &[a, b, c]: &Triangle) -> Option<f32> {
    let (ab, ac) = (subtract(b, a), subtract(c, a));
    let p = cross(ray.direction, ac);
    let determinant = dot(ab, p);
    if determinant == 0.0 {
        return None;
    }
    let from_a = subtract(ray.origin, a);
    let u = dot(from_a, p) / determinant;
    let q = cross(from_a, ab);
    let v = dot(ray.direction, q) / determinant;
    let t = dot(ac, q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=ray.length).contains(&t)).then_some(t)
}

fn subtract(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
