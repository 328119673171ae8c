//! The method `cluster`: cells in snake order, a warp for each few consecutive particles, and what suits the system
//! best of finding each pair once in cells and of lists that serve for several steps.

mod choice;
mod list;
mod pace;
mod skin;
mod steps;

pub use choice::Variant;
pub(crate) use list::StepQuery;

use crate::{
    Buffer, Gpu,
    engine::{physics::Physics, state::State, survey::Sample},
    gpu::Queue,
    grid::{self, Candidates, CellPlan, ForceQuery, Grid, Pairs, Survey},
};
use list::ClusterList;
use nearfield_core::{Plan, Report, Result};
use nearfield_kernels::{Float4, layouts::Results};
use pace::Pace;
use skin::ListSkin;
use std::sync::Arc;

/// Cells, and lists where they pay.
pub struct Clusters {
    gpu: Arc<dyn Gpu>,
    grid: Grid,
    variant: Variant,
    list: ClusterList,
    skin: ListSkin,
    pace: Pace,
    deterministic: bool,
    memory_budget: u64,
    /// Whether the list has proved larger than the budget: pairs are found in cells from then on, but where `replan` says
    /// that a smaller skin is to be tried.
    over_budget: bool,
    /// Whether cells and skin are to be chosen anew for the next build.
    replan: bool,
}

impl Clusters {
    /// Without cells yet.
    pub(crate) fn new(gpu: &Arc<dyn Gpu>, plan: &Plan, physics: &Physics) -> Self {
        Self {
            gpu: gpu.clone(),
            grid: Grid::new(gpu),
            variant: Variant::Pairs,
            list: ClusterList::new(gpu),
            skin: ListSkin::new(plan, physics),
            pace: Pace::new(),
            deterministic: plan.deterministic,
            memory_budget: plan.memory_budget,
            over_budget: false,
            replan: true,
        }
    }

    /// Takes note that there are to be steps in which a particle moves so far at first.
    pub(crate) fn expect_steps(&mut self, longest: f32) {
        self.replan |= self.skin.guess(longest);
    }

    /// Whether [`Clusters::plan`] is to be called before the next build.
    pub(crate) fn needs_plan(&self) -> bool {
        self.replan
    }

    /// Chooses cells, the skin and the variant by where the particles are. Gives whether that is much as before.
    pub(crate) fn plan(&mut self, sample: &Sample, physics: &Physics) -> bool {
        if std::mem::take(&mut self.replan) {
            self.over_budget = false;
        }
        self.skin.record(sample.n, self.list.take_served());
        self.list.set_skin(self.skin.skin(), physics);
        let skin = self.list.skin();
        let survey = physics.survey(sample);
        let with_skin =
            Survey { cutoff: survey.cutoff.map(|cutoff| cutoff + skin), largest: survey.largest + skin, ..survey };
        let plan = CellPlan::new(&with_skin);
        self.variant = Variant::choose(survey.n, physics.cutoff.map(|_| plan.neighbors), skin);
        if self.over_budget {
            self.variant = Variant::Pairs;
        }
        self.grid.take(if self.variant.uses_list() || skin == 0.0 { plan } else { CellPlan::new(&survey) })
    }

    /// What was chosen.
    pub fn variant(&self) -> Variant {
        self.variant
    }

    /// Whether the list still serves the present positions; without one nothing does. To be asked once an evaluation.
    pub(crate) fn is_fresh(&mut self, physics: &Physics, state: &State) -> Result<bool> {
        if self.variant.uses_list() { self.list.is_fresh(physics, state, &self.grid) } else { Ok(false) }
    }

    /// Sorts the particles by cell and lists what is near them, or only sorts them.
    pub(crate) fn build(&mut self, physics: &Physics, state: &mut State, report: &mut Report) -> Result<()> {
        if !self.variant.uses_list() {
            let (position, variable) = (state.moving.position.ptr(), physics.law.variable != 0);
            // SAFETY: the state's positions are n.
            return unsafe { self.grid.build(&*self.gpu, position, state.len(), variable) };
        }
        self.list.prepare(state, self.variant, self.deterministic, self.memory_budget, report)?;
        report.skin = self.list.skin();
        let gpu = self.gpu.clone();
        self.enqueue_list(&*gpu, physics, state)
    }

    /// Enqueues a list of the present positions, which puts the particles in the order of the cells. Nothing needs the
    /// forces any more: they are of positions before.
    fn enqueue_list(&mut self, queue: &dyn Queue, physics: &Physics, state: &mut State) -> Result<()> {
        // SAFETY: the state's positions are n.
        let sort = unsafe { self.grid.count(queue, state.moving.position.ptr(), state.len(), false)? };
        state.sort(queue, sort, self.list.control())?;
        self.list.enqueue(queue, physics, state, &self.grid)
    }

    /// Makes sure that there is a list where there is to be one, or turns to pairs where it would exceed the budget. To
    /// be called before forces are enqueued.
    pub(crate) fn settle(&mut self, physics: &Physics, state: &State, report: &mut Report) -> Result<()> {
        if !self.variant.uses_list() || self.list.settle(physics, state, &self.grid, self.memory_budget)? {
            return Ok(());
        }
        report.list_builds -= 1;
        self.over_budget = true;
        self.replan = self.skin.shrink();
        self.variant = Variant::Pairs;
        // SAFETY: the state's positions are n. The particles were given new places after the cells were built.
        unsafe { self.grid.build(&*self.gpu, state.moving.position.ptr(), state.len(), false) }
    }

    /// Whether forces are added to: results must be zero before, and order-independent sums be finished after.
    pub(crate) fn scatters(&self) -> bool {
        if self.variant.uses_list() { self.list.scatters() } else { self.candidates().scatters(self.pairs()) }
    }

    /// Enqueues the forces at positions that it was built for or [`Clusters::is_fresh`] of.
    pub(crate) fn forces(
        &mut self,
        physics: &Physics,
        state: &State,
        results: Results,
        energy: bool,
        report: &mut Report,
    ) -> Result<()> {
        report.batched_evaluations += u64::from(self.over_budget);
        if self.variant.uses_list() {
            return self.list.forces(physics, state, results, self.deterministic, energy);
        }
        let query = ForceQuery {
            law: physics.law,
            space: physics.space,
            velocity: state.moving.velocity.ptr(),
            results,
            energy,
            exact: self.deterministic,
            pairs: self.pairs(),
        };
        // SAFETY: the arrays of particles and results have n elements each.
        unsafe { grid::forces(&*self.gpu, self.candidates(), &query) }
    }

    /// The cells, where there is no list.
    pub(crate) fn cells(&mut self) -> Option<&mut Grid> {
        (!self.variant.uses_list()).then_some(&mut self.grid)
    }

    fn pairs(&self) -> Pairs {
        if self.deterministic { Pairs::Directed } else { Pairs::Once }
    }

    fn candidates(&self) -> Candidates<'_> {
        Candidates::Cells(&self.grid)
    }

    /// Puts the particles in the order of their cells, forces too where there are any, so that those of a cluster are
    /// written together. With lists that is done at each build.
    pub(crate) fn reorder(&mut self, physics: &Physics, state: &mut State, force: &mut Buffer<Float4>) -> Result<()> {
        if self.variant.uses_list() {
            return Ok(());
        }
        // SAFETY: the state's positions are n.
        unsafe { self.grid.build(&*self.gpu, state.moving.position.ptr(), state.len(), physics.law.variable != 0)? };
        state.permute(&*self.gpu, self.grid.order().ptr(), force)
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.grid.bytes() + self.list.bytes()
    }
}
