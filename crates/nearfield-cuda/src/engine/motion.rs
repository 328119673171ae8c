//! How far particles have moved from remembered positions.

use super::{physics::Physics, state::State};
use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::Result;
use nearfield_kernels::{Float4, kernels, layouts::MotionArgs};
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
    pub fn set(&mut self, state: &State) -> Result<()> {
        self.position.copy_from(&state.moving.position)?;
        self.image.copy_from(&state.moving.image)
    }

    /// Image counts then, for shifts of a stored list.
    pub fn image(&self) -> &Buffer<i32> {
        &self.image
    }

    /// How far particles are from the remembered positions; waits for the device.
    pub fn moved(&mut self, state: &State, physics: &Physics) -> Result<Moved> {
        self.moved.resize(2)?;
        self.moved.zero()?;
        let arguments = MotionArgs {
            particles: state.particles(),
            length: physics.space.length,
            cutoff: physics.cutoff.unwrap_or(0.0),
            position: self.position.ptr(),
            image: self.image.ptr(),
            moved: self.moved.ptr(),
        };
        // SAFETY: the remembered arrays have n elements each, as `set` made them.
        unsafe { launch(&*self.gpu, kernels::MOTION, state.len() as u64, &arguments)? };
        let moved = self.moved.download()?;
        let n = state.len().max(1) as f64;
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
