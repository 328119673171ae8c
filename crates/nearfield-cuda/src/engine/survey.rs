//! Where the particles are: their bounds, and a sample of their positions for choices that depend on how they lie.

use super::state::State;
use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::Result;
use nearfield_kernels::{
    Float4, kernels,
    layouts::{BoundsArgs, SampleArgs},
};
use std::sync::Arc;

/// Largest sample.
const SAMPLE: usize = 8192;

/// Most blocks that look for bounds.
const MAX_BLOCKS: u64 = 1024;

/// Corners of the box around all particles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bounds {
    pub lo: [f32; 3],
    pub hi: [f32; 3],
}

/// What is known of the particles' places.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sample {
    /// Number of particles.
    pub n: usize,
    /// Of all of them.
    pub bounds: Bounds,
    /// Positions, with radii in w, at even strides through memory.
    pub positions: Vec<Float4>,
}

/// Buffers of surveys.
pub(crate) struct Surveyor {
    gpu: Arc<dyn Gpu>,
    bounds: Buffer<u32>,
    sample: Buffer<Float4>,
}

impl Surveyor {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self { gpu: gpu.clone(), bounds: Buffer::new(gpu, "bounds"), sample: Buffer::new(gpu, "a sample") }
    }

    /// Looks at the present positions; waits for the device.
    pub fn survey(&mut self, state: &State) -> Result<Sample> {
        let n = state.len();
        if n == 0 {
            return Ok(Sample::default());
        }
        self.bounds.upload(&[u32::MAX, u32::MAX, u32::MAX, 0, 0, 0])?;
        self.sample.resize(n.min(SAMPLE))?;
        let position = state.moving.position.ptr();
        let bounds = BoundsArgs { position, bounds: self.bounds.ptr(), n: n as u64 };
        let sample =
            SampleArgs { position, sample: self.sample.ptr(), n: n as u64, n_sampled: self.sample.len() as u64 };
        let threads = (n as u64).min(MAX_BLOCKS * u64::from(kernels::BOUNDS.threads));
        // SAFETY: positions are n, the sample is as long as said, bounds are six numbers.
        unsafe {
            launch(&*self.gpu, kernels::BOUNDS, threads, &bounds)?;
            launch(&*self.gpu, kernels::SAMPLE, self.sample.len() as u64, &sample)?;
        }
        let corners = self.bounds.download()?;
        let corner = |first: usize| [0, 1, 2].map(|axis| from_ordered_bits(corners[first + axis]));
        Ok(Sample { n, bounds: Bounds { lo: corner(0), hi: corner(3) }, positions: self.sample.download()? })
    }
}

/// The float of integers that are ordered as floats are (`ordered_bits` of the kernels).
fn from_ordered_bits(bits: u32) -> f32 {
    f32::from_bits(if bits & 0x8000_0000 != 0 { bits ^ 0x8000_0000 } else { !bits })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordered_bits_are_the_floats() {
        assert_eq!(from_ordered_bits(2.5f32.to_bits() | 0x8000_0000), 2.5);
        assert_eq!(from_ordered_bits(!(-2.5f32).to_bits()), -2.5);
    }
}
