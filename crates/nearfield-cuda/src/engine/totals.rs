//! Sums over particles, and what went wrong on the way.

use crate::{Buffer, Gpu, gpu::launch};
use bytemuck::Zeroable;
use nearfield_core::{Interaction, Quantities, Result, Totals};
use nearfield_kernels::{
    kernels,
    layouts::{self, Status, TotalSums, TotalsArgs},
};
use std::sync::Arc;

/// Most blocks that sum; fixed by the number of particles, so that sums are the same from run to run.
const MAX_BLOCKS: u64 = 1024;

/// Buffers of the sums.
pub(crate) struct Totalizer {
    gpu: Arc<dyn Gpu>,
    mass: Buffer<f64>,
    sums: Buffer<TotalSums>,
    status: Buffer<Status>,
}

/// What a failure is of: `step << 32 | id` in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub step: u64,
    pub particle: u32,
}

impl Failure {
    fn of(bits: u64) -> Option<Self> {
        (bits != u64::MAX).then_some(Self { step: bits >> 32, particle: bits as u32 })
    }
}

/// What went wrong first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Failures {
    pub force: Option<Failure>,
    pub position: Option<Failure>,
}

impl Totalizer {
    pub fn new(gpu: &Arc<dyn Gpu>, interaction: &Interaction) -> Result<Self> {
        let mut totalizer = Self {
            gpu: gpu.clone(),
            mass: Buffer::new(gpu, "masses"),
            sums: Buffer::new(gpu, "partial sums"),
            status: Buffer::new(gpu, "the status"),
        };
        totalizer.mass.upload(&interaction.types.iter().map(|t| f64::from(t.mass)).collect::<Vec<_>>())?;
        totalizer.status.resize(1)?;
        totalizer.status.fill(0xff)?;
        Ok(totalizer)
    }

    /// The status for kernels.
    pub fn status(&self) -> &Buffer<Status> {
        &self.status
    }

    /// Enqueues the sums over all particles; null results are left out. The forces belong to `step`.
    pub fn enqueue(
        &mut self,
        particles: layouts::Particles,
        place: &Buffer<u32>,
        results: layouts::Results,
        step: u64,
    ) -> Result<()> {
        let blocks = u64::from(particles.n).div_ceil(u64::from(kernels::TOTALS.threads)).clamp(1, MAX_BLOCKS);
        self.sums.resize(blocks as usize + 1)?;
        let arguments = TotalsArgs {
            particles,
            place: place.ptr(),
            mass: self.mass.ptr(),
            results,
            sums: self.sums.ptr(),
            status: self.status.ptr(),
            step,
        };
        let of_blocks = TotalsArgs { particles: layouts::Particles { n: blocks as u32, ..particles }, ..arguments };
        // SAFETY: one sum a block and one for all; the arrays of particles have n elements each.
        unsafe {
            launch(&*self.gpu, kernels::TOTALS, blocks * u64::from(kernels::TOTALS.threads), &arguments)?;
            launch(&*self.gpu, kernels::TOTALS_OF_BLOCKS, u64::from(kernels::TOTALS_OF_BLOCKS.threads), &of_blocks)
        }
    }

    /// Address of the sum over all, once enqueued.
    pub fn sum(&self) -> nearfield_kernels::Ptr<TotalSums> {
        nearfield_kernels::Ptr::new(self.sums.ptr().address() + ((self.sums.len() - 1) * size_of::<TotalSums>()) as u64)
    }

    /// Reads the sums and what went wrong, which is then forgotten.
    pub fn read(&mut self, quantities: Quantities) -> Result<(Totals, Failures)> {
        let sum = self.sums.download_range(self.sums.len() - 1, 1)?.pop().unwrap_or_else(TotalSums::zeroed);
        let status = self.status.download()?.pop().unwrap_or_else(Status::zeroed);
        let failures = Failures { force: Failure::of(status.force), position: Failure::of(status.position) };
        if failures.force.is_some() || failures.position.is_some() {
            self.status.fill(0xff)?;
        }
        let mut totals = Totals {
            kinetic_energy: sum.kinetic,
            momentum: sum.momentum,
            max_force: sum.max_force2.sqrt(),
            ..Totals::default()
        };
        if quantities.energy {
            totals.potential_energy = sum.potential;
            totals.virial = sum.virial;
            totals.pairs = sum.neighbors / 2;
        }
        Ok((totals, failures))
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.mass.bytes() + self.sums.bytes() + self.status.bytes()
    }
}
