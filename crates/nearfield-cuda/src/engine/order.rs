//! Memory order: particles that are near in space are kept near in memory.

use super::{state::State, survey::Bounds};
use crate::{Buffer, Gpu, gpu::launch, scan::Scan};
use nearfield_core::Result;
use nearfield_kernels::{kernels, layouts::MortonArgs};
use std::sync::Arc;

/// Steps between reorderings: locality decays slowly.
pub(crate) const INTERVAL: u64 = 100;

/// Most steps between surveys, each of which waits for the device; as many as above, doubled while nothing changes.
pub(crate) const LONGEST_PLAN: u64 = 16 * INTERVAL;

/// The order along the Morton curve, by one counting sort into as many cells as there are particles.
pub(crate) struct MortonOrder {
    gpu: Arc<dyn Gpu>,
    cell: Buffer<u32>,
    rank: Buffer<u32>,
    count: Buffer<u32>,
    start: Buffer<u32>,
    order: Buffer<u32>,
    scan: Scan,
}

impl MortonOrder {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        let buffer = || Buffer::new(gpu, "the Morton order");
        Self {
            gpu: gpu.clone(),
            cell: buffer(),
            rank: buffer(),
            count: buffer(),
            start: buffer(),
            order: buffer(),
            scan: Scan::new(gpu),
        }
    }

    /// The particle to put at each place.
    pub fn sort(&mut self, state: &State, bounds: &Bounds) -> Result<&Buffer<u32>> {
        let n = state.len();
        let bits = (n.max(1).ilog2() / 3).clamp(1, 10);
        let cells = 1usize << (3 * bits);
        for buffer in [&mut self.cell, &mut self.rank, &mut self.order] {
            buffer.resize(n)?;
        }
        self.count.resize(cells)?;
        self.count.zero()?;
        self.start.resize(cells + 1)?;
        let per_length = |axis: usize| {
            let per_length = (1u32 << bits) as f32 / (bounds.hi[axis] - bounds.lo[axis]);
            if per_length.is_finite() { per_length } else { 0.0 }
        };
        let arguments = MortonArgs {
            position: state.moving.position.ptr(),
            cell: self.cell.ptr(),
            rank: self.rank.ptr(),
            count: self.count.ptr(),
            start: self.start.ptr(),
            order: self.order.ptr(),
            lo: bounds.lo,
            per_length: [per_length(0), per_length(1), per_length(2)],
            bits,
            n: n as u32,
        };
        // SAFETY: arrays of n elements, of 8^bits cells, and one more for their starts.
        unsafe {
            launch(&*self.gpu, kernels::MORTON_COUNT, n as u64, &arguments)?;
            self.scan.run(&*self.gpu, &self.count, &mut self.start)?;
            launch(&*self.gpu, kernels::MORTON_SCATTER, n as u64, &arguments)?;
        }
        Ok(&self.order)
    }
}
