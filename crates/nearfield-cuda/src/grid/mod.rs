//! Cells on the device: particles sorted by cell, so that a warp takes neighbours and finds candidates in rows.

mod bipartite;
mod bulk;
mod classes;
mod plan;
mod query;
mod staged;
mod steps;
mod width;

pub use bipartite::{PointQuery, count as count_queries, list as list_queries};
pub(crate) use plan::SPARSE;
pub use plan::{CellPlan, Survey};
pub use query::{Candidates, ForceQuery, ListQuery, Pairs, count, forces, list};
pub(crate) use steps::{CellStepper, CellSteps};

use crate::{
    Buffer, Gpu,
    gpu::{Queue, launch},
    scan::Scan,
};
use nearfield_core::Result;
use nearfield_kernels::{
    Float4, Ptr, kernels,
    layouts::{self, CellClass, SortArgs},
};
use std::sync::Arc;

/// Particles sorted into cells.
pub struct Grid {
    plan: CellPlan,
    n: usize,
    count: Buffer<u32>,
    /// Number of counts that are zero between builds.
    clean: usize,
    start: Buffer<u32>,
    cell: Buffer<u32>,
    rank: Buffer<u32>,
    slot: Buffer<Float4>,
    particle: Buffer<u32>,
    scan: Scan,
}

impl Grid {
    /// Without cells yet.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        let buffer = || Buffer::new(gpu, "cells");
        Self {
            plan: CellPlan::default(),
            n: 0,
            count: buffer(),
            clean: 0,
            start: buffer(),
            cell: buffer(),
            rank: buffer(),
            slot: Buffer::new(gpu, "particles in cell order"),
            particle: buffer(),
            scan: Scan::new(gpu),
        }
    }

    /// Takes other cells from the next build on. Gives whether they are for much the same surroundings as before.
    pub fn plan(&mut self, survey: &Survey) -> bool {
        self.take(CellPlan::new(survey))
    }

    /// The same from a plan.
    pub(crate) fn take(&mut self, plan: CellPlan) -> bool {
        let before = std::mem::replace(&mut self.plan, plan);
        self.plan.is_much_as(&before)
    }

    /// Enqueues the sorting of `n` particles by the cells of [`Grid::plan`], which must have been called. `variable`: radii
    /// are in w.
    ///
    /// # Safety
    /// `position` is the address of `n` positions.
    ///
    /// # Errors
    /// As [`Gpu::allocate`] and [`Queue::launch`].
    pub unsafe fn build(&mut self, queue: &dyn Queue, position: Ptr<Float4>, n: usize, variable: bool) -> Result<()> {
        // SAFETY: the caller's promise.
        let sort = unsafe { self.count(queue, position, n, variable)? };
        // SAFETY: as of the count.
        unsafe { launch(queue, kernels::CELL_SCATTER, n as u64, &sort) }
    }

    /// The same but for the particles' slots, which who takes the arguments is to give them: by [`kernels::CELL_SCATTER`] or
    /// a kernel of its own.
    ///
    /// # Safety
    /// As [`Grid::build`].
    ///
    /// # Errors
    /// As [`Grid::build`].
    pub(crate) unsafe fn count(
        &mut self,
        queue: &dyn Queue,
        position: Ptr<Float4>,
        n: usize,
        variable: bool,
    ) -> Result<SortArgs> {
        self.n = n;
        for buffer in [&mut self.cell, &mut self.rank, &mut self.particle] {
            buffer.resize(n)?;
        }
        self.slot.resize(n)?;
        self.count.resize_with_room(self.plan.n_cells)?;
        if self.plan.n_cells > self.clean {
            self.count.zero_by(queue)?;
            self.clean = self.plan.n_cells;
        }
        let tiles = self.scan.state(self.plan.n_cells)?;
        let (tiles, n_tiles) = (tiles.ptr(), tiles.len() as u32);
        self.start.resize_with_room(self.plan.n_cells + 1)?;
        let arguments = SortArgs {
            grid: self.layout(),
            count: self.count.ptr(),
            tiles,
            position,
            cell: self.cell.ptr(),
            rank: self.rank.ptr(),
            n: n as u32,
            variable: u32::from(variable),
            n_tiles,
            unused: 0,
        };
        // SAFETY: arrays of n particles, of all cells, and one more for their starts; kernels keep within the cells
        // whatever the positions.
        unsafe { launch(queue, kernels::CELL_COUNT, n.max(1) as u64, &arguments)? };
        self.scan.run_from_zero(queue, &self.count, &mut self.start)?;
        Ok(arguments)
    }

    /// Addresses for kernels.
    pub fn layout(&self) -> layouts::Grid {
        let mut classes = [CellClass::default(); 8];
        classes[..self.plan.classes.len()].copy_from_slice(&self.plan.classes);
        layouts::Grid {
            classes,
            n_classes: self.plan.classes.len() as u32,
            n_cells: self.plan.n_cells as u32,
            cell_start: self.start.ptr(),
            slot: self.slot.ptr(),
            particle: self.particle.ptr(),
        }
    }

    /// The same for particles that have been put in the order of the cells, at these positions.
    pub(crate) fn layout_in_memory_order(&self, position: Ptr<Float4>) -> layouts::Grid {
        layouts::Grid { slot: position, particle: Ptr::NULL, ..self.layout() }
    }

    /// Positions in the order of the cells, as they were sorted.
    pub(crate) fn slots(&self) -> Ptr<Float4> {
        self.slot.ptr()
    }

    /// What kernels must add to ranges so that roundings lose no candidate, \[length\].
    pub(crate) fn slack(&self) -> f32 {
        self.plan.slack
    }

    /// Place of the particle in each slot: the order of the cells.
    pub fn order(&self) -> &Buffer<u32> {
        &self.particle
    }

    /// Whether particles are divided by radius. Then results must be zeroed before forces are added to them.
    pub fn has_classes(&self) -> bool {
        self.plan.classes.len() > 1
    }

    /// Whether most particles have no neighbours, so that [`CellStepper`] suits them.
    pub(crate) fn is_sparse(&self) -> bool {
        self.plan.sparse
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        let buffers = [&self.count, &self.start, &self.cell, &self.rank, &self.particle];
        buffers.iter().map(|buffer| buffer.bytes()).sum::<u64>() + self.slot.bytes() + self.scan.bytes()
    }
}
