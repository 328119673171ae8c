//! Neighbour lists in device memory: counted, scanned, filled.

use crate::{Buffer, Gpu, scan::Scan};
use nearfield_core::Result;
use nearfield_kernels::layouts::StagingControl;
use std::sync::Arc;

/// A neighbour list on the device in compressed sparse rows.
pub struct DeviceList {
    gpu: Arc<dyn Gpu>,
    scan: Scan,
    /// Entries of each row, which kernels count and, where several write a row, count down again as they fill it.
    pub(crate) count: Buffer<u32>,
    /// Input index of each slot's particle, where lists are made by cells.
    pub(crate) number: Buffer<u32>,
    /// Rows before they are at their places, where that is shorter than to search twice.
    pub(crate) staging: Staging,
    /// Row starts, `[n + 1]`.
    pub offset: Buffer<u64>,
    /// Neighbours, in no particular order within a row.
    pub index: Buffer<u32>,
    /// Whether one search found the rows: short ones are kept elsewhere until their places are known.
    pub at_once: bool,
    /// Periodic image of each neighbour, `(x + 1) + 3 (y + 1) + 9 (z + 1)` box lengths away; empty unless asked for.
    pub image: Buffer<u8>,
}

impl DeviceList {
    /// Without rows yet.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            gpu: gpu.clone(),
            scan: Scan::new(gpu),
            count: Buffer::new(gpu, "neighbour counts"),
            number: Buffer::new(gpu, "input indices in cell order"),
            staging: Staging::new(gpu),
            offset: Buffer::new(gpu, "row starts"),
            index: Buffer::new(gpu, "the neighbour list"),
            at_once: false,
            image: Buffer::new(gpu, "images of the neighbour list"),
        }
    }

    /// Zeroes the counts of `n` rows.
    pub(crate) fn start(&mut self, n: usize) -> Result<()> {
        self.count.resize(n)?;
        self.count.zero()
    }

    /// Sums the counts into row starts and gives the number of entries; waits for the device.
    pub(crate) fn place_rows(&mut self) -> Result<u64> {
        self.scan_rows()?;
        self.start_of(self.count.len())
    }

    /// Enqueues the sums of the counts, which are row starts.
    pub(crate) fn scan_rows(&mut self) -> Result<()> {
        self.scan.run_wide(&*self.gpu, &self.count, &mut self.offset)
    }

    /// Makes room for entries.
    pub(crate) fn make_room(&mut self, entries: u64, images: bool) -> Result<()> {
        self.index.resize_with_room(entries as usize)?;
        self.image.resize_with_room(if images { entries as usize } else { 0 })
    }

    /// Where a row starts; waits for the device.
    pub(crate) fn start_of(&self, row: usize) -> Result<u64> {
        Ok(self.offset.download_range(row, 1)?[0])
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        let of_rows = self.count.bytes() + self.number.bytes() + self.offset.bytes();
        self.scan.bytes() + of_rows + self.staging.bytes() + self.index.bytes() + self.image.bytes()
    }
}

/// Rows that were found before it was known how long others are.
pub(crate) struct Staging {
    /// Neighbours, those of a row together.
    pub staged: Buffer<u32>,
    /// Where each row begins there.
    pub start: Buffer<u64>,
    pub control: Buffer<StagingControl>,
    /// Whether there was too little room once: it is not tried again.
    pub overflowed: bool,
}

impl Staging {
    fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            staged: Buffer::new(gpu, "rows of the neighbour list"),
            start: Buffer::new(gpu, "rows of the neighbour list"),
            control: Buffer::new(gpu, "rows of the neighbour list"),
            overflowed: false,
        }
    }

    fn bytes(&self) -> u64 {
        self.staged.bytes() + self.start.bytes() + self.control.bytes()
    }
}
