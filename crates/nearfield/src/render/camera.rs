//! From pixels to rays.

use glam::{Vec2, Vec3};
use nearfield_cpu::Ray;

/// How depth is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// What is farther is smaller.
    #[default]
    Perspective,
    /// Parallel lines stay parallel: sizes can be compared and measured.
    Orthographic,
}

/// Where the camera stands and what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// How depth is drawn.
    pub projection: Projection,
    /// Angle about the z axis, \[degrees\]: at 0 the camera stands on the +x side, at 90 on the +y side.
    pub azimuth: f32,
    /// Angle above the xy plane, -90 to 90, \[degrees\].
    pub elevation: f32,
    /// Magnification; at 1 everything fits.
    pub zoom: f32,
    /// Width and height of the picture, \[pixels\].
    pub size: [u32; 2],
}

impl Default for View {
    fn default() -> Self {
        Self { projection: Projection::Perspective, azimuth: -60.0, elevation: 20.0, zoom: 1.0, size: [1600, 1200] }
    }
}

/// Tangent of half the angle of view, along the shorter side of the picture.
const HALF_VIEW: f32 = 0.2;
/// Part of the picture that is filled, at zoom 1.
const FILLED: f32 = 0.94;
/// Corrections of where the camera looks; each leaves a small part of the error.
const CENTERINGS: usize = 6;

/// A camera in its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    projection: Projection,
    target: Vec3,
    /// Unit vectors: right and up in the picture, and from the target to the camera.
    pub right: Vec3,
    pub up: Vec3,
    pub back: Vec3,
    /// From the camera to the target, \[length\].
    distance: f32,
    /// Size of a pixel at the target, \[length\].
    pub pixel: f32,
    /// The pixel of the target.
    center: [f32; 2],
}

impl Camera {
    /// A camera that sees all of `points` at zoom 1, in the middle of the `width` leftmost pixels of the picture.
    pub fn new(view: &View, width: f32, points: &[Vec3]) -> Self {
        let lo = points.iter().copied().reduce(Vec3::min).unwrap_or(Vec3::ZERO);
        let hi = points.iter().copied().reduce(Vec3::max).unwrap_or(Vec3::ONE);
        let center = [0.5 * width, 0.5 * view.size[1] as f32];
        let mut camera = Self::facing(0.5 * (lo + hi), view, center, points);
        // What is nearer is larger, so the middle of the points is not that of their picture.
        for _ in 0..CENTERINGS {
            let seen = || points.iter().map(|&point| Vec2::from(camera.project(point)));
            let lo = seen().reduce(Vec2::min).unwrap_or(center.into());
            let hi = seen().reduce(Vec2::max).unwrap_or(center.into());
            let off = camera.pixel * (0.5 * (lo + hi) - Vec2::from(center));
            let target = camera.target + off.x * camera.right - off.y * camera.up;
            camera = Self::facing(target, view, center, points);
        }
        camera
    }

    /// A camera that looks at a target from as near as `points` allow.
    fn facing(target: Vec3, view: &View, center: [f32; 2], points: &[Vec3]) -> Self {
        let (sin_azimuth, cos_azimuth) = view.azimuth.to_radians().sin_cos();
        let (sin_elevation, cos_elevation) = view.elevation.to_radians().sin_cos();
        let right = Vec3::new(-sin_azimuth, cos_azimuth, 0.0);
        let back = Vec3::new(cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation);
        let up = back.cross(right);
        let offsets = || points.iter().map(|&point| point - target);
        let reach = |offset: Vec3| {
            let [x, y] = [offset.dot(right).abs() / center[0], offset.dot(up).abs() / center[1]];
            x.max(y) / FILLED
        };
        let radius = offsets().map(Vec3::length).fold(f32::MIN_POSITIVE, f32::max);
        let (distance, pixel) = match view.projection {
            Projection::Orthographic => (4.0 * radius, offsets().map(reach).fold(0.0, f32::max)),
            Projection::Perspective => {
                // A point at offset x and depth z is in the picture when |x| is at most (distance - z) times the
                // tangent of the angle of view on this axis.
                let per_pixel = HALF_VIEW / center[0].min(center[1]);
                let needed = |offset: Vec3| offset.dot(back) + reach(offset) / per_pixel;
                let distance = offsets().map(needed).fold(1.1 * radius, f32::max);
                (distance, per_pixel * distance)
            }
        };
        let pixel = pixel.max(f32::MIN_POSITIVE) / view.zoom;
        Self { projection: view.projection, target, right, up, back, distance, pixel, center }
    }

    /// The ray through a point of the picture, \[pixels\] from its upper left corner.
    pub fn ray(&self, x: f32, y: f32) -> Ray {
        let across = self.pixel * ((x - self.center[0]) * self.right + (self.center[1] - y) * self.up);
        let eye = self.target + self.distance * self.back;
        let (origin, direction) = match self.projection {
            Projection::Orthographic => (eye + across, -self.back),
            Projection::Perspective => (eye, (across - self.distance * self.back).normalize()),
        };
        Ray { origin: origin.into(), direction: direction.into() }
    }

    /// How far a point is towards the camera, from the target, \[length\].
    pub fn nearness(&self, point: Vec3) -> f32 {
        (point - self.target).dot(self.back)
    }

    /// The point of the picture where a point is seen.
    fn project(&self, point: Vec3) -> [f32; 2] {
        let offset = point - self.target;
        let scale = match self.projection {
            Projection::Orthographic => 1.0,
            Projection::Perspective => self.distance / (self.distance - offset.dot(self.back)),
        } / self.pixel;
        [self.center[0] + scale * offset.dot(self.right), self.center[1] - scale * offset.dot(self.up)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Vec<Vec3> {
        (0..8).map(|c| Vec3::new((c & 1) as f32, (c >> 1 & 1) as f32, (c >> 2) as f32) * 3.0).collect()
    }

    #[test]
    fn all_points_are_in_the_picture_and_fill_it() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (azimuth, elevation) in [(0.0, 0.0), (-60.0, 20.0), (170.0, -80.0), (45.0, 90.0)] {
                let view = View { projection, azimuth, elevation, size: [300, 200], ..View::default() };
                let camera = Camera::new(&view, 250.0, &corners());
                let seen: Vec<[f32; 2]> = corners().into_iter().map(|corner| camera.project(corner)).collect();
                let fill = seen
                    .iter()
                    .map(|[x, y]| ((x - 125.0).abs() / 125.0).max((y - 100.0).abs() / 100.0))
                    .fold(0.0, f32::max);
                assert!((fill - FILLED).abs() < 1e-3, "{projection:?} {azimuth} {elevation}: {fill}");
            }
        }
    }

    #[test]
    fn a_ray_leads_through_what_its_pixel_shows() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera::new(&View { projection, zoom: 1.7, ..View::default() }, 1500.0, &corners());
            for corner in corners() {
                let [x, y] = camera.project(corner);
                let ray = camera.ray(x, y);
                let to = corner - Vec3::from(ray.origin);
                let off = to.reject_from(ray.direction.into());
                assert!(off.length() < 1e-4, "{projection:?} {corner}: {off}");
            }
        }
    }

    #[test]
    fn azimuth_0_looks_from_plus_x_with_z_upwards() {
        let view = View { azimuth: 0.0, elevation: 0.0, ..View::default() };
        let camera = Camera::new(&view, 100.0, &corners());
        assert!(camera.back.abs_diff_eq(Vec3::X, 1e-6) && camera.up.abs_diff_eq(Vec3::Z, 1e-6));
        assert!(camera.right.abs_diff_eq(Vec3::Y, 1e-6));
    }
}
