//! A loaded system.

use super::{
    integrate::Constants, list::Lister, motion::Reference, order, physics::Physics, query::Answers, results::Results,
    state::State, structure::Structure, survey::Surveyor, timeline::Timeline, totals::Totalizer,
};
use crate::{Buffer, Gpu, grid::CellStepper};
use nearfield_core::{Plan, Report, Result, System, engine::MemoryOrder, maintenance::Policy};
use nearfield_kernels::Float4;
use std::sync::Arc;

/// A system on the device, with everything its computation keeps.
pub(crate) struct Loaded {
    pub gpu: Arc<dyn Gpu>,
    pub plan: Plan,
    pub physics: Physics,
    pub state: State,
    pub results: Results,
    /// Where positions go that move while others are still looked at.
    pub next_position: Buffer<Float4>,
    /// Of the particles as they were loaded.
    pub largest_speed: f32,
    pub constants: Constants,
    pub cell_stepper: CellStepper,
    pub totalizer: Totalizer,
    pub structure: Structure,
    pub policy: Box<dyn Policy>,
    /// Positions at the last structure build, for policies that ask.
    pub reference: Reference,
    pub surveyor: Surveyor,
    /// Made when a list is first asked for.
    pub lister: Option<Lister>,
    /// Made when points are first queried.
    pub answers: Option<Answers>,
    pub timeline: Timeline,
    pub report: Report,
    pub record_history: bool,
    /// Whether the structure has been built since the system was loaded.
    pub built: bool,
    /// Whether the forces belong to the present positions.
    pub forces_valid: bool,
    /// Step at which particles were last reordered.
    pub sorted_at: Option<u64>,
    /// Step at which the choice of cells was last made anew.
    pub planned_at: Option<u64>,
    /// Steps to the next time.
    pub plan_interval: u64,
}

impl Loaded {
    pub fn new(gpu: &Arc<dyn Gpu>, system: &System, plan: &Plan) -> Result<Self> {
        let physics = Physics::new(gpu, system)?;
        Ok(Self {
            gpu: gpu.clone(),
            plan: *plan,
            state: State::new(gpu, system)?,
            results: Results::new(gpu),
            next_position: Buffer::new(gpu, "next positions"),
            largest_speed: system.particles.velocity.largest_norm(),
            constants: Constants::new(gpu),
            cell_stepper: CellStepper::new(gpu),
            totalizer: Totalizer::new(gpu, &system.interaction)?,
            structure: Structure::new(gpu, plan, &physics)?,
            policy: plan.maintenance.policy(),
            reference: Reference::new(gpu),
            surveyor: Surveyor::new(gpu),
            lister: None,
            answers: None,
            timeline: Timeline::default(),
            report: Report::default(),
            record_history: false,
            built: false,
            forces_valid: false,
            sorted_at: None,
            planned_at: None,
            plan_interval: order::INTERVAL,
            physics,
        })
    }

    /// Arranges the particles as another engine had them.
    pub fn arrange(&mut self, order: &MemoryOrder) -> Result<()> {
        // Places now are input indices, since the system was just loaded.
        let mut permutation = Buffer::new(&self.gpu, "a memory order");
        permutation.upload(&order.ids)?;
        self.state.permute(&*self.gpu, permutation.ptr(), &mut self.results.force)?;
        self.sorted_at = order.sorted_at;
        Ok(())
    }

    pub fn report(&self) -> Report {
        let structure_bytes = self.structure.bytes();
        let bytes = structure_bytes
            + self.state.bytes()
            + self.results.bytes()
            + self.next_position.bytes()
            + self.physics.bytes()
            + self.totalizer.bytes()
            + self.reference.bytes();
        Report { bytes, structure_bytes, ..self.report.clone() }
    }
}
