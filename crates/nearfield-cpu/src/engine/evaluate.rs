//! One evaluation of the forces: upkeep of the structure, then the method's query.

use super::{
    clusters::StoredClusters,
    maintain::Upkeep,
    motion::Reference,
    reorder,
    results::Results,
    rt_list::{Around, Outcome, StoredList},
    sparse::StoredPairs,
    state::State,
};
use crate::{
    kernel::{ScatterSums, Sums, gather, scatter},
    physics::Physics,
};
use nearfield_core::{
    Error, Method, Order, Plan, Quantities, Report, Result, System,
    maintenance::{Action, Motion},
    skin::SkinTuner,
};
use std::{
    sync::atomic::{AtomicU32, Ordering::Relaxed},
    time::Instant,
};

/// A loaded system.
pub(super) struct Loaded {
    pub plan: Plan,
    pub physics: Physics,
    pub state: State,
    pub results: Results,
    pub upkeep: Upkeep,
    pub scatter: ScatterSums,
    pub list: StoredList,
    pub clusters: StoredClusters,
    pub sparse: StoredPairs,
    /// The skin of either kind of list.
    pub skin: SkinTuner,
    /// Time step of the run; zero outside of one.
    pub dt: f32,
    /// Steps taken since the system was loaded.
    pub steps: u64,
    /// Positions at the last structure build, for policies that ask.
    pub reference: Reference,
    pub report: Report,
    pub record_history: bool,
    /// Whether the forces belong to the present positions.
    pub forces_valid: bool,
    /// Step at which particles were last reordered. The time of the next reordering must not depend on how often a
    /// step was evaluated: it would tell a resumed run from an uninterrupted one.
    pub sorted_at: Option<u64>,
}

impl Loaded {
    pub fn new(system: &System, plan: &Plan) -> Self {
        let (physics, state) = (Physics::new(system), State::new(system));
        Self {
            plan: *plan,
            results: Results::default(),
            upkeep: Upkeep::new(plan),
            scatter: ScatterSums::default(),
            list: StoredList::new(),
            clusters: StoredClusters::new(plan, &physics, &state),
            sparse: StoredPairs::default(),
            skin: SkinTuner::new(plan.skin, system.radii.mean(), physics.sim_box.room_around(system.radii.largest())),
            dt: 0.0,
            steps: 0,
            reference: Reference::default(),
            report: Report::default(),
            record_history: false,
            forces_valid: false,
            sorted_at: None,
            physics,
            state,
        }
    }

    /// Computes forces, and what else is asked for, at the present positions, which belong to `step`.
    pub fn evaluate(&mut self, quantities: Quantities, step: u64) -> Result<()> {
        self.prepare(step);
        self.query(quantities, step)
    }

    /// Computes forces, and what else is asked for, after [`Loaded::prepare`].
    pub fn query(&mut self, quantities: Quantities, step: u64) -> Result<()> {
        self.forces_valid = false;
        self.results.prepare(self.state.len(), quantities.energy);
        let watch = NonFiniteWatch::default();
        let start = Instant::now();
        let finite = match self.plan.method {
            _ if self.sparse.found => Some(self.evaluate_sparse_pairs()),
            Method::Cluster => self.evaluate_clusters(),
            _ => None,
        };
        if let Some(finite) = finite {
            self.account(start.elapsed().as_secs_f64());
            return self.accept(finite, step);
        }
        let Self { plan, physics, state, results, upkeep, scatter: sums, list, skin, report, .. } = self;
        let mut structure = upkeep.index.structure();
        let sink = results.sink();
        let finish = |i: u32, sums: &Sums| {
            watch.see(sums.force, state.id[i as usize]);
            // SAFETY: each method below finishes each particle once.
            unsafe { sink.store(i as usize, sums) };
        };
        match plan.method {
            Method::Brute | Method::Cell | Method::Cluster => {
                gather(physics, structure, plan.deterministic, quantities.energy, &finish);
            }
            // The order of candidates depends on when the BVH was built, which policies decide by the clock:
            // exact sums keep results independent of it.
            Method::RtBoxes | Method::RtSpheres | Method::RtSquares | Method::RtPerse => {
                gather(physics, structure, true, quantities.energy, &finish);
            }
            Method::RtForces => {
                sums.reset(state.len());
                scatter(physics, structure, sums);
                sums.for_each(&finish);
            }
            Method::RtList => {
                while list.gather(Around { state, physics, plan, structure, sums, skin, report }, &finish)
                    == Outcome::NeedsLessSkin
                {
                    let input = state.input(physics, list.radii(state, physics));
                    upkeep.update(Action::Build, &input, report);
                    structure = upkeep.index.structure();
                }
            }
        }
        self.account(start.elapsed().as_secs_f64());
        if let Some(particle) = watch.first() {
            return Err(self.diagnose(particle, step));
        }
        self.forces_valid = true;
        Ok(())
    }

    /// Ends an evaluation that has stored its forces: they are valid if all are finite.
    fn accept(&mut self, finite: bool, step: u64) -> Result<()> {
        if !finite {
            let watch = NonFiniteWatch::default();
            (0..self.state.len()).for_each(|i| watch.see(self.results.force.get(i), self.state.id[i]));
            if let Some(particle) = watch.first() {
                return Err(self.diagnose(particle, step));
            }
        }
        self.forces_valid = true;
        Ok(())
    }

    /// Brings structure and list up to date with the positions of `step`.
    pub fn prepare(&mut self, step: u64) {
        self.sparse.found = false;
        if self.plan.method == Method::Cluster {
            return self.prepare_clusters(step);
        }
        if self.plan.method == Method::RtList {
            if self.list.is_fresh(&self.state, &self.physics) {
                return;
            }
            self.list.choose_skin(&mut self.skin, &self.state, self.dt, self.steps);
        }
        let motion = if self.upkeep.needs_motion() { self.motion() } else { Motion::default() };
        let action = self.upkeep.next(motion);
        let due = action == Action::Build && self.reordering_is_due(step);
        if due {
            if let Some(order) = reorder::order(self.plan.order, &self.state, &self.physics) {
                self.state.reorder(&order);
                self.results.reorder(&order);
            }
            self.sorted_at = Some(step);
        }
        let radii = self.list.radii(&self.state, &self.physics);
        let input = self.state.input(&self.physics, radii);
        self.upkeep.update(action, &input, &mut self.report);
        if self.upkeep.was_built() && self.upkeep.needs_motion() {
            self.reference.set(&self.state);
        }
        self.list.invalidate();
        if self.plan.method == Method::Cell {
            self.find_sparse_pairs(due && self.plan.order != Order::None);
        }
    }

    /// Books a query and tells the policy.
    pub fn account(&mut self, seconds: f64) {
        self.report.evaluations += 1;
        self.report.query_seconds += seconds;
        let cost = self.upkeep.record(seconds);
        if self.record_history {
            self.report.history.push(cost);
        }
    }

    fn motion(&self) -> Motion {
        let (state, physics) = (&self.state, &self.physics);
        let radius = |i: usize| if state.radius.is_empty() { physics.cutoff() } else { state.radius[i] };
        Motion { mean: self.reference.mean_over(state, &physics.sim_box, radius) }
    }

    /// Why the force on a particle (input index) is not finite.
    pub fn diagnose(&self, particle: u32, step: u64) -> Error {
        let state = &self.state;
        let bad = state.id.iter().position(|&id| id == particle).expect("ids are a permutation");
        let force = self.results.force.get(bad);
        // Later on two particles meet only where a run has blown up.
        if step == 0 && self.physics.interaction.potential.diverges_at_zero() {
            let place = state.position.get(bad);
            let twin = (0..state.len()).find(|&i| i != bad && state.position.get(i) == place);
            if let Some(twin) = twin {
                let (a, b) = (particle as usize, state.id[twin] as usize);
                return Error::Coincident(a.min(b), a.max(b));
            }
        }
        let value = force.iter().copied().find(|f| !f.is_finite()).unwrap_or(f32::NAN);
        Error::NonFinite { step, what: "force", particle: particle as usize, value: f64::from(value) }
    }
}

/// Remembers the lowest-numbered particle whose force was not finite.
pub(super) struct NonFiniteWatch(AtomicU32);

impl Default for NonFiniteWatch {
    fn default() -> Self {
        Self(AtomicU32::new(u32::MAX))
    }
}

impl NonFiniteWatch {
    #[inline(always)]
    pub fn see(&self, values: [f32; 3], id: u32) {
        // Zero times anything finite is zero; NaN and infinity stay NaN.
        if values.iter().map(|v| v * 0.0).sum::<f32>() != 0.0 {
            self.0.fetch_min(id, Relaxed);
        }
    }

    pub fn first(&self) -> Option<u32> {
        Some(self.0.load(Relaxed)).filter(|&id| id != u32::MAX)
    }
}
