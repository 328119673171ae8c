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
        sums.resize(counts.len() + 1)?;
        self.enqueue(queue, kernels::SCAN_U32, counts, sums.ptr().address())
    }

    /// The same in 64 bits.
    pub fn run_wide(&mut self, queue: &dyn Queue, counts: &Buffer<u32>, sums: &mut Buffer<u64>) -> Result<()> {
        sums.resize(counts.len() + 1)?;
        self.enqueue(queue, kernels::SCAN_U64, counts, sums.ptr().address())
    }

    fn enqueue(
        &mut self,
        queue: &dyn Queue,
        kernel: Kernel<ScanArgs>,
        counts: &Buffer<u32>,
        output: u64,
    ) -> Result<()> {
        let tiles = counts.len() / kernels::SCAN_TILE + 1;
        self.tiles.resize_with_room(tiles + 1)?;
        self.tiles.zero_by(queue)?;
        let arguments = ScanArgs {
            input: counts.ptr(),
            output: Ptr::new(output),
            tiles: self.tiles.ptr(),
            n: counts.len() as u32,
            unused: 0,
        };
        // SAFETY: one more sum than counts, one more state than tiles.
        unsafe { launch(queue, kernel, tiles as u64 * u64::from(kernel.threads), &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tiles.bytes()
    }
}
