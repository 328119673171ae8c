//! How far particles have moved from remembered positions.

use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::Result;
use nearfield_kernels::{
    Float4, kernels,
    layouts::{Box3, MotionArgs, Particles},
};
use std::sync::Arc;

/// Positions at some earlier time, in the memory order of then.
pub(crate) struct Reference {
    gpu: Arc<dyn Gpu>,
    position: Buffer<Float4>,
    image: Buffer<i32>,
    moved: Buffer<u64>,
}

/// Distances moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moved {
    /// The largest, never understated.
    pub largest: f64,
    /// The mean over particles of distance over radius.
    pub mean_over_radius: f64,
}

impl Reference {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            gpu: gpu.clone(),
            position: Buffer::new(gpu, "remembered positions"),
            image: Buffer::new(gpu, "remembered image counts"),
            moved: Buffer::new(gpu, "distances moved"),
        }
    }

    /// Remembers the present. Particles must keep their places until the next time.
    pub fn set(&mut self, particles: &Particles) -> Result<()> {
        let n = particles.n as usize;
        self.position.resize(n)?;
        self.image.resize(3 * n)?;
        if n == 0 {
            return Ok(());
        }
        // SAFETY: the particles' arrays have n and 3 n elements, as have these.
        unsafe {
            self.gpu.copy(particles.position.address(), self.position.ptr().address(), n * size_of::<Float4>())?;
            self.gpu.copy(particles.image.address(), self.image.ptr().address(), 3 * n * size_of::<i32>())
        }
    }

    /// How far particles are from the remembered positions, and by their radius or the one `cutoff`, which is zero where
    /// radii are per particle; waits for the device.
    pub fn moved(&mut self, particles: &Particles, space: &Box3, cutoff: f32) -> Result<Moved> {
        self.moved.resize(2)?;
        self.moved.zero()?;
        let arguments = MotionArgs {
            particles: *particles,
            length: space.length,
            cutoff,
            position: self.position.ptr(),
            image: self.image.ptr(),
            moved: self.moved.ptr(),
        };
        // SAFETY: the remembered arrays have n elements each, as `set` made them.
        unsafe { launch(&*self.gpu, kernels::MOTION, u64::from(particles.n), &arguments)? };
        let moved = self.moved.download()?;
        let n = f64::from(particles.n.max(1));
        Ok(Moved {
            largest: f64::from(f32::from_bits(moved[0] as u32)).sqrt(),
            mean_over_radius: moved[1] as f64 / 1_048_576.0 / n,
        })
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.position.bytes() + self.image.bytes() + self.moved.bytes()
    }
}
