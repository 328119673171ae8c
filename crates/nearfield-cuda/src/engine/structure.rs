//! The structure of a method, and its query.

use super::{physics::Physics, results::Results, state::State, survey::Survey};
use crate::{Gpu, gpu::launch};
use nearfield_core::{Method, Plan, Report, Result, maintenance::Action};
use nearfield_kernels::{
    Kernel, Ptr,
    kernels::{self, ForceKernels},
    layouts::{self, GatherArgs},
};
use std::sync::Arc;

/// Particles that a warp of the force kernels takes.
const CLUSTER: u64 = 8;

/// Lanes of a warp.
const WARP: u64 = 32;

/// What a query needs.
pub(crate) struct Query<'a> {
    pub plan: &'a Plan,
    pub physics: &'a Physics,
    pub state: &'a State,
    pub results: &'a mut Results,
    pub energy: bool,
    pub report: &'a mut Report,
}

/// What an update did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Updated {
    /// Built rather than refitted.
    pub built: bool,
    /// Built although a refit was asked for.
    pub forced: bool,
}

/// One structure.
pub(crate) enum Structure {
    Brute,
}

impl Structure {
    pub fn new(_gpu: &Arc<dyn Gpu>, plan: &Plan) -> Result<Self> {
        match plan.method {
            Method::Brute => Ok(Self::Brute),
            _ => Ok(Self::Brute),
        }
    }

    /// Whether what the last update made still serves at the present positions.
    pub fn is_fresh(&mut self, _state: &State, _physics: &Physics) -> Result<bool> {
        Ok(false)
    }

    /// Whether [`Structure::plan`] is to be called now and then.
    pub fn needs_survey(&self) -> bool {
        false
    }

    /// Makes choices that depend on how the particles lie.
    pub fn plan(&mut self, _survey: &Survey, _physics: &Physics) -> Result<()> {
        Ok(())
    }

    /// Builds or refits.
    pub fn update(&mut self, _action: Action, _state: &State, _physics: &Physics) -> Result<Updated> {
        Ok(Updated { built: true, forced: false })
    }

    pub fn cell_order(
        &mut self,
        _gpu: &Arc<dyn Gpu>,
        _survey: &Survey,
        _state: &State,
        _physics: &Physics,
    ) -> Result<Ptr<u32>> {
        Ok(Ptr::NULL)
    }

    /// Enqueues the forces.
    pub fn evaluate(&mut self, gpu: &Arc<dyn Gpu>, query: Query) -> Result<()> {
        let kernel = force_kernel(&kernels::BRUTE_FORCES, &query);
        let Query { physics, state, results, .. } = query;
        let n = state.len();
        let arguments = GatherArgs {
            law: physics.law,
            space: physics.space,
            grid: layouts::Grid { slot: state.moving.position.ptr(), ..layouts::Grid::default() },
            velocity: state.moving.velocity.ptr(),
            results: results.layout(),
            n: n as u32,
            slack: physics.slack,
        };
        // SAFETY: the arrays of particles and results have n elements each.
        unsafe { launch(&**gpu, kernel, (n as u64).div_ceil(CLUSTER) * WARP, &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        0
    }
}

/// The fastest kernel that computes what is asked for.
fn force_kernel(kernels: &ForceKernels, query: &Query) -> Kernel<GatherArgs> {
    let plain = query.physics.is_plain_lennard_jones();
    match (query.plan.deterministic, query.energy) {
        (true, false) => kernels.exact,
        (true, true) => kernels.exact_energy,
        (false, true) => kernels.any_energy,
        (false, false) if plain && query.physics.cutoff.is_some() => kernels.uniform,
        (false, false) if plain => kernels.scaled,
        (false, false) => kernels.any,
    }
}
