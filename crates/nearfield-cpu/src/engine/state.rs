//! The particles on the device, in memory order.

use crate::{Input, InputRadii, cluster::Moving, exact_sum::exact_sum, physics::Physics};
use nearfield_core::{ParticleType, Particles, Radii, System, Vec3s};
use rayon::prelude::*;

/// State of N particles, each array `[N]` in memory order; `id` leads back to input order.
#[derive(Debug, Default)]
pub(super) struct State {
    pub position: Vec3s,
    pub velocity: Vec3s,
    pub image: Vec<[i32; 3]>,
    /// Types; empty when there is only one.
    pub kind: Vec<u32>,
    /// Radii; empty when uniform.
    pub radius: Vec<f32>,
    /// Input index of each particle.
    pub id: Vec<u32>,
    spare: Spare,
}

/// Arrays to put particles in another order into.
#[derive(Debug, Default)]
struct Spare {
    floats: Vec<f32>,
    images: Vec<[i32; 3]>,
    numbers: Vec<u32>,
}

impl State {
    pub fn new(system: &System) -> Self {
        let particles = &system.particles;
        Self {
            position: particles.position.clone(),
            velocity: particles.velocity.clone(),
            image: particles.image.clone(),
            kind: if system.interaction.types.len() > 1 { particles.kind.clone() } else { Vec::new() },
            radius: match &system.radii {
                Radii::Uniform(_) => Vec::new(),
                Radii::PerParticle(radii) => radii.clone(),
            },
            id: (0..particles.len() as u32).collect(),
            spare: Spare::default(),
        }
    }

    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Type of particle `i`.
    #[inline(always)]
    pub fn kind(&self, i: usize) -> u32 {
        self.kind.get(i).copied().unwrap_or(0)
    }

    /// Mass of particle `i`.
    #[inline(always)]
    pub fn mass(&self, i: usize, types: &[ParticleType]) -> f64 {
        f64::from(types[self.kind(i) as usize].mass)
    }

    /// Kinetic energy of particle `i`.
    #[inline(always)]
    pub fn kinetic_energy_of(&self, i: usize, types: &[ParticleType]) -> f64 {
        let squared: f64 = self.velocity.get(i).iter().map(|&v| f64::from(v).powi(2)).sum();
        0.5 * self.mass(i, types) * squared
    }

    /// Kinetic energy of all particles, independent of their order.
    pub fn kinetic_energy(&self, types: &[ParticleType]) -> f64 {
        exact_sum(self.len(), |i| self.kinetic_energy_of(i, types))
    }

    /// Number of particles of a type.
    pub fn count(&self, kind: u32) -> usize {
        if self.kind.is_empty() { self.len() } else { self.kind.iter().filter(|&&k| k == kind).count() }
    }

    /// Mean square of a component of the velocities of a type, independent of the particles' order; zero without any.
    pub fn velocity2(&self, kind: u32) -> f64 {
        let square = |i| {
            if self.kind(i) == kind { self.velocity.get(i).iter().map(|&v| f64::from(v).powi(2)).sum() } else { 0.0 }
        };
        exact_sum(self.len(), square) / (3 * self.count(kind).max(1)) as f64
    }

    /// The particles as a structure's input, with the radii that the structure shall cover.
    pub fn input<'a>(&'a self, physics: &'a Physics, radii: InputRadii<'a>) -> Input<'a> {
        let [x, y, z] = self.position.axes();
        Input { sim_box: &physics.sim_box, position: [x, y, z], radii, kind: &self.kind }
    }

    /// What cluster pairs need to know of the particles, which move by steps of `dt`, the last `force` on them, where it
    /// is known, among it.
    pub fn moving_slices<'a>(&'a self, force: Option<&'a Vec3s>, types: &'a [ParticleType], dt: f32) -> Moving<'a> {
        Moving {
            position: self.position.axes().map(|axis| &axis[..]),
            velocity: self.velocity.axes().map(|axis| &axis[..]),
            force: force.map_or([&[]; 3], |force| force.axes().map(|axis| &axis[..])),
            kind: &self.kind,
            types,
            dt,
        }
    }

    /// The particles' own radii.
    pub fn radii<'a>(&'a self, physics: &Physics) -> InputRadii<'a> {
        match physics.radii {
            Radii::Uniform(r) => InputRadii::Uniform(r),
            Radii::PerParticle(_) => InputRadii::PerParticle(&self.radius),
        }
    }

    /// Puts particle `order[k]` at place k.
    pub fn reorder(&mut self, order: &[u32]) {
        let Spare { floats, images, numbers } = &mut self.spare;
        for vectors in [&mut self.position, &mut self.velocity] {
            for axis in vectors.axes_mut() {
                permute(axis, floats, order);
            }
        }
        permute(&mut self.image, images, order);
        permute(&mut self.kind, numbers, order);
        permute(&mut self.radius, floats, order);
        permute(&mut self.id, numbers, order);
    }

    /// Copies positions, velocities and images out in input order.
    pub fn copy_to(&self, particles: &mut Particles) {
        let n = self.len();
        particles.position.resize(n);
        particles.velocity.resize(n);
        particles.image.resize(n, [0; 3]);
        particles.kind.resize(n, 0);
        for (i, &id) in self.id.iter().enumerate() {
            let id = id as usize;
            particles.position.set(id, self.position.get(i));
            particles.velocity.set(id, self.velocity.get(i));
            particles.image[id] = self.image[i];
            particles.kind[id] = self.kind(i);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let Spare { floats, images, numbers } = &self.spare;
        self.id.capacity() * (6 * 4 + 12 + 4)
            + 4 * (self.kind.capacity() + self.radius.capacity() + floats.capacity() + numbers.capacity())
            + 12 * images.capacity()
    }
}

/// Puts value `order[k]` at place k, by way of `spare`, which then holds what was there.
pub(super) fn permute<T: Copy + Send + Sync>(values: &mut Vec<T>, spare: &mut Vec<T>, order: &[u32]) {
    if !values.is_empty() {
        order.par_iter().with_min_len(4096).map(|&i| values[i as usize]).collect_into_vec(spare);
        std::mem::swap(values, spare);
    }
}
