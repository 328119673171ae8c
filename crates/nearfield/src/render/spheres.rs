//! Opaque spheres, found through the tree.

use glam::Vec3;
use nearfield_core::{Boundary, Images, Radii, SimBox, Vec3s};
use nearfield_cpu::{Bvh, Input, InputRadii, LANES, Ray, Slots, Structure};
use std::ops::Range;

/// A tree over boxes `center ± half_width`, without periodic images.
pub(super) fn tree(center: &Vec3s, half_width: &Radii) -> Bvh {
    // In open space the box only informs.
    let sim_box = SimBox::cubic(1.0, Boundary::Open).expect("a unit cube is a box");
    let radii = match half_width {
        Radii::Uniform(r) => InputRadii::Uniform(*r),
        Radii::PerParticle(radii) => InputRadii::PerParticle(radii),
    };
    let mut bvh = Bvh::new(Images::Gamma);
    bvh.build(&Input { sim_box: &sim_box, position: center.axes().map(Vec::as_slice), radii, kind: &[] });
    bvh
}

/// Spheres indexed for rays.
pub(super) struct Spheres {
    bvh: Bvh,
    radius: Radii,
    /// The part of the light that each reflects.
    color: Vec<Vec3>,
}

/// What a ray sees of the spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// From the ray's origin, \[length\].
    pub distance: f32,
    /// Of the surface, outwards.
    pub normal: Vec3,
    /// Radius of the sphere, \[length\].
    pub radius: f32,
    /// The part of the light that the surface reflects.
    pub color: Vec3,
}

impl Spheres {
    /// Spheres with a colour each.
    pub fn new(center: &Vec3s, radius: Radii, color: Vec<Vec3>) -> Self {
        Self { bvh: tree(center, &radius), radius, color }
    }

    /// The first sphere along a ray. One around the origin of the ray is not seen.
    pub fn nearest(&self, ray: &Ray, reach: f32) -> Option<Hit> {
        let mut nearest = None;
        self.bvh.cast(
            ray,
            reach,
            #[inline(always)]
            |slots, range, mut reach| {
                let entry = self.entries(slots, range.clone(), ray);
                for (slot, entry) in range.zip(entry) {
                    if entry < reach {
                        reach = entry;
                        nearest = Some((entry, slot));
                    }
                }
                reach
            },
        );
        let slots = self.bvh.slots();
        nearest.map(|(distance, slot)| {
            let sphere = slots.particle[slot] as usize;
            let center = Vec3::new(slots.x[slot], slots.y[slot], slots.z[slot]);
            let point = Vec3::from(ray.origin) + distance * Vec3::from(ray.direction);
            let normal = (point - center).normalize_or_zero();
            Hit { distance, normal, radius: self.radius.get(sphere), color: self.color[sphere] }
        })
    }

    /// Whether anything is in the way of a ray.
    pub fn blocked(&self, ray: &Ray, reach: f32) -> bool {
        let mut blocked = false;
        self.bvh.cast(
            ray,
            reach,
            #[inline(always)]
            |slots, range, reach| {
                let entry = self.entries(slots, range, ray);
                let mut any = false;
                for entry in entry {
                    any |= entry < reach;
                }
                blocked = any;
                if any { -1.0 } else { reach }
            },
        );
        blocked
    }

    /// Where the ray enters the spheres of a leaf; infinitely far where it does not.
    #[inline(always)]
    fn entries(&self, slots: &Slots, range: Range<usize>, ray: &Ray) -> [f32; LANES] {
        let mut radius = [0.0; LANES];
        match &self.radius {
            Radii::Uniform(r) => radius = [*r; LANES],
            Radii::PerParticle(_) => radius.copy_from_slice(&slots.radius[range.clone()]),
        }
        let (x, y, z) = (&slots.x[range.clone()], &slots.y[range.clone()], &slots.z[range]);
        let (x, y, z) = (&x[..LANES], &y[..LANES], &z[..LANES]);
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin, ray.direction);
        let mut entry = [f32::INFINITY; LANES];
        for lane in 0..LANES {
            let (x, y, z) = (x[lane] - ox, y[lane] - oy, z[lane] - oz);
            let along = x * dx + y * dy + z * dz;
            // From the point nearest to the centre: the usual discriminant cancels for distant spheres.
            let (x, y, z) = (x - along * dx, y - along * dy, z - along * dz);
            let square = radius[lane] * radius[lane] - (x * x + y * y + z * z);
            let distance = along - (if square > 0.0 { square } else { 0.0 }).sqrt();
            // Padding gives infinities and NaN, for which this is false.
            entry[lane] = if (square > 0.0) & (distance > 0.0) { distance } else { f32::INFINITY };
        }
        entry
    }
}
