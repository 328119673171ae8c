//! One evaluation of the forces: upkeep of the structure, then the method's query.

use super::{loaded::Loaded, order, structure::Query};
use nearfield_core::{
    Order, Quantities, Result, StepCost,
    maintenance::{Action, Motion},
};

impl Loaded {
    /// Enqueues forces, and what else is asked for, at the present positions, which belong to `step`.
    pub fn evaluate(&mut self, quantities: Quantities, step: u64) -> Result<()> {
        let gpu = self.gpu.clone();
        self.prepare(step)?;
        self.results.prepare(self.state.len(), quantities.energy)?;
        let Self { plan, physics, state, results, structure, report, .. } = self;
        let query = Query { plan, physics, state, results, energy: quantities.energy, report };
        structure.evaluate(&gpu, query)?;
        self.report.evaluations += 1;
        let costs =
            self.timeline.end(&*gpu, &mut self.report, self.policy.needs_cost() && self.plan.method.uses_bvh())?;
        self.book(costs);
        Ok(())
    }

    /// Brings the structure up to date with the positions of `step`.
    pub fn prepare(&mut self, step: u64) -> Result<()> {
        let gpu = self.gpu.clone();
        self.timeline.begin(&*gpu, self.record_history)?;
        if self.built && self.structure.is_fresh(&self.state, &self.physics)? {
            return Ok(());
        }
        let action = self.next_action()?;
        if action == Action::Build && self.sorted_at.is_none_or(|then| step >= then + order::INTERVAL) {
            self.reorder()?;
            self.sorted_at = Some(step);
        }
        if self.structure.needs_survey() && self.surveyed_at.is_none_or(|then| step >= then + order::INTERVAL) {
            let survey = self.surveyor.survey(&self.state)?;
            self.structure.plan(&survey, &self.physics)?;
            self.surveyed_at = Some(step);
        }
        let updated = self.structure.update(action, &self.state, &self.physics)?;
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
        let force = &mut self.results.force;
        match self.plan.order {
            Order::None => Ok(()),
            Order::Morton => {
                let survey = self.surveyor.survey(&self.state)?;
                let order = self.morton.sort(&self.state, &survey.bounds)?.ptr();
                self.state.permute(order, force)
            }
            Order::Cell => {
                let survey = self.surveyor.survey(&self.state)?;
                let order = self.structure.cell_order(&self.gpu, &survey, &self.state, &self.physics)?;
                self.state.permute(order, force)
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
