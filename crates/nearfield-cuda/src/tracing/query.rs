//! Forces by rays.

use super::{Bvh, Scene, Sums, bvh::tracing};
use crate::gpu::trace;
use nearfield_core::Result;
use nearfield_kernels::{
    Float4, Ptr, kernels,
    layouts::{AdvanceRays, ForceRays, Integrator, Results, Status},
};

/// A step of the particles, fused with the forces.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// How particles move.
    pub integrator: Integrator,
    /// Where positions go, `[n]`; velocities and image counts change in place.
    pub position: Ptr<Float4>,
    /// What went wrong.
    pub status: Ptr<Status>,
    /// The step that the forces belong to: its second half kick is done, then the first one and the drift of the next.
    pub number: u64,
}

impl Bvh {
    /// Sums the forces on each particle by its own rays. Complete where all radii are equal.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    pub fn gather(&self, scene: &Scene, sums: Sums, results: Results) -> Result<()> {
        let program = self.probe().gather().choose(&scene.law, sums.exact, sums.energy);
        let parameters = ForceRays { rays: self.rays(scene), results };
        // SAFETY: the structure was updated for the scene, whose arrays have n elements, as have those of the results.
        unsafe { trace(tracing(scene.gpu)?, program, scene.particles.n, &parameters) }
    }

    /// Adds the force of each pair to both particles. Results are zero before; with exact sums they still have to be
    /// made numbers.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    pub fn scatter(&self, scene: &Scene, sums: Sums, results: Results) -> Result<()> {
        let program = kernels::RAY_SCATTER.choose(&scene.law, sums.exact, sums.energy);
        let parameters = ForceRays { rays: self.rays(scene), results };
        // SAFETY: as in `gather`; exact sums have five, without energies three, arrays of n.
        unsafe { trace(tracing(scene.gpu)?, program, scene.particles.n, &parameters) }
    }

    /// As [`Bvh::gather`] of forces, and each particle moves right after its ray.
    ///
    /// # Errors
    /// [`nearfield_core::Error::Device`].
    pub fn advance(&self, scene: &Scene, exact: bool, results: Results, step: &Step) -> Result<()> {
        let program = match exact {
            true => kernels::RAY_ADVANCE_EXACT,
            false if scene.law.is_plain_lennard_jones() => kernels::RAY_ADVANCE_UNIFORM_LJ,
            false => kernels::RAY_ADVANCE,
        };
        let parameters = AdvanceRays {
            rays: self.rays(scene),
            results,
            integrator: step.integrator,
            position: step.position,
            status: step.status,
            step: step.number,
        };
        // SAFETY: as in `gather`; the second array of positions has n elements too.
        unsafe { trace(tracing(scene.gpu)?, program, scene.particles.n, &parameters) }
    }
}
