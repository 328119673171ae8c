//! Lines of a certain thickness, which look the same in any light: edges of the box, rays.

use glam::Vec3;
use nearfield_core::{Boundary, SimBox};
use nearfield_cpu::Ray;

/// A round stick with round ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub ends: [Vec3; 2],
    /// Half the thickness, \[length\].
    pub radius: f32,
    /// Its light.
    pub color: Vec3,
}

impl Line {
    /// Where a ray enters it.
    ///
    /// Source: Inigo Quilez, <https://iquilezles.org/articles/intersectors/>, `capIntersect`.
    pub fn entry(&self, ray: &Ray) -> Option<f32> {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        let [start, end] = self.ends;
        let axis = end - start;
        // Seen from the point of the ray nearest to the line's middle, numbers stay small.
        let ahead = (0.5 * (start + end) - origin).dot(direction);
        let offset = origin + ahead * direction - start;
        let square = axis.length_squared();
        let (along, across) = (axis.dot(direction), axis.dot(offset));
        let a = square - along * along;
        let b = square * direction.dot(offset) - across * along;
        let c = square * offset.length_squared() - across * across - self.radius * self.radius * square;
        let discriminant = b * b - a * c;
        let mut entry = f32::INFINITY;
        if a > 1e-9 * square {
            if discriminant < 0.0 {
                return None;
            }
            let distance = (-b - discriminant.sqrt()) / a;
            let height = across + distance * along;
            if height > 0.0 && height < square {
                entry = distance;
            }
        }
        for center in [Vec3::ZERO, axis] {
            let to = center - offset;
            let nearest = to.dot(direction);
            let inside = self.radius * self.radius - (to - nearest * direction).length_squared();
            if inside >= 0.0 {
                entry = entry.min(nearest - inside.sqrt());
            }
        }
        let distance = ahead + entry;
        (distance > 0.0 && distance.is_finite()).then_some(distance)
    }
}

/// The first line along a ray.
pub(super) fn nearest<'a>(lines: &'a [Line], ray: &Ray) -> Option<(f32, &'a Line)> {
    let met = lines.iter().filter_map(|line| Some((line.entry(ray)?, line)));
    met.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The twelve edges of a box.
pub(super) fn edges(lo: Vec3, hi: Vec3) -> [[Vec3; 2]; 12] {
    std::array::from_fn(|edge| {
        let (axis, side) = (edge / 4, edge % 4);
        let mut ends = [lo, lo];
        for (bit, other) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().enumerate() {
            if side >> bit & 1 == 1 {
                ends[0][other] = hi[other];
                ends[1][other] = hi[other];
            }
        }
        ends[1][axis] = hi[axis];
        ends
    })
}

/// Whether the box bounds the particles on some axis: in open space it only informs.
pub(super) fn is_real(sim_box: &SimBox) -> bool {
    sim_box.boundary() != [Boundary::Open; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: Line = Line { ends: [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0)], radius: 0.5, color: Vec3::ONE };

    fn entry(origin: [f32; 3], direction: [f32; 3]) -> Option<f32> {
        LINE.entry(&Ray { origin, direction })
    }

    #[test]
    fn rays_enter_a_line_at_its_side_and_at_its_ends() {
        let near = |found: Option<f32>, expected: f32| {
            assert!(found.is_some_and(|d| (d - expected).abs() < 1e-4), "{found:?}, expected {expected}");
        };
        near(entry([2.0, 0.0, 9.0], [0.0, 0.0, -1.0]), 8.5);
        near(entry([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 2.5);
        near(entry([4.3, 0.0, 9.0], [0.0, 0.0, -1.0]), 8.6);
        near(entry([2.0, 0.3, 9.0], [0.0, 0.0, -1.0]), 8.6);
    }

    #[test]
    fn rays_beside_or_away_from_a_line_miss_it() {
        for (origin, direction) in [
            ([2.0, 0.51, 9.0], [0.0, 0.0, -1.0]),
            ([4.51, 0.0, 9.0], [0.0, 0.0, -1.0]),
            ([2.0, 0.0, 9.0], [0.0, 0.0, 1.0]),
            ([-3.0, 0.51, 0.0], [1.0, 0.0, 0.0]),
        ] {
            assert_eq!(entry(origin, direction), None, "{origin:?} {direction:?}");
        }
    }

    #[test]
    fn a_box_has_four_edges_along_each_axis_and_each_corner_on_three() {
        let edges = edges(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0));
        let mut corners = std::collections::HashMap::new();
        let mut along = [0; 3];
        for [start, end] in edges {
            let difference = (end - start).to_array();
            let axis = (0..3).find(|&axis| difference[axis] == [1.0, 2.0, 3.0][axis]).unwrap();
            assert_eq!(difference.iter().filter(|&&d| d != 0.0).count(), 1);
            along[axis] += 1;
            for corner in [start, end] {
                *corners.entry(corner.to_array().map(f32::to_bits)).or_insert(0) += 1;
            }
        }
        assert_eq!(along, [4; 3]);
        assert!(corners.len() == 8 && corners.values().all(|&n| n == 3), "{corners:?}");
    }
}
