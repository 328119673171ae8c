//! The coarse interface of a device: load a system, evaluate it, advance it, read it back.
//!
//! State stays on the device between calls. Inner loops are monomorphic behind this boundary.

use crate::{
    Dynamics, ListRequest, NeighborList, Particles, Plan, Result, System, Vec3s,
    maintenance::EnergyCounter,
    skin::{LearnedSkin, ListIntervals},
};
use serde::{Deserialize, Serialize};

/// What an evaluation computes beside forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Quantities {
    /// Potential energy, virial, pairs and the per-particle energies and neighbour counts.
    pub energy: bool,
}

impl Quantities {
    /// Forces only.
    pub const FORCES: Self = Self { energy: false };
    /// Forces, energy, virial and neighbour counts.
    pub const ALL: Self = Self { energy: true };
}

/// Sums over all particles.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize)]
pub struct Totals {
    /// Kinetic energy.
    pub kinetic_energy: f64,
    /// Potential energy without tail corrections; zero when only forces were asked for.
    pub potential_energy: f64,
    /// W = sum over pairs of r_ij . f_ij; zero when only forces were asked for.
    pub virial: f64,
    /// Pairs within range, each once; zero when only forces were asked for.
    pub pairs: u64,
    /// Total momentum.
    pub momentum: [f64; 3],
    /// Largest force on a particle.
    pub max_force: f64,
}

/// Per-particle results, in input order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PerParticle {
    /// Forces, `[N]`.
    pub force: Vec3s,
    /// Half of the energy of each particle's pairs, `[N]`; empty when only forces were asked for.
    pub energy: Vec<f64>,
    /// Number of neighbours, `[N]`; empty when only forces were asked for.
    pub neighbors: Vec<u32>,
}

/// Structure and query cost of one step, for the maintenance time series (paper A, figure 8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepCost {
    /// Whether the structure was built anew rather than refitted.
    pub built: bool,
    /// Seconds to build or refit.
    pub structure: f64,
    /// Seconds to find and consume the pairs.
    pub query: f64,
}

/// What an engine did since the system was loaded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Report {
    /// Force evaluations.
    pub evaluations: u64,
    /// Structures built.
    pub builds: u64,
    /// Structures refitted.
    pub refits: u64,
    /// Builds that correctness required where the policy asked for a refit (the ghost layer was outrun).
    pub forced_builds: u64,
    /// Neighbour lists built.
    pub list_builds: u64,
    /// List builds that came at the first step after the one before: the skin is too thin for the motion. No pair
    /// is missed (the test runs before each use), but the list saves nothing.
    pub dangerous_builds: u64,
    /// Skin of the last list, \[length\]; zero without lists.
    pub skin: f32,
    /// How the last list was kept, where a tolerance allows lists to miss pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerant_lists: Option<ListIntervals>,
    /// Evaluations whose list did not fit the memory budget and was processed in batches.
    pub batched_evaluations: u64,
    /// Seconds spent building structures.
    pub build_seconds: f64,
    /// Seconds spent refitting.
    pub refit_seconds: f64,
    /// Seconds spent finding and consuming pairs; with what was built in between where many steps were timed as one.
    pub query_seconds: f64,
    /// Seconds spent integrating, reordering and summing.
    pub integrate_seconds: f64,
    /// Bytes held by the engine.
    pub bytes: u64,
    /// Bytes of these that the structure takes, with what its method stores beside it, such as a list.
    pub structure_bytes: u64,
    /// Cost of each evaluation, when recording was asked for.
    pub history: Vec<StepCost>,
}

impl Report {
    /// Mean number of evaluations that a stored list served; `None` without lists.
    pub fn steps_per_list(&self) -> Option<f64> {
        let by_lists = self.evaluations.saturating_sub(self.batched_evaluations) as f64;
        (self.list_builds > 0).then(|| by_lists / self.list_builds as f64)
    }

    /// The sum of two reports, `later` being of the same simulation after the engine was loaded again.
    #[must_use]
    pub fn followed_by(mut self, mut later: Self) -> Self {
        self.history.append(&mut later.history);
        Self {
            evaluations: self.evaluations + later.evaluations,
            builds: self.builds + later.builds,
            refits: self.refits + later.refits,
            forced_builds: self.forced_builds + later.forced_builds,
            list_builds: self.list_builds + later.list_builds,
            dangerous_builds: self.dangerous_builds + later.dangerous_builds,
            skin: if later.list_builds > 0 { later.skin } else { self.skin },
            tolerant_lists: later.tolerant_lists.or(self.tolerant_lists),
            batched_evaluations: self.batched_evaluations + later.batched_evaluations,
            build_seconds: self.build_seconds + later.build_seconds,
            refit_seconds: self.refit_seconds + later.refit_seconds,
            query_seconds: self.query_seconds + later.query_seconds,
            integrate_seconds: self.integrate_seconds + later.integrate_seconds,
            bytes: later.bytes,
            structure_bytes: later.structure_bytes,
            history: self.history,
        }
    }
}

/// How an engine keeps the particles in memory, and its lists. Sums in f32 depend on both, so a run that is to be
/// continued bit for bit keeps this beside the particles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MemoryOrder {
    /// Input index of the particle at each place, `[N]`; empty for input order.
    pub ids: Vec<u32>,
    /// Step at which the particles were last sorted.
    pub sorted_at: Option<u64>,
    /// What was learned of the best skin.
    #[serde(default)]
    pub skin: LearnedSkin,
}

/// A device that holds a system and computes on it.
///
/// Preconditions: the system passed [`System::validate`] and is wrapped; the plan's method is one of
/// [`Engine::supports`]. Everything that goes in or out is in input order.
pub trait Engine: Send {
    /// Name of the device, for reports.
    fn device(&self) -> String;

    /// Whether this engine can compute the system by the plan.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] with the reason.
    fn supports(&self, system: &System, plan: &Plan) -> Result<()>;

    /// Takes a system, forgetting any other. Two engines that loaded equal systems by equal plans continue equally.
    ///
    /// # Errors
    /// As [`Engine::supports`], and when memory is short.
    fn load(&mut self, system: &System, plan: &Plan) -> Result<()>;

    /// Evaluates forces, and what else is asked for, at the current positions.
    ///
    /// # Errors
    /// [`crate::Error::Coincident`] when two particles coincide where the potential diverges.
    fn evaluate(&mut self, quantities: Quantities) -> Result<Totals>;

    /// Moves the system by `steps` steps, the first of which ends at step `from + 1`, and gives the totals at the
    /// end with the asked quantities. The first call after [`Engine::load`] evaluates the initial forces itself.
    ///
    /// # Errors
    /// As [`Engine::evaluate`]; [`crate::Error::NonFinite`] when the run has blown up.
    fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals>;

    /// How the particles lie in memory. An engine that never moves them keeps this default.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    fn memory_order(&self) -> Result<MemoryOrder> {
        Ok(MemoryOrder::default())
    }

    /// Arranges the particles as another engine had them, right after [`Engine::load`] of its snapshot: both then
    /// continue bit for bit alike. Precondition: `order.ids` is a permutation of the particles.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    fn set_memory_order(&mut self, order: &MemoryOrder) -> Result<()> {
        let _ = order;
        Ok(())
    }

    /// Copies positions, velocities, types and image counts out.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    fn snapshot(&mut self, particles: &mut Particles) -> Result<()>;

    /// Copies the results of the last evaluation out.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    fn per_particle(&mut self, out: &mut PerParticle) -> Result<()>;

    /// The neighbour list at the current positions.
    ///
    /// # Errors
    /// [`crate::Error::NotLoaded`], or when memory is short.
    fn neighbor_list(&mut self, request: ListRequest) -> Result<NeighborList>;

    /// What was done since [`Engine::load`].
    fn report(&self) -> Report;

    /// Starts or stops recording [`Report::history`].
    fn record_history(&mut self, on: bool);

    /// Gives the rebuild policy of the system, right after [`Engine::load`], something to read the device's energy from.
    /// [`crate::Maintenance::GradientJoules`] has no use without it, other policies none for it.
    fn attach_meter(&mut self, counter: Box<dyn EnergyCounter>) {
        drop(counter);
    }
}
