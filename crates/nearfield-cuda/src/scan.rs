//! Exclusive prefix sums.

use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::Result;
use nearfield_kernels::{Kernel, Layout, Ptr, kernels, layouts::ScanArgs};
use std::sync::Arc;

/// Buffers of the scan kernels.
pub(crate) struct Scan {
    gpu: Arc<dyn Gpu>,
    tiles: Buffer<u64>,
}

impl Scan {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self { gpu: gpu.clone(), tiles: Buffer::new(gpu, "prefix sums") }
    }

    /// Sums of the counts before each, and of all at the end.
    pub fn run(&mut self, counts: &Buffer<u32>, sums: &mut Buffer<u32>) -> Result<()> {
        sums.resize(counts.len() + 1)?;
        self.enqueue(kernels::SCAN_U32, counts, sums.ptr().address())
    }

    /// The same in 64 bits.
    pub fn run_wide(&mut self, counts: &Buffer<u32>, sums: &mut Buffer<u64>) -> Result<()> {
        sums.resize(counts.len() + 1)?;
        self.enqueue(kernels::SCAN_U64, counts, sums.ptr().address())
    }

    fn enqueue(&mut self, kernel: Kernel<ScanArgs>, counts: &Buffer<u32>, output: u64) -> Result<()>
    where
        ScanArgs: Layout,
    {
        let tiles = counts.len() / kernels::SCAN_TILE + 1;
        self.tiles.resize_with_room(tiles + 1)?;
        self.tiles.zero()?;
        let arguments = ScanArgs {
            input: counts.ptr(),
            output: Ptr::new(output),
            tiles: self.tiles.ptr(),
            n: counts.len() as u32,
            unused: 0,
        };
        // SAFETY: one more sum than counts, one more state than tiles.
        unsafe { launch(&*self.gpu, kernel, tiles as u64 * u64::from(kernel.threads), &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.tiles.bytes()
    }
}
