//! Velocity Verlet and its thermostats, as kernels take them.

use super::{physics::Physics, state::State, totals::Totalizer};
use crate::{Buffer, Gpu, gpu::launch};
use nearfield_core::{Dynamics, Ensemble, ParticleType, Result, dynamics::rescale_draws};
use nearfield_kernels::{
    Float4, Ptr, kernels,
    layouts::{self, IntegrateArgs, RescaleArgs},
};
use std::sync::Arc;

/// The integrator of one call of `advance`.
pub(crate) struct Integrator {
    gpu: Arc<dyn Gpu>,
    layout: layouts::Integrator,
    rescaling: Option<Rescaling>,
}

/// What [`layouts::Integrator`] points to, by type of particle; kept, so that steps of one call are launched as those of
/// another.
pub(crate) struct Constants {
    half_kick: Constant,
    noise: Constant,
}

struct Constant {
    device: Buffer<f32>,
    host: Vec<f32>,
}

impl Constants {
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        let constant = || Constant { device: Buffer::new(gpu, "integrator constants"), host: Vec::new() };
        Self { half_kick: constant(), noise: constant() }
    }
}

impl Constant {
    /// Address of these values; they are copied where they are not those of before.
    fn set(&mut self, values: Vec<f32>) -> Result<Ptr<f32>> {
        if self.host != values {
            self.device.upload(&values)?;
            self.host = values;
        }
        Ok(self.device.ptr())
    }
}

/// Which halves of steps a launch does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Half {
    /// The second half kick.
    Finish,
    /// The first half kick and the drift of the next step.
    Start,
    /// Both.
    FinishAndStart,
}

/// Velocity rescaling: the random numbers of all steps of the call are drawn before, since they do not depend on its
/// course, and the device need not wait for the host.
struct Rescaling {
    normal: Buffer<f64>,
    chi_squared: Buffer<f64>,
    temperature: f64,
    decay: f64,
}

impl Integrator {
    /// For `steps` of `n` particles; `constants` must not be changed while it is used.
    pub fn new(
        gpu: &Arc<dyn Gpu>,
        constants: &mut Constants,
        physics: &Physics,
        dynamics: &Dynamics,
        n: usize,
        steps: std::ops::Range<u64>,
    ) -> Result<Self> {
        let (types, dt) = (&physics.interaction.types, dynamics.dt);
        let mut layout = layouts::Integrator {
            space: physics.space,
            dt,
            speed_limit: if dynamics.max_displacement > 0.0 { dynamics.max_displacement / dt } else { f32::INFINITY },
            seed: [dynamics.seed as u32, (dynamics.seed >> 32) as u32],
            half_kick: constants.half_kick.set(types.iter().map(|t| 0.5 * dt / t.mass).collect())?,
            ..layouts::Integrator::default()
        };
        let mut rescaling = None;
        match dynamics.ensemble {
            Ensemble::Nve => {}
            Ensemble::Langevin { temperature, friction } => {
                let damping = (-friction * f64::from(dt)).exp();
                let strength =
                    |t: &ParticleType| ((1.0 - damping * damping) * temperature / f64::from(t.mass)).sqrt() as f32;
                layout.langevin = 1;
                layout.damping = damping as f32;
                layout.noise = constants.noise.set(types.iter().map(strength).collect())?;
            }
            Ensemble::Rescale { temperature, relaxation } => {
                let (normals, chi_squareds): (Vec<f64>, Vec<f64>) =
                    steps.map(|step| rescale_draws(n, dynamics.seed, step)).unzip();
                let (mut normal, mut chi_squared) =
                    (Buffer::new(gpu, "random numbers"), Buffer::new(gpu, "random numbers"));
                normal.upload(&normals)?;
                chi_squared.upload(&chi_squareds)?;
                let decay = (-f64::from(dt) / relaxation).exp();
                rescaling = Some(Rescaling { normal, chi_squared, temperature, decay });
            }
        }
        Ok(Self { gpu: gpu.clone(), layout, rescaling })
    }

    /// For kernels that move particles themselves.
    pub fn layout(&self) -> layouts::Integrator {
        self.layout
    }

    /// Whether velocities are rescaled after each step.
    pub fn rescales(&self) -> bool {
        self.rescaling.is_some()
    }

    /// Arguments for `half` at the forces of `step`.
    pub fn arguments(
        &self,
        half: Half,
        state: &State,
        force: &Buffer<Float4>,
        totals: &Totalizer,
        step: u64,
    ) -> IntegrateArgs {
        IntegrateArgs {
            integrator: self.layout,
            particles: state.particles(),
            force: force.ptr(),
            status: totals.status().ptr(),
            step,
            finish: u32::from(half != Half::Start),
            start: u32::from(half != Half::Finish),
        }
    }

    /// Moves all particles.
    pub fn run(&self, half: Half, state: &State, force: &Buffer<Float4>, totals: &Totalizer, step: u64) -> Result<()> {
        let arguments = self.arguments(half, state, force, totals, step);
        // SAFETY: the arrays of particles have n elements each.
        unsafe { launch(&*self.gpu, kernels::INTEGRATE, state.len() as u64, &arguments) }
    }

    /// Rescales velocities after the `index`-th step of the call, where the ensemble asks for it.
    pub fn rescale(&self, state: &State, totals: &mut Totalizer, index: u64) -> Result<()> {
        let Some(Rescaling { normal, chi_squared, temperature, decay }) = &self.rescaling else { return Ok(()) };
        totals.enqueue(state.particles(), &state.place, layouts::Results::default(), 0)?;
        let arguments = RescaleArgs {
            particles: state.particles(),
            sums: totals.sum(),
            normal: normal.ptr(),
            chi_squared: chi_squared.ptr(),
            temperature: *temperature,
            decay: *decay,
            index,
        };
        // SAFETY: there is a draw for each step of the call.
        unsafe { launch(&*self.gpu, kernels::RESCALE, state.len() as u64, &arguments) }
    }
}
