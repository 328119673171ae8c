//! The loop of a run. Nothing waits for the device before the end, but where a decision needs what it found.

use super::{
    integrate::{Half, Integrator},
    loaded::Loaded,
};
use nearfield_core::{Dynamics, Error, Method, Quantities, Result, Totals};

impl Loaded {
    /// See [`nearfield_core::Engine::advance`].
    pub fn advance(&mut self, dynamics: &Dynamics, from: u64, steps: u64, quantities: Quantities) -> Result<Totals> {
        dynamics.validate()?;
        self.physics.allow_overlaps(dynamics.max_displacement > 0.0);
        if let Some(clusters) = self.structure.clusters_mut() {
            clusters.expect_steps(dynamics.dt * self.largest_speed);
        }
        if !self.forces_valid || steps == 0 {
            let wanted = if steps == 0 { quantities } else { Quantities::FORCES };
            self.evaluate(wanted, from)?;
        }
        if steps > 0 {
            let last = from + steps;
            let Self { gpu, constants, physics, state, .. } = self;
            let integrator = Integrator::new(gpu, constants, physics, dynamics, state.len(), from + 1..last + 1)?;
            self.forces_valid = false;
            self.move_all(&integrator, Half::Start, from)?;
            let fused = self.plan.method == Method::RtPerse && !integrator.rescales();
            let at_once = self.steps_at_once() && !integrator.rescales();
            let mut step = from + 1;
            while step < last {
                if at_once {
                    let reached = self.evaluate_and_step(&integrator, step, last)?;
                    if reached > step {
                        step = reached;
                        continue;
                    }
                } else if fused {
                    self.evaluate_and_move(&integrator, step)?;
                    step += 1;
                    continue;
                } else {
                    self.evaluate(Quantities::FORCES, step)?;
                }
                self.finish_step(&integrator, step - from - 1, step, false)?;
                step += 1;
            }
            self.evaluate(quantities, last)?;
            self.finish_step(&integrator, steps - 1, last, true)?;
            self.forces_valid = true;
        }
        self.totals(quantities, from + steps)
    }

    /// Whether forces and steps are computed together where cells or lists of clusters suit that. Costs are recorded by
    /// step, and order-independent sums have kernels of their own.
    fn steps_at_once(&self) -> bool {
        matches!(self.plan.method, Method::Cell | Method::Cluster) && !self.plan.deterministic && !self.record_history
    }

    /// Second half kick of `step`, thermostat, and the beginning of the step after unless this was the last.
    fn finish_step(&mut self, integrator: &Integrator, index: u64, step: u64, last: bool) -> Result<()> {
        if !integrator.rescales() {
            return self.move_all(integrator, if last { Half::Finish } else { Half::FinishAndStart }, step);
        }
        self.move_all(integrator, Half::Finish, step)?;
        integrator.rescale(&self.state, &mut self.totalizer, index)?;
        if last { Ok(()) } else { self.move_all(integrator, Half::Start, step) }
    }

    fn move_all(&self, integrator: &Integrator, half: Half, step: u64) -> Result<()> {
        integrator.run(half, &self.state, &self.results.force, &self.totalizer, step)
    }

    /// Sums over particles at `step`, after all work.
    ///
    /// # Errors
    /// What went wrong first: [`Error::Coincident`], [`Error::NonFinite`].
    pub fn totals(&mut self, quantities: Quantities, step: u64) -> Result<Totals> {
        let results = if quantities.energy { self.results.layout() } else { self.results.forces_only() };
        self.totalizer.enqueue(self.state.particles(), &self.state.place, results, step)?;
        let (totals, failures) = self.totalizer.read(quantities)?;
        let costs = self.timeline.read(&mut self.report)?;
        self.book(costs);
        self.timeline.pause();
        let (force, position) = (failures.force, failures.position);
        // A force that is not finite comes before the coordinate it would have spoilt.
        if let Some(failure) = force.filter(|force| position.is_none_or(|position| force.step <= position.step)) {
            self.forces_valid = false;
            return Err(self.diagnose_force(failure)?);
        }
        if let Some(failure) = position {
            self.forces_valid = false;
            let (step, particle) = (failure.step, failure.particle as usize);
            return Err(Error::NonFinite { step, what: "coordinate", particle, value: f64::NAN });
        }
        for (what, value) in [("kinetic energy", totals.kinetic_energy), ("energy", totals.potential_energy)] {
            if !value.is_finite() {
                self.forces_valid = false;
                let particle = self.first_not_finite(what)?;
                return Err(Error::NonFinite { step, what, particle, value });
            }
        }
        Ok(totals)
    }
}
