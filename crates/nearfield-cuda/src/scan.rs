//! Exclusive prefix sums.

use crate::{
    Buffer, Gpu,
    gpu::{Queue, launch},
};
use nearfield_core::Result;
use nearfield_kernels::{Kernel, Ptr, kernels, layouts::ScanArgs};
use std::sync::Arc;

/// Buffers of the scan kernels.
pub(crate) struct Scan {
    tiles: Buffer<u64>,
}

impl Scan {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self { tiles: Buffer::new(gpu, "prefix sums") }
    }

    /// Sums of the counts before each, and of all at the end.
    pub fn run(&mut self, queue: &dyn Queue, counts: &Buffer<u32>, sums: &mut Buffer<u32>) -> Result<()> {
        self.state(counts.len())?;
        self.tiles.zero_by(queue)?;
        self.run_from_zero(queue, counts, sums)
    }

    /// The same in 64 bits.
    pub fn run_wide(&mut self, queue: &dyn Queue, counts: &Buffer<u32>, sums: &mut Buffer<u64>) -> Result<()> {
        sums.resize(counts.len() + 1)?;
        self.state(counts.len())?;
        self.tiles.zero_by(queue)?;
        self.enqueue(queue, kernels::SCAN_U64, counts, sums.ptr().address())
    }

    /// The state of a scan of `n` counts, which must be zero before [`Scan::run_from_zero`].
    pub fn state(&mut self, n: usize) -> Result<&Buffer<u64>> {
        self.tiles.resize_with_room(n / kernels::SCAN_TILE + 2)?;
        Ok(&self.tiles)
    }

    /// As [`Scan::run`], by a state that is zero.
    pub fn run_from_zero(&self, queue: &dyn Queue, counts: &Buffer<u32>, sums: &mut Buffer<u32>) -> Result<()> {
        sums.resize(counts.len() + 1)?;
        self.enqueue(queue, kernels::SCAN_U32, counts, sums.ptr().address())
    }

    fn enqueue(&self, queue: &dyn Queue, kernel: Kernel<ScanArgs>, counts: &Buffer<u32>, output: u64) -> Result<()> {
        let arguments = ScanArgs {
            input: counts.ptr(),
            output: Ptr::new(output),
            tiles: self.tiles.ptr(),
            n: counts.len() as u32,
            unused: 0,
        };
        let tiles = self.tiles.len() as u64 - 1;
        // SAFETY: one more sum than counts, one more state than tiles.
        unsafe { launch(queue, kernel, tiles * u64::from(kernel.threads), &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tiles.bytes()
    }
}
