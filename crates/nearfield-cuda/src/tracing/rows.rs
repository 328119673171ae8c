//! Rows of neighbours found by rays: count, scan, fill.

use super::{Bvh, Scene, bvh::tracing};
use crate::{DeviceList, gpu::trace};
use nearfield_core::{ListKind, Result};
use nearfield_kernels::{
    Ptr,
    layouts::{ListRays, Rays},
};
use std::ops::Range;

/// What rows and neighbours are numbered by.
#[derive(Clone, Copy, Debug)]
pub enum RowNumbers {
    /// Places in memory.
    Place,
    /// Input indices, at the address of those of all places.
    Input(Ptr<u32>),
}

/// Which rows are made.
#[derive(Clone, Copy, Debug)]
pub struct RowQuery {
    /// Full rows, or only neighbours of larger number.
    pub kind: ListKind,
    /// What numbers are.
    pub numbers: RowNumbers,
}

impl Bvh {
    /// Counts the neighbours of all particles.
    ///
    /// # Errors
    /// [`nearfield_core::Error::OutOfMemory`], [`nearfield_core::Error::Device`].
    pub fn count(&self, scene: &Scene, query: RowQuery, list: &mut DeviceList) -> Result<()> {
        let n = scene.particles.n;
        list.start(n as usize)?;
        let parameters = parameters(self.rays(scene), query, list, 0);
        // SAFETY: there is a count for each particle; the structure was updated for the scene.
        unsafe { trace(tracing(scene.gpu)?, self.probe().count(), n, &parameters) }
    }

    /// Lists the neighbours of all particles, with or without their images; waits for the device once, to know how many
    /// there are.
    ///
    /// # Errors
    /// As [`Bvh::count`].
    pub fn list(&self, scene: &Scene, query: RowQuery, images: bool, list: &mut DeviceList) -> Result<()> {
        self.count(scene, query, list)?;
        let entries = list.place_rows()?;
        list.make_room(entries, images)?;
        self.fill(scene, query, 0..scene.particles.n, 0, list)
    }

    /// Fills the rows of some places, the first of whose entries is entry `base` of all. Where radii are per particle,
    /// rows are filled all at once.
    pub(super) fn fill(
        &self,
        scene: &Scene,
        query: RowQuery,
        places: Range<u32>,
        base: u64,
        list: &DeviceList,
    ) -> Result<()> {
        let rays = Rays { first: places.start, ..self.rays(scene) };
        let parameters = parameters(rays, query, list, base);
        // SAFETY: the list has room for as many entries as were counted, or the caller has made it for those of `places`.
        unsafe { trace(tracing(scene.gpu)?, self.probe().fill(), places.len() as u32, &parameters) }
    }
}

fn parameters(rays: Rays, query: RowQuery, list: &DeviceList, base: u64) -> ListRays {
    ListRays {
        rays,
        id: match query.numbers {
            RowNumbers::Place => Ptr::NULL,
            RowNumbers::Input(id) => id,
        },
        count: list.count.ptr(),
        offset: list.offset.ptr(),
        index: list.index.ptr(),
        image: list.image.ptr(),
        base,
        half: u32::from(query.kind == ListKind::Half),
        unused: 0,
    }
}
