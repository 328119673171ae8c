//! How surfaces look: a key light that casts soft shadows, and a sky that reaches less into the depths.
//!
//! Each pixel is the mean of several samples, and sample `s` of every pixel takes the same directions towards the light
//! and the sky. The means are therefore smooth where the usual choice, random directions, gives noise.

use super::{
    camera::Camera,
    spheres::{Hit, Spheres},
};
use glam::Vec3;
use nearfield_cpu::Ray;

/// Light from the key lamp on a surface that faces it, and from the sky on one that sees all of it.
const KEY: f32 = 0.72;
const SKY: f32 = 0.64;
/// The sky's light from below, of that from above.
const GROUND: f32 = 0.5;
/// The part of the sky's light that reaches everywhere.
const FILL: f32 = 0.22;
/// Radius of the key lamp at unit distance: softness of shadows.
const LAMP: f32 = 0.16;
/// How far the sky is hidden by others, in radii of the sphere in question.
const SKY_REACH: f32 = 14.0;
/// Highlight: its strength and sharpness.
const SHINE: f32 = 0.16;
const SHARPNESS: i32 = 36;

/// The golden angle, by which points on a spiral spread evenly.
const GOLDEN: f32 = 2.399_963_2;

/// The lights, which keep their place relative to the camera.
pub(super) struct Lights {
    up: Vec3,
    key: Vec3,
    /// For each sample, a direction to the key lamp and one to the sky.
    samples: Vec<(Vec3, Vec3)>,
}

impl Lights {
    /// Lights for `n` samples a pixel.
    pub fn new(camera: &Camera, n: usize) -> Self {
        let Camera { right, up, back, .. } = *camera;
        let key = (-0.5 * right + 0.75 * up + 0.75 * back).normalize();
        let (across, along) = key.any_orthonormal_pair();
        let samples = (0..n).map(|s| {
            let fraction = (s as f32 + 0.5) / n as f32;
            let turn = |angle: f32| Vec3::new(angle.cos(), angle.sin(), 0.0);
            let lamp = LAMP * fraction.sqrt() * turn(GOLDEN * s as f32);
            let height = 1.0 - 2.0 * fraction;
            let level = (1.0 - height * height).sqrt() * turn(GOLDEN * s as f32);
            ((key + lamp.x * across + lamp.y * along).normalize(), level.x * right + level.y * back + height * up)
        });
        Self { up, key, samples: samples.collect() }
    }

    /// Light of the sky from a direction.
    fn sky(&self, direction: Vec3) -> f32 {
        let height = 0.5 + 0.5 * direction.dot(self.up);
        GROUND + (1.0 - GROUND) * height
    }

    /// Light from an opaque surface towards the ray's origin, in sample `sample`.
    pub fn opaque(&self, spheres: &Spheres, hit: &Hit, ray: &Ray, sample: usize) -> Vec3 {
        let view = -Vec3::from(ray.direction);
        let normal = hit.normal;
        // Away from the surface by more than rounding, or it would shade itself.
        let start = Vec3::from(ray.origin) - hit.distance * view + 2e-3 * hit.radius * normal;
        let towards = |direction: Vec3| Ray { origin: start.into(), direction: direction.into() };
        let (lamp, sky) = self.samples[sample];
        let facing = normal.dot(lamp).max(0.0);
        let (mut key, mut shine) = (0.0, 0.0);
        if facing > 0.0 && !spheres.blocked(&towards(lamp), f32::INFINITY) {
            key = KEY * facing;
            shine = SHINE * normal.dot((lamp + view).normalize()).max(0.0).powi(SHARPNESS);
        }
        // What this direction contributes to the open sky, so that the mean over samples is right without others.
        let weight = |direction: Vec3| normal.dot(direction).max(0.0) * self.sky(direction);
        let (mine, mut all) = (weight(sky), 0.0);
        for &(_, direction) in &self.samples {
            all += weight(direction);
        }
        let open = SKY * self.sky(normal);
        let ambient = if all <= 0.0 {
            open
        } else if mine > 0.0 && !spheres.blocked(&towards(sky), SKY_REACH * hit.radius) {
            open * (FILL + (1.0 - FILL) * mine / all * self.samples.len() as f32)
        } else {
            open * FILL
        };
        hit.color * (key + ambient) + Vec3::splat(shine)
    }

    /// Light from a pane of glass: both sides alike, without shadows.
    pub fn pane(&self, color: Vec3, normal: Vec3) -> Vec3 {
        color * (0.7 + 0.3 * normal.dot(self.key).abs())
    }
}
