//! Steps of particles most of which have no neighbours, by cells that are built for each.

use super::Grid;
use crate::{
    Buffer, Gpu, Sequence,
    gpu::{Queue, launch},
};
use nearfield_core::Result;
use nearfield_kernels::{
    Ptr, kernels,
    layouts::{CellStepArgs, FirstStepArgs, GatherArgs, Integrator, Law, Particles, Results, Status},
};
use std::sync::Arc;

/// Steps of particles in cells.
#[derive(Clone, Copy)]
pub(crate) struct CellSteps {
    /// The interaction.
    pub law: Law,
    /// How particles move.
    pub integrator: Integrator,
    /// The particles.
    pub particles: Particles,
    /// What went wrong.
    pub status: Ptr<Status>,
}

/// Makes such steps, several at a time.
pub(crate) struct CellStepper {
    gpu: Arc<dyn Gpu>,
    first: Buffer<u64>,
}

impl CellStepper {
    /// For any cells.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self { gpu: gpu.clone(), first: Buffer::new(gpu, "the number of a step") }
    }

    /// Enqueues `count` steps from the forces of `step` on, at whose positions the particles are, and for which the cells
    /// were built: its second half kick, then the first one and the drift of the next, cells for that, and so on.
    ///
    /// # Safety
    /// The particles are those that the cells were built from, and as many as all arrays of `steps`.
    ///
    /// # Errors
    /// As [`Gpu::allocate`] and [`Queue::launch`].
    pub unsafe fn enqueue(&mut self, grid: &mut Grid, steps: &CellSteps, step: u64, count: u32) -> Result<()> {
        self.first.resize(1)?;
        let first = FirstStepArgs { first: self.first.ptr(), step };
        let sequence = Sequence::default();
        for index in 0..count {
            if index > 0 {
                // SAFETY: the caller's promise.
                unsafe { grid.build(&sequence, steps.particles.position, grid.n, false)? };
            }
            self.enqueue_one(&sequence, grid, steps, index)?;
        }
        // SAFETY: there is one number; and all arrays have their size already, as the cells have been built before.
        unsafe {
            launch(&*self.gpu, kernels::BEGIN_CELL_STEPS, 1, &first)?;
            self.gpu.run(&sequence)
        }
    }

    fn enqueue_one(&self, queue: &dyn Queue, grid: &Grid, steps: &CellSteps, index: u32) -> Result<()> {
        let CellSteps { law, integrator, particles, status } = *steps;
        let gather = GatherArgs {
            law,
            space: integrator.space,
            grid: grid.layout(),
            velocity: particles.velocity,
            results: Results::default(),
            n: grid.n as u32,
            slack: grid.slack(),
        };
        let first = self.first.ptr();
        let arguments = CellStepArgs { gather, integrator, particles, status, first, index, unused: 0 };
        let kernel = kernels::CELL_STEP.choose(&integrator).choose(&law, false, false);
        // SAFETY: the promise of the caller of `enqueue`.
        unsafe { launch(queue, kernel, grid.n as u64, &arguments) }
    }
}
