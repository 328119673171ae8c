//! Random points on a sphere, the non-uniform test case of paper B (appendix, code 2).
//!
//! The paper draws theta = 2 pi u and phi = acos(1 - 2 u'); Marsaglia's method gives the same distribution without
//! trigonometric functions, whose rounding differs between platforms.

use super::{
    inside,
    random::{Stream, generator},
};
use nearfield_core::{SimBox, Vec3s};
use rand_distr::{Distribution, UnitSphere};

/// `n` independent points, uniform on the largest sphere inside the box, about its middle. In a box of length 2 it is
/// the paper's unit sphere.
pub fn sphere_surface(n: usize, sim_box: &SimBox, seed: u64) -> Vec3s {
    let mut rng = generator(seed, Stream::Positions);
    let (lo, lengths) = (sim_box.lo().map(f64::from), sim_box.lengths().map(f64::from));
    let radius = 0.5 * lengths.iter().copied().fold(f64::INFINITY, f64::min);
    (0..n)
        .map(|_| {
            let direction: [f64; 3] = UnitSphere.sample(&mut rng);
            std::array::from_fn(|axis| inside(sim_box, axis, lo[axis] + 0.5 * lengths[axis] + radius * direction[axis]))
        })
        .collect()
}

/// The cutoff paper B uses on the unit sphere for about `neighbors` neighbours a particle: acos(1 - 2 neighbors / n),
/// with neighbors = 9 p at p particles a cell. It is the angle of the cap that holds them; the distance between
/// points at that angle is the chord 2 sin(cutoff / 2), so the mean number is slightly larger than asked for.
pub fn sphere_surface_cutoff(n: usize, neighbors: f64) -> f64 {
    (1.0 - 2.0 * neighbors / n as f64).clamp(-1.0, 1.0).acos()
}
