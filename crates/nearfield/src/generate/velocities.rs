//! Maxwell-Boltzmann velocities.

use super::random::{Stream, generator};
use nearfield_core::Vec3s;
use rand_distr::{Distribution, StandardNormal};

/// Velocities of particles of types `kind` with `masses[kind]`, drawn at `temperature` (k_B = 1), freed of total
/// momentum and scaled so that T = 2 KE / (3 N - 3) is `temperature` up to f32 rounding. Zero for one particle, which
/// has no velocity relative to its centre of mass.
///
/// # Panics
/// When a type has no mass in `masses`.
pub fn velocities(kind: &[u32], masses: &[f64], temperature: f64, seed: u64) -> Vec3s {
    let n = kind.len();
    if n < 2 || temperature == 0.0 {
        return Vec3s::zeros(n);
    }
    let mass = |i: usize| masses[kind[i] as usize];
    let mut rng = generator(seed, Stream::Velocities);
    let mut velocity: Vec<[f64; 3]> = (0..n)
        .map(|i| std::array::from_fn(|_| -> f64 { StandardNormal.sample(&mut rng) }).map(|v| v / mass(i).sqrt()))
        .collect();

    let total_mass: f64 = (0..n).map(mass).sum();
    let drift: [f64; 3] =
        std::array::from_fn(|axis| (0..n).map(|i| mass(i) * velocity[i][axis]).sum::<f64>() / total_mass);
    let mut twice_kinetic = 0.0;
    for (i, v) in velocity.iter_mut().enumerate() {
        *v = std::array::from_fn(|axis| v[axis] - drift[axis]);
        twice_kinetic += mass(i) * v.iter().map(|v| v * v).sum::<f64>();
    }
    let scale = (temperature * (3 * n - 3) as f64 / twice_kinetic).sqrt();
    velocity.iter().map(|v| v.map(|component| (component * scale) as f32)).collect()
}

/// T = 2 KE / (3 N - 3), summed in f64; zero for fewer than two particles.
pub fn temperature(velocity: &Vec3s, kind: &[u32], masses: &[f64]) -> f64 {
    let twice_kinetic: f64 = velocity
        .iter()
        .zip(kind)
        .map(|(v, &kind)| masses[kind as usize] * v.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>())
        .sum();
    if kind.len() < 2 { 0.0 } else { twice_kinetic / (3 * kind.len() - 3) as f64 }
}
