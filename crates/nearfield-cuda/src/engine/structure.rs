//! The structure of a method, and its query.

use super::{physics::Physics, results::Results, state::State, survey::Sample};
use crate::{
    Gpu, Variant,
    cluster::Clusters,
    grid::{self, Candidates, ForceQuery, Grid, Pairs},
    tracing::{Bvh, Outcome, Probe, Scene, Step, StoredList, Sums, Updated},
};
use nearfield_core::{Method, Plan, Report, Result, maintenance::Action};
use nearfield_kernels::layouts;
use std::sync::Arc;

/// What a query needs.
pub(crate) struct Query<'a> {
    pub plan: &'a Plan,
    pub physics: &'a Physics,
    pub state: &'a State,
    pub results: &'a mut Results,
    pub energy: bool,
    pub report: &'a mut Report,
}

/// How candidates are found.
pub(crate) enum Structure {
    /// All pairs.
    Brute,
    /// Cells.
    Cells(Box<Grid>),
    /// Cells, and lists where they pay.
    Clusters(Box<Clusters>),
    /// Bodies, traced for forces.
    Bodies(Box<Bvh>),
    /// Boxes, traced for a list.
    List(Box<Bvh>, Box<StoredList>),
}

impl Structure {
    pub fn new(gpu: &Arc<dyn Gpu>, plan: &Plan, physics: &Physics) -> Result<Self> {
        let bvh = |probe| Bvh::new(gpu, probe, plan.images).map(Box::new);
        Ok(match plan.method {
            Method::Brute => Self::Brute,
            Method::Cell => Self::Cells(Box::new(Grid::new(gpu))),
            Method::Cluster => Self::Clusters(Box::new(Clusters::new(gpu, plan, physics))),
            Method::RtForces | Method::RtPerse | Method::RtBoxes => Self::Bodies(bvh(Probe::Point)?),
            Method::RtSpheres => Self::Bodies(bvh(Probe::Axes)?),
            Method::RtSquares => Self::Bodies(bvh(Probe::Edges)?),
            Method::RtList => {
                let list = StoredList::new(gpu, plan, &physics.sim_box, physics.largest);
                Self::List(bvh(Probe::Point)?, Box::new(list))
            }
        })
    }

    /// Whether what the last update made still serves at the present positions. To be asked once an evaluation.
    pub fn is_fresh(&mut self, physics: &Physics, state: &State) -> Result<bool> {
        match self {
            Self::List(_, list) => list.is_fresh(&physics.scene(state)),
            Self::Clusters(clusters) => clusters.is_fresh(physics, state),
            _ => Ok(false),
        }
    }

    /// Whether [`Structure::plan`] is to be called now and then.
    pub fn takes_plans(&self) -> bool {
        matches!(self, Self::Cells(_) | Self::Clusters(_))
    }

    /// Whether it is to be called before the next build.
    pub fn needs_plan(&self) -> bool {
        if let Self::Clusters(clusters) = self { clusters.needs_plan() } else { false }
    }

    /// Makes choices that depend on how the particles lie. Gives whether they lie much as before.
    pub fn plan(&mut self, sample: &Sample, physics: &Physics) -> bool {
        match self {
            Self::Cells(grid) => grid.plan(&physics.survey(sample)),
            Self::Clusters(clusters) => clusters.plan(sample, physics),
            _ => true,
        }
    }

    /// Builds or refits; particles may get other places in memory.
    pub fn update(
        &mut self,
        action: Action,
        physics: &Physics,
        state: &mut State,
        report: &mut Report,
    ) -> Result<Updated> {
        if let Self::Clusters(clusters) = self {
            clusters.build(physics, state, report)?;
            return Ok(Updated { built: true, forced: false });
        }
        self.update_in_place(action, &physics.scene(state))
    }

    /// Builds or refits a structure that leaves particles where they are.
    ///
    /// # Panics
    /// For clusters, which do not.
    pub fn update_in_place(&mut self, action: Action, scene: &Scene) -> Result<Updated> {
        match self {
            Self::Clusters(_) => unreachable!("clusters are no structure of lists"),
            Self::Brute => Ok(Updated { built: true, forced: false }),
            Self::Cells(grid) => {
                let particles = scene.particles;
                // SAFETY: the scene's positions are n.
                unsafe { grid.build(&**scene.gpu, particles.position, particles.n as usize, scene.law.variable != 0)? };
                Ok(Updated { built: true, forced: false })
            }
            Self::Bodies(bvh) => bvh.update(action, scene),
            Self::List(bvh, list) => {
                list.invalidate();
                bvh.update(action, &Scene { skin: list.skin(), ..*scene })
            }
        }
    }

    /// Enqueues the forces.
    pub fn evaluate(&mut self, query: Query, scene: &Scene) -> Result<()> {
        let Query { plan, physics, state, results, energy, report } = query;
        let sums = Sums { exact: plan.deterministic, energy };
        match self {
            Self::Brute => {
                let candidates = Candidates::All { position: scene.particles.position, n: state.len() };
                by_candidates(candidates, sums, results, scene)
            }
            Self::Cells(grid) => by_candidates(Candidates::Cells(grid), sums, results, scene),
            Self::Clusters(clusters) => {
                clusters.settle(physics, state, report)?;
                let scatters = clusters.scatters();
                summed(scene, scatters, plan.deterministic, results, |results| {
                    clusters.forces(physics, state, results, energy, report)
                })
            }
            Self::Bodies(bvh) if plan.method == Method::RtForces => scatter(bvh, sums, results, scene),
            Self::Bodies(bvh) => bvh.gather(scene, sums, results.layout()),
            Self::List(bvh, list) => {
                let mut outcome = list.gather(bvh, scene, sums, results.layout(), plan.memory_budget, report)?;
                if outcome == Outcome::NeedsBuildWithoutSkin {
                    bvh.update(Action::Build, scene)?;
                    report.builds += 1;
                    outcome = list.gather(bvh, scene, sums, results.layout(), plan.memory_budget, report)?;
                }
                match outcome {
                    Outcome::NeedsNoList if scene.law.variable != 0 => scatter(bvh, sums, results, scene),
                    Outcome::NeedsNoList => bvh.gather(scene, sums, results.layout()),
                    _ => Ok(()),
                }
            }
        }
    }

    /// Enqueues the forces and a step of all particles.
    ///
    /// # Panics
    /// Where bodies are not traced for forces.
    pub fn advance(&self, plan: &Plan, scene: &Scene, results: layouts::Results, step: &Step) -> Result<()> {
        let Self::Bodies(bvh) = self else { unreachable!("{} does not trace for forces", plan.method) };
        bvh.advance(scene, plan.deterministic, results, step)
    }

    /// Cells of the present positions where most particles have no neighbours.
    pub fn sparse_cells(&mut self) -> Option<&mut Grid> {
        let cells = match self {
            Self::Cells(grid) => Some(&mut **grid),
            Self::Clusters(clusters) => clusters.cells(),
            _ => None,
        };
        cells.filter(|grid| grid.is_sparse())
    }

    /// The clusters of the method `cluster`.
    pub fn clusters_mut(&mut self) -> Option<&mut Clusters> {
        if let Self::Clusters(clusters) = self { Some(clusters) } else { None }
    }

    /// What clusters have chosen.
    pub fn cluster_variant(&self) -> Option<Variant> {
        if let Self::Clusters(clusters) = self { Some(clusters.variant()) } else { None }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Brute => 0,
            Self::Cells(grid) => grid.bytes(),
            Self::Clusters(clusters) => clusters.bytes(),
            Self::Bodies(bvh) => bvh.bytes(),
            Self::List(bvh, list) => bvh.bytes() + list.bytes(),
        }
    }
}

/// Forces by a warp for each few particles.
fn by_candidates(candidates: Candidates, sums: Sums, results: &mut Results, scene: &Scene) -> Result<()> {
    summed(scene, candidates.scatters(Pairs::Directed), sums.exact, results, |results| {
        let query = ForceQuery {
            law: scene.law,
            space: scene.space,
            velocity: scene.particles.velocity,
            results,
            energy: sums.energy,
            exact: sums.exact,
            pairs: Pairs::Directed,
        };
        // SAFETY: the arrays of particles and results have n elements each.
        unsafe { grid::forces(&**scene.gpu, candidates, &query) }
    })
}

fn scatter(bvh: &Bvh, sums: Sums, results: &mut Results, scene: &Scene) -> Result<()> {
    summed(scene, true, sums.exact, results, |results| bvh.scatter(scene, sums, results))
}

/// Forces by `enqueue`; where it `scatters`, that is adds to sums, they are zero before, and numbers after.
fn summed(
    scene: &Scene,
    scatters: bool,
    exact: bool,
    results: &mut Results,
    enqueue: impl FnOnce(layouts::Results) -> Result<()>,
) -> Result<()> {
    if scatters {
        results.zero(exact)?;
    }
    enqueue(results.layout())?;
    if scatters && exact { results.finish_exact(&**scene.gpu, &scene.law) } else { Ok(()) }
}
