//! Rows of neighbours found by rays: count, scan, fill.

use super::{Bvh, Scene, bvh::tracing};
use crate::{Buffer, Gpu, gpu::trace, scan::Scan};
use nearfield_core::{ListKind, Result};
use nearfield_kernels::{
    Ptr, kernels,
    layouts::{ListRays, Rays},
};
use std::{ops::Range, sync::Arc};

/// What rows and neighbours are numbered by.
#[derive(Clone, Copy, Debug)]
pub enum RowNumbers {
    /// Places in memory.
    Place,
    /// Input indices, at the address of those of all places.
    Input(Ptr<u32>),
}

/// A neighbour list on the device.
pub struct ListBuffers {
    scan: Scan,
    count: Buffer<u32>,
    /// Row starts, `[n + 1]`.
    pub offset: Buffer<u64>,
    /// Neighbours of each row.
    pub index: Buffer<u32>,
    /// Periodic image of each neighbour; empty unless asked for.
    pub image: Buffer<u8>,
}

impl ListBuffers {
    /// An empty list.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            scan: Scan::new(gpu),
            count: Buffer::new(gpu, "row lengths"),
            offset: Buffer::new(gpu, "row starts"),
            index: Buffer::new(gpu, "the neighbour list"),
            image: Buffer::new(gpu, "images of the neighbour list"),
        }
    }

    /// Lists the neighbours at the present positions, with or without their images.
    ///
    /// # Errors
    /// [`nearfield_core::Error::OutOfMemory`], [`nearfield_core::Error::Device`].
    pub fn list(&mut self, bvh: &Bvh, scene: &Scene, kind: ListKind, numbers: RowNumbers, images: bool) -> Result<()> {
        let entries = self.count(bvh, scene, kind, numbers)? as usize;
        self.index.resize(entries)?;
        self.image.resize(if images { entries } else { 0 })?;
        self.fill(bvh, scene, kind, numbers, 0..scene.particles.n, 0)
    }

    /// Counts the entries of all rows and gives their sum; waits for the device.
    pub(super) fn count(&mut self, bvh: &Bvh, scene: &Scene, kind: ListKind, numbers: RowNumbers) -> Result<u64> {
        let n = scene.particles.n;
        self.count.resize(n as usize)?;
        self.count.zero()?;
        let parameters = self.parameters(bvh.rays(scene), kind, numbers, 0);
        // SAFETY: there is a count for each particle; the structure was updated for the scene.
        unsafe { trace(tracing(scene.gpu)?, kernels::RAY_COUNT, n, &parameters)? };
        self.scan.run_wide(&self.count, &mut self.offset)?;
        self.start_of(n)
    }

    /// Fills the rows of some places, the first of whose entries is entry `base` of all. Where radii are per particle,
    /// rows are filled all at once.
    pub(super) fn fill(
        &mut self,
        bvh: &Bvh,
        scene: &Scene,
        kind: ListKind,
        numbers: RowNumbers,
        places: Range<u32>,
        base: u64,
    ) -> Result<()> {
        let rays = Rays { first: places.start, ..bvh.rays(scene) };
        let parameters = self.parameters(rays, kind, numbers, base);
        // SAFETY: the list has room for as many entries as were counted, or the caller has made it for those of `places`.
        unsafe { trace(tracing(scene.gpu)?, kernels::RAY_FILL, places.len() as u32, &parameters) }
    }

    /// Where a row starts; waits for the device.
    pub(super) fn start_of(&self, row: u32) -> Result<u64> {
        Ok(self.offset.download_range(row as usize, 1)?[0])
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.scan.bytes() + self.count.bytes() + self.offset.bytes() + self.index.bytes() + self.image.bytes()
    }

    fn parameters(&self, rays: Rays, kind: ListKind, numbers: RowNumbers, base: u64) -> ListRays {
        ListRays {
            rays,
            id: match numbers {
                RowNumbers::Place => Ptr::NULL,
                RowNumbers::Input(id) => id,
            },
            count: self.count.ptr(),
            offset: self.offset.ptr(),
            index: self.index.ptr(),
            image: self.image.ptr(),
            base,
            half: u32::from(kind == ListKind::Half),
            unused: 0,
        }
    }
}
