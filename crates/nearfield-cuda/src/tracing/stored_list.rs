//! The neighbour list of `rt-list`: count, scan, fill, kept while the Verlet skin lasts. A list that would not fit the
//! memory budget is processed in batches of rows, or, where these would leave the device idle, not stored at all.
//!
//! Rows hold no images: as ranges are at most half a periodic length, only the nearest image can be within range, which
//! kernels find from the positions.

use super::{
    Bvh, Scene, Sums,
    rows::{RowNumbers, RowQuery},
};
use crate::{DeviceList, Gpu, engine::motion::Reference, gpu::launch};
use nearfield_core::{ListKind, Plan, Report, Result, SimBox};
use nearfield_kernels::{
    kernels,
    layouts::{Results, RowsArgs},
};
use std::{ops::Range, sync::Arc};

/// Rows of this list.
const ROWS: RowQuery = RowQuery { kind: ListKind::Full, numbers: RowNumbers::Place };

/// Most batches: with more, a batch has too few rows to occupy the device, as each is a ray. In a cluster of 10⁶ particles
/// that are nearly all neighbours, 1000 batches of 1000 rows took more than 260 s on an H200, and pairs consumed where they
/// were found 12 s.
const MAX_BATCHES: u64 = 64;

const BYTES_PER_ENTRY: u64 = size_of::<u32>() as u64;

/// A list of everything within range plus skin, and how far particles have moved since.
pub struct StoredList {
    gpu: Arc<dyn Gpu>,
    /// At most what keeps range plus skin within half a periodic length; zero once the list has proved too large.
    skin: f32,
    valid: bool,
    rows: DeviceList,
    reference: Reference,
    /// Evaluations since the list was built.
    age: u64,
}

/// What came of a query.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Forces are there.
    Done,
    /// The list is too large to be kept: the structure must be built again, without skin, for the query to be asked once
    /// more.
    NeedsBuildWithoutSkin,
    /// The list is too large, also for batches, or has rows of per-particle radii, which cannot be completed in batches:
    /// pairs are to be consumed where rays find them.
    NeedsNoList,
}

impl StoredList {
    /// No list yet, with the skin of a plan as far as the box allows it.
    pub fn new(gpu: &Arc<dyn Gpu>, plan: &Plan, sim_box: &SimBox, largest_radius: f32) -> Self {
        Self {
            gpu: gpu.clone(),
            skin: plan.skin.or_usual().min(sim_box.room_around(largest_radius)).max(0.0),
            valid: false,
            rows: DeviceList::new(gpu),
            reference: Reference::new(gpu),
            age: 0,
        }
    }

    /// The skin that structures must be built with.
    pub fn skin(&self) -> f32 {
        self.skin
    }

    /// Whether the list still holds every pair: no two particles can have approached by more than the skin. To be asked
    /// once an evaluation; waits for the device.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    pub fn is_fresh(&mut self, scene: &Scene) -> Result<bool> {
        self.age += 1;
        if !self.valid || self.skin == 0.0 {
            return Ok(false);
        }
        let moved = self.reference.moved(&scene.particles, &scene.space, scene.law.cutoff)?;
        // The margin covers the rounding of the measured displacement.
        Ok(2.0 * moved.largest <= f64::from(self.skin) * (1.0 - 1e-5))
    }

    /// Forgets the list: particles were reordered or have moved too far.
    pub fn invalidate(&mut self) {
        self.valid = false;
    }

    /// Sums over the rows of the list, building it first when there is none from a structure that was updated with
    /// [`StoredList::skin`].
    ///
    /// # Errors
    /// [`nearfield_core::Error::OutOfMemory`], [`nearfield_core::Error::Device`].
    pub fn gather(
        &mut self,
        bvh: &Bvh,
        scene: &Scene,
        sums: Sums,
        results: Results,
        budget: u64,
        report: &mut Report,
    ) -> Result<Outcome> {
        let scene = &Scene { skin: self.skin, ..*scene };
        let n = scene.particles.n;
        if !self.valid {
            bvh.count(scene, ROWS, &mut self.rows)?;
            let entries = self.rows.place_rows()?;
            if entries.saturating_mul(BYTES_PER_ENTRY) > budget {
                if self.skin > 0.0 {
                    self.skin = 0.0;
                    return Ok(Outcome::NeedsBuildWithoutSkin);
                }
                report.batched_evaluations += 1;
                if scene.law.variable != 0 || entries.saturating_mul(BYTES_PER_ENTRY) / MAX_BATCHES > budget {
                    return Ok(Outcome::NeedsNoList);
                }
                self.gather_in_batches(bvh, scene, sums, results, budget)?;
                return Ok(Outcome::Done);
            }
            report.list_builds += 1;
            report.skin = self.skin;
            if self.age == 1 && self.skin > 0.0 && report.list_builds > 1 {
                report.dangerous_builds += 1;
            }
            self.age = 0;
            self.reference.set(&scene.particles)?;
            self.rows.make_room(entries, false)?;
            bvh.fill(scene, ROWS, 0..n, 0, &self.rows)?;
            self.valid = true;
        }
        self.sum_rows(scene, sums, results, 0..n, 0)?;
        Ok(Outcome::Done)
    }

    /// Fills and consumes as many rows at a time as fit the budget, at least one.
    fn gather_in_batches(&mut self, bvh: &Bvh, scene: &Scene, sums: Sums, results: Results, budget: u64) -> Result<()> {
        let n = scene.particles.n;
        let (mut first, mut base) = (0, 0);
        while first < n {
            let (end, stop) = self.rows_until(first, n, base + budget / BYTES_PER_ENTRY)?;
            self.rows.index.resize((stop - base) as usize)?;
            bvh.fill(scene, ROWS, first..end, base, &self.rows)?;
            self.sum_rows(scene, sums, results, first..end, base)?;
            (first, base) = (end, stop);
        }
        Ok(())
    }

    /// The row after the last that ends at or before entry `limit`, and its start; at least the row after `first`.
    fn rows_until(&self, first: u32, n: u32, limit: u64) -> Result<(u32, u64)> {
        let (mut low, mut high) = (first + 1, n);
        let mut start = self.rows.start_of(low as usize)?;
        while low < high {
            let middle = low + (high - low).div_ceil(2);
            let start_of_middle = self.rows.start_of(middle as usize)?;
            if start_of_middle <= limit {
                (low, start) = (middle, start_of_middle);
            } else {
                high = middle - 1;
            }
        }
        Ok((low, start))
    }

    fn sum_rows(&self, scene: &Scene, sums: Sums, results: Results, rows: Range<u32>, base: u64) -> Result<()> {
        let kernel = kernels::ROWS.choose(&scene.law, sums.exact, sums.energy);
        let n_rows = rows.len() as u32;
        let arguments = RowsArgs {
            law: scene.law,
            space: scene.space,
            particles: scene.particles,
            offset: self.rows.offset.ptr(),
            index: self.rows.index.ptr(),
            results,
            base,
            first: rows.start,
            n_rows,
        };
        // SAFETY: the rows have been filled, their entries are places; results have n elements.
        unsafe { launch(&*self.gpu, kernel, u64::from(n_rows) * kernels::ROWS_LANES, &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.rows.bytes() + self.reference.bytes()
    }
}
