//! The particles on the device, in memory order.

use crate::{
    Buffer, Gpu,
    gpu::{Queue, launch},
};
use nearfield_core::{Error, Particles, Radii, Result, System};
use nearfield_kernels::{
    Float4, Ptr, kernels,
    layouts::{self, ClusterControl, PermuteArgs, SortArgs, SortParticlesArgs},
};
use std::sync::Arc;

/// State of N particles; `id` leads back to input order, `place` from there.
pub(crate) struct State {
    gpu: Arc<dyn Gpu>,
    pub moving: Moving,
    pub id: Buffer<u32>,
    pub place: Buffer<u32>,
    /// For permutations.
    spare: Moving,
    spare_id: Buffer<u32>,
}

/// What changes in a step.
pub(crate) struct Moving {
    /// Position; w is the radius where radii are per particle.
    pub position: Buffer<Float4>,
    /// Velocity; the bits of w are the type.
    pub velocity: Buffer<Float4>,
    /// Box crossings, `[n][3]`.
    pub image: Buffer<i32>,
}

impl Moving {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            position: Buffer::new(gpu, "positions"),
            velocity: Buffer::new(gpu, "velocities"),
            image: Buffer::new(gpu, "image counts"),
        }
    }

    pub fn resize(&mut self, n: usize) -> Result<()> {
        self.position.resize(n)?;
        self.velocity.resize(n)?;
        self.image.resize(3 * n)
    }

    pub fn bytes(&self) -> u64 {
        self.position.bytes() + self.velocity.bytes() + self.image.bytes()
    }
}

impl State {
    pub fn new(gpu: &Arc<dyn Gpu>, system: &System) -> Result<Self> {
        let particles = &system.particles;
        let n = particles.len();
        if u32::try_from(n).is_err() {
            return Err(Error::TooManyParticles(n));
        }
        let mut state = Self {
            gpu: gpu.clone(),
            moving: Moving::new(gpu),
            id: Buffer::new(gpu, "particle numbers"),
            place: Buffer::new(gpu, "places of particles"),
            spare: Moving::new(gpu),
            spare_id: Buffer::new(gpu, "particle numbers"),
        };
        let radius = |i: usize| match &system.radii {
            Radii::Uniform(_) => 0.0,
            Radii::PerParticle(radii) => radii[i],
        };
        let position = |i: usize| {
            let [x, y, z] = particles.position.get(i);
            Float4::new(x, y, z, radius(i))
        };
        let velocity = |i: usize| {
            let [x, y, z] = particles.velocity.get(i);
            Float4::new(x, y, z, f32::from_bits(particles.kind[i]))
        };
        let ids: Vec<u32> = (0..n as u32).collect();
        state.moving.position.upload(&(0..n).map(position).collect::<Vec<_>>())?;
        state.moving.velocity.upload(&(0..n).map(velocity).collect::<Vec<_>>())?;
        state.moving.image.upload(particles.image.as_flattened())?;
        state.id.upload(&ids)?;
        state.place.upload(&ids)?;
        Ok(state)
    }

    pub fn len(&self) -> usize {
        self.id.len()
    }

    pub fn gpu(&self) -> &Arc<dyn Gpu> {
        &self.gpu
    }

    /// Addresses for kernels.
    pub fn particles(&self) -> layouts::Particles {
        layouts::Particles {
            position: self.moving.position.ptr(),
            velocity: self.moving.velocity.ptr(),
            image: self.moving.image.ptr(),
            id: self.id.ptr(),
            n: self.len() as u32,
            unused: 0,
        }
    }

    /// Puts particle `order[k]` at place k, forces too where there are any.
    pub fn permute(&mut self, queue: &dyn Queue, order: Ptr<u32>, force: &mut Buffer<Float4>) -> Result<()> {
        let mut sorted_force = Buffer::new(&self.gpu, "forces");
        sorted_force.resize(force.len())?;
        let to = self.spare_particles()?;
        let arguments = PermuteArgs {
            from: self.particles(),
            to,
            force: [force.ptr(), sorted_force.ptr()],
            order,
            place: self.place.ptr(),
        };
        // SAFETY: all arrays have n elements, forces n or none; `order` is the caller's permutation of n.
        unsafe { launch(queue, kernels::PERMUTE, self.len() as u64, &arguments)? };
        self.take_spare();
        *force = sorted_force;
        Ok(())
    }

    /// Puts particles in the order of cells, by a sort of their positions that has been counted, and ends the list of
    /// `control`.
    pub fn sort(&mut self, queue: &dyn Queue, sort: SortArgs, control: Ptr<ClusterControl>) -> Result<()> {
        let to = self.spare_particles()?;
        let arguments = SortParticlesArgs { sort, from: self.particles(), to, place: self.place.ptr(), control };
        // SAFETY: all arrays have n elements.
        unsafe { launch(queue, kernels::SORT_PARTICLES, self.len().max(1) as u64, &arguments)? };
        self.take_spare();
        Ok(())
    }

    /// Where particles can be put.
    fn spare_particles(&mut self) -> Result<layouts::Particles> {
        let n = self.len();
        self.spare.resize(n)?;
        self.spare_id.resize(n)?;
        Ok(layouts::Particles {
            position: self.spare.position.ptr(),
            velocity: self.spare.velocity.ptr(),
            image: self.spare.image.ptr(),
            id: self.spare_id.ptr(),
            n: n as u32,
            unused: 0,
        })
    }

    /// What was put there are the particles from now on.
    fn take_spare(&mut self) {
        std::mem::swap(&mut self.moving, &mut self.spare);
        std::mem::swap(&mut self.id, &mut self.spare_id);
    }

    /// Copies positions, velocities, types and image counts to the host in input order.
    pub fn copy_to(&self, particles: &mut Particles) -> Result<()> {
        let n = self.len();
        particles.position.resize(n);
        particles.velocity.resize(n);
        particles.image.resize(n, [0; 3]);
        particles.kind.resize(n, 0);
        let (position, velocity) = (self.moving.position.download()?, self.moving.velocity.download()?);
        let (image, id) = (self.moving.image.download()?, self.id.download()?);
        for (i, &id) in id.iter().enumerate() {
            let id = id as usize;
            particles.position.set(id, [position[i].x, position[i].y, position[i].z]);
            particles.velocity.set(id, [velocity[i].x, velocity[i].y, velocity[i].z]);
            particles.kind[id] = velocity[i].w.to_bits();
            particles.image[id] = [image[3 * i], image[3 * i + 1], image[3 * i + 2]];
        }
        Ok(())
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.moving.bytes() + self.spare.bytes() + self.id.bytes() + self.spare_id.bytes() + self.place.bytes()
    }
}
