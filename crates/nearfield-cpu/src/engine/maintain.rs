//! Keeping the structure in step with the particles: build, refit, and whose word decides.

use crate::{Brute, Bvh, Grid, Input, Probe, Refit, Structure};
use nearfield_core::{
    Method, Plan, Report,
    engine::StepCost,
    maintenance::{Action, EnergyCounter, Motion, Policy},
};
use std::time::Instant;

/// The structure of a method.
pub(super) enum Index {
    Brute(Brute),
    Grid(Box<Grid>),
    Bvh(Box<Bvh>),
}

impl Index {
    pub fn new(plan: &Plan) -> Self {
        let probe = match plan.method {
            Method::Brute => return Self::Brute(Brute::default()),
            Method::Cell | Method::Cluster => return Self::Grid(Box::default()),
            Method::RtList | Method::RtForces | Method::RtPerse | Method::RtBoxes => Probe::Point,
            Method::RtSpheres => Probe::Axes,
            Method::RtSquares => Probe::Edges,
        };
        Self::Bvh(Box::new(Bvh::with_probe(probe, plan.images)))
    }

    pub fn build(&mut self, input: &Input) {
        match self {
            Self::Brute(brute) => brute.build(input),
            Self::Grid(grid) => grid.build(input),
            Self::Bvh(bvh) => bvh.build(input),
        }
    }

    pub fn structure(&self) -> &dyn Structure {
        match self {
            Self::Brute(brute) => brute,
            Self::Grid(grid) => &**grid,
            Self::Bvh(bvh) => &**bvh,
        }
    }

    pub fn grid(&self) -> Option<&Grid> {
        match self {
            Self::Grid(grid) => Some(grid),
            Self::Brute(_) | Self::Bvh(_) => None,
        }
    }

    pub fn bytes(&self) -> usize {
        match self {
            Self::Brute(brute) => brute.slots().bytes(),
            Self::Grid(grid) => grid.bytes(),
            Self::Bvh(bvh) => bvh.bytes(),
        }
    }
}

/// A structure built from scratch, for one use.
pub(super) fn build_fresh(plan: &Plan, input: &Input) -> Box<dyn Structure> {
    let mut index = Index::new(plan);
    index.build(input);
    match index {
        Index::Brute(brute) => Box::new(brute),
        Index::Grid(grid) => grid,
        Index::Bvh(bvh) => bvh,
    }
}

/// The structure with its maintenance policy and what upkeep has cost.
pub(super) struct Upkeep {
    pub index: Index,
    policy: Box<dyn Policy>,
    built: bool,
    /// The update since the last query, if there was one: whether it was a build, and its seconds.
    last: Option<(bool, f64)>,
}

impl Upkeep {
    pub fn new(plan: &Plan) -> Self {
        Self { index: Index::new(plan), policy: plan.maintenance.policy(), built: false, last: None }
    }

    /// Gives the policy something to read energy from.
    pub fn attach(&mut self, counter: Box<dyn EnergyCounter>) {
        self.policy.attach(counter);
    }

    /// Whether [`Upkeep::next`] wants the motion since the last build.
    pub fn needs_motion(&self) -> bool {
        self.built && matches!(self.index, Index::Bvh(_)) && self.policy.needs_motion()
    }

    /// What the next update will do: a build before which the particles may be reordered, or a refit.
    pub fn next(&mut self, motion: Motion) -> Action {
        match self.index {
            Index::Bvh(_) if self.built => self.policy.decide(motion),
            _ => Action::Build,
        }
    }

    /// Builds or refits. A refit that cannot be is a build.
    pub fn update(&mut self, action: Action, input: &Input, report: &mut Report) {
        let start = Instant::now();
        let mut built = true;
        match (&mut self.index, action) {
            (Index::Bvh(bvh), Action::Refit) => match bvh.refit(input) {
                Refit::Done => built = false,
                Refit::NeedsBuild => {
                    report.forced_builds += 1;
                    bvh.build(input);
                }
            },
            (index, _) => index.build(input),
        }
        let seconds = start.elapsed().as_secs_f64();
        if built {
            report.builds += 1;
            report.build_seconds += seconds;
        } else {
            report.refits += 1;
            report.refit_seconds += seconds;
        }
        self.built = true;
        self.last = Some((built, seconds));
    }

    /// Whether the last update was a build.
    pub fn was_built(&self) -> bool {
        self.last.is_some_and(|(built, _)| built)
    }

    /// Tells the policy what the query after the last update cost. A query of a stored list that needed no update
    /// says nothing about the structure.
    pub fn record(&mut self, query: f64) -> StepCost {
        let Some((built, structure)) = self.last.take() else {
            return StepCost { built: false, structure: 0.0, query };
        };
        let cost = StepCost { built, structure, query };
        self.policy.record(cost);
        cost
    }
}
