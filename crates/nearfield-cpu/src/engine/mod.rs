//! The engine: a system in memory order, its structure, and the loop of a step.

mod cluster_steps;
mod clusters;
mod evaluate;
mod integrate;
mod maintain;
mod motion;
mod reorder;
mod results;
mod rt_list;
mod run;
mod sparse;
mod state;
mod thermostat;
mod tolerance;

use crate::InputRadii;
use evaluate::Loaded;
use nearfield_core::{
    Dynamics, Engine, Error, ListRequest, NeighborList, Particles, PerParticle, Plan, Quantities, Radii, Report,
    Result, System, Totals, engine::MemoryOrder, maintenance::EnergyCounter,
};

/// The engine that runs on the threads of the CPU (the current rayon pool).
///
/// ```
/// use nearfield_core::{Boundary, Engine, Interaction, Method, Particles, Plan, Quantities, Radii, SimBox, System};
/// use nearfield_cpu::CpuEngine;
///
/// let system = System {
///     sim_box: SimBox::cubic(10.0, Boundary::Periodic)?,
///     particles: Particles::at([[0.5, 5.0, 5.0], [9.5, 5.0, 5.0]]),
///     radii: Radii::Uniform(2.5),
///     interaction: Interaction::lennard_jones(),
/// };
/// let mut engine = CpuEngine::new();
/// engine.load(&system, &Plan::new(Method::Cell))?;
/// let totals = engine.evaluate(Quantities::ALL)?;
/// assert_eq!(totals.pairs, 1);
/// assert!(totals.potential_energy.abs() < 1e-6); // the pair is at r = sigma through the periodic face
/// # Ok::<(), nearfield_core::Error>(())
/// ```
#[derive(Default)]
pub struct CpuEngine {
    loaded: Option<Box<Loaded>>,
    record_history: bool,
}

impl CpuEngine {
    /// An engine without a system.
    pub fn new() -> Self {
        Self::default()
    }

    fn loaded(&mut self) -> Result<&mut Loaded> {
        self.loaded.as_deref_mut().ok_or(Error::NotLoaded)
    }
}

impl Engine for CpuEngine {
    fn device(&self) -> String {
        let threads = rayon::current_num_threads();
        format!("cpu ({threads} thread{}, {})", if threads == 1 { "" } else { "s" }, crate::instruction_set())
    }

    fn supports(&self, system: &System, plan: &Plan) -> Result<()> {
        if !system.radii.is_uniform() && !plan.method.supports_variable_radii() {
            return Err(Error::Unsupported {
                method: plan.method,
                reason: "it needs one radius for all particles; use cell, rt-list or rt-forces",
            });
        }
        Ok(())
    }

    fn load(&mut self, system: &System, plan: &Plan) -> Result<()> {
        self.supports(system, plan)?;
        let mut loaded = Loaded::new(system, plan);
        loaded.record_history = self.record_history;
        self.loaded = Some(Box::new(loaded));
        Ok(())
    }

    fn evaluate(&mut self, quantities: Quantities) -> Result<Totals> {
        let loaded = self.loaded()?;
        loaded.evaluate(quantities, 0)?;
        loaded.totals(quantities, 0)
    }

    fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals> {
        let loaded = self.loaded()?;
        // Inside the pool, a thread of which then takes part in each pass instead of waiting outside.
        rayon::scope(|_| loaded.advance(dynamics, from, steps, quantities))
    }

    fn memory_order(&self) -> Result<MemoryOrder> {
        if let Some(loaded) = &self.loaded {
            loaded.clusters.end();
        }
        let order = |loaded: &Loaded| MemoryOrder {
            ids: loaded.state.id.clone(),
            sorted_at: loaded.sorted_at,
            skin: loaded.skin.learned(),
        };
        Ok(self.loaded.as_deref().map(order).unwrap_or_default())
    }

    fn set_memory_order(&mut self, order: &MemoryOrder) -> Result<()> {
        if let Some(loaded) = self.loaded.as_deref_mut().filter(|_| !order.ids.is_empty()) {
            loaded.state.reorder(&order.ids);
            loaded.sorted_at = order.sorted_at;
            loaded.clusters.invalidate();
            loaded.skin.set_learned(order.skin);
        }
        Ok(())
    }

    fn snapshot(&mut self, particles: &mut Particles) -> Result<()> {
        if let Some(loaded) = &self.loaded {
            loaded.state.copy_to(particles);
        }
        Ok(())
    }

    fn per_particle(&mut self, out: &mut PerParticle) -> Result<()> {
        if let Some(loaded) = &self.loaded {
            loaded.copy_results(out);
        }
        Ok(())
    }

    fn neighbor_list(&mut self, request: ListRequest) -> Result<NeighborList> {
        let loaded = self.loaded()?;
        let mut particles = Particles::default();
        loaded.state.copy_to(&mut particles);
        let mut radii = vec![0.0; loaded.state.radius.len()];
        for (&id, &radius) in loaded.state.id.iter().zip(&loaded.state.radius) {
            radii[id as usize] = radius;
        }
        let radii = match loaded.physics.radii {
            Radii::Uniform(r) => InputRadii::Uniform(r),
            Radii::PerParticle(_) => InputRadii::PerParticle(&radii),
        };
        let [x, y, z] = particles.position.axes();
        let input =
            crate::Input { sim_box: &loaded.physics.sim_box, position: [x, y, z], radii, kind: &particles.kind };
        let structure = maintain::build_fresh(&loaded.plan, &input);
        Ok(crate::neighbor_list(&*structure, &input, request))
    }

    fn report(&self) -> Report {
        self.loaded.as_ref().map(|loaded| loaded.report()).unwrap_or_default()
    }

    fn record_history(&mut self, on: bool) {
        self.record_history = on;
        if let Some(loaded) = &mut self.loaded {
            loaded.record_history = on;
        }
    }

    fn attach_meter(&mut self, counter: Box<dyn EnergyCounter>) {
        if let Some(loaded) = &mut self.loaded {
            loaded.upkeep.attach(counter);
        }
    }
}
