//! One evaluation of the forces: upkeep of the structure, then the method's query.

use super::{
    integrate::Integrator,
    loaded::Loaded,
    order::{self, MortonOrder},
    structure::Query,
};
use crate::{
    cluster::StepQuery,
    grid::{CellSteps, Grid},
    tracing::Step,
};
use nearfield_core::{
    Order, Quantities, Result, StepCost,
    maintenance::{Action, Motion},
};

/// Most steps by cells that are enqueued together.
const CELL_STEPS: u64 = 20;

impl Loaded {
    /// Enqueues forces, and what else is asked for, at the present positions, which belong to `step`.
    pub fn evaluate(&mut self, quantities: Quantities, step: u64) -> Result<()> {
        self.prepare(step)?;
        self.query(quantities)
    }

    /// Enqueues forces at positions that the structure was prepared for.
    fn query(&mut self, quantities: Quantities) -> Result<()> {
        self.results.prepare(self.state.len(), quantities.energy)?;
        let Self { plan, physics, state, results, structure, report, .. } = self;
        let scene = physics.scene(state);
        let query = Query { plan, physics, state, results, energy: quantities.energy, report };
        structure.evaluate(query, &scene)?;
        self.account(1)
    }

    /// ORCS-persé (paper A, section 3.2.1): the pass that finds a particle's force also moves it through the rest of
    /// `step` and the beginning of the next.
    pub fn evaluate_and_move(&mut self, integrator: &Integrator, step: u64) -> Result<()> {
        self.prepare(step)?;
        let n = self.state.len();
        self.results.prepare(n, false)?;
        self.next_position.resize(n)?;
        let movement = Step {
            integrator: integrator.layout(),
            position: self.next_position.ptr(),
            status: self.totalizer.status().ptr(),
            number: step,
        };
        let scene = self.physics.scene(&self.state);
        self.structure.advance(&self.plan, &scene, self.results.layout(), &movement)?;
        std::mem::swap(&mut self.state.moving.position, &mut self.next_position);
        self.account(1)
    }

    /// Forces at the positions of `step`, and steps by them, none beyond `before`: by lists of clusters, by cells where
    /// most particles have no neighbours, else none. Gives the step whose positions the particles are at then.
    pub fn evaluate_and_step(&mut self, integrator: &Integrator, step: u64, before: u64) -> Result<u64> {
        self.prepare(step)?;
        let replan = self.planned_at.map_or(step, |then| then + self.plan_interval);
        let made = self.steps_by_cells(integrator, step, before, replan)?;
        if made > 0 {
            return Ok(step + made);
        }
        let Self { physics, state, structure, next_position, totalizer, report, .. } = self;
        let (integrator, status) = (integrator.layout(), totalizer.status().ptr());
        if let Some(clusters) = structure.clusters_mut().filter(|clusters| clusters.variant().uses_list()) {
            let query = StepQuery { physics, state, spare: next_position, integrator, status };
            let made = clusters.steps(query, step..before, replan, report)?;
            if made > 0 {
                self.account(made)?;
                return Ok(step + made);
            }
        }
        self.query(Quantities::FORCES)?;
        Ok(step)
    }

    /// Steps by sparse cells, which are there for the first, where there are any: until particles are to be sorted or
    /// cells to be chosen anew.
    fn steps_by_cells(&mut self, integrator: &Integrator, step: u64, before: u64, replan: u64) -> Result<u64> {
        let Self { physics, state, structure, totalizer, cell_stepper, .. } = self;
        let Some(grid) = structure.sparse_cells() else { return Ok(0) };
        let reorder = self.sorted_at.map_or(step, |then| then + order::INTERVAL);
        let made = before.min(replan).min(reorder).saturating_sub(step).clamp(1, CELL_STEPS);
        let steps = CellSteps {
            law: physics.law,
            integrator: integrator.layout(),
            particles: state.particles(),
            status: totalizer.status().ptr(),
        };
        // SAFETY: the cells are of the present positions, and arrays of particles have n elements each.
        unsafe { cell_stepper.enqueue(grid, &steps, step, made as u32)? };
        self.report.builds += made - 1;
        self.account(made)?;
        Ok(made)
    }

    /// Books evaluations whose query has been enqueued.
    fn account(&mut self, evaluations: u64) -> Result<()> {
        self.report.evaluations += evaluations;
        let wait = self.policy.needs_cost() && self.plan.method.uses_bvh();
        let costs = self.timeline.end(&*self.gpu, &mut self.report, wait)?;
        self.book(costs);
        Ok(())
    }

    /// Brings the structure up to date with the positions of `step`.
    pub fn prepare(&mut self, step: u64) -> Result<()> {
        let gpu = self.gpu.clone();
        self.timeline.begin(&*gpu, self.record_history)?;
        if self.built && self.structure.is_fresh(&self.physics, &self.state)? {
            return Ok(());
        }
        let action = self.next_action()?;
        let is_due = self.planned_at.is_none_or(|then| step >= then + self.plan_interval);
        if self.structure.takes_plans() && (is_due || self.structure.needs_plan()) {
            let much_as_before = self.structure.plan(&self.surveyor.survey(&self.state)?, &self.physics);
            let interval = if much_as_before { 2 * self.plan_interval } else { order::INTERVAL };
            self.plan_interval = interval.min(order::LONGEST_PLAN);
            self.planned_at = Some(step);
        }
        if action == Action::Build && self.sorted_at.is_none_or(|then| step >= then + order::INTERVAL) {
            self.reorder()?;
            self.sorted_at = Some(step);
        }
        let updated = self.structure.update(action, &self.physics, &mut self.state, &mut self.report)?;
        self.report.forced_builds += u64::from(updated.forced);
        if updated.built {
            self.report.builds += 1;
            if self.policy.needs_motion() {
                self.reference.set(&self.state.particles())?;
            }
        } else {
            self.report.refits += 1;
        }
        self.built = true;
        if !self.policy.needs_cost() {
            self.policy.record(StepCost { built: updated.built, structure: 0.0, query: 0.0 });
        }
        self.timeline.updated(&*gpu, updated.built)
    }

    fn next_action(&mut self) -> Result<Action> {
        if !self.built || !self.plan.method.uses_bvh() {
            return Ok(Action::Build);
        }
        let mut motion = Motion::default();
        if self.policy.needs_motion() {
            motion.mean = self
                .reference
                .moved(&self.state.particles(), &self.physics.space, self.physics.law.cutoff)?
                .mean_over_radius as f32;
        }
        Ok(self.policy.decide(motion))
    }

    fn reorder(&mut self) -> Result<()> {
        let Self { gpu, state, physics, surveyor, structure, .. } = self;
        if let (Some(clusters), Order::Morton | Order::Cell) = (structure.clusters_mut(), self.plan.order) {
            return clusters.reorder(physics, state, &mut self.results.force);
        }
        match self.plan.order {
            Order::None => Ok(()),
            Order::Morton => {
                let mut morton = MortonOrder::new(gpu);
                let order = morton.sort(state, &surveyor.survey(state)?.bounds)?.ptr();
                state.permute(&**gpu, order, &mut self.results.force)
            }
            Order::Cell => {
                let mut grid = Grid::new(gpu);
                grid.plan(&physics.survey(&surveyor.survey(state)?));
                // SAFETY: the state's positions are n.
                unsafe { grid.build(&**gpu, state.moving.position.ptr(), state.len(), physics.law.variable != 0)? };
                state.permute(&**gpu, grid.order().ptr(), &mut self.results.force)
            }
        }
    }

    /// Tells the history and the policy what steps have cost.
    pub fn book(&mut self, costs: Vec<super::timeline::Cost>) {
        for cost in costs {
            if cost.recorded {
                self.report.history.push(cost.step);
            }
            if cost.updated && self.policy.needs_cost() {
                self.policy.record(cost.step);
            }
        }
    }
}
