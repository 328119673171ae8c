//! Lists of what is near each cluster, and forces and steps by them.

use super::Variant;
use crate::{
    Buffer, Gpu,
    engine::{physics::Physics, state::State},
    gpu::{Queue, launch},
    grid::Grid,
};
use bytemuck::Zeroable;
use nearfield_core::{Report, Result};
use nearfield_kernels::{
    Float4, Kernel, Ptr,
    kernels::{
        self, CLUSTER, LIST_CLUSTERS, LIST_SPARSE, LISTED_FORCES, LISTED_PAIRS, MOVE_LISTED, SEGMENT, STEP_SPARSE,
    },
    layouts::{
        self, ClusterControl, ClusterControlArgs, ClusterListArgs, ClusterStepArgs, ClustersMovedArgs, GatherArgs,
        Integrator, Law, ListedArgs, Results, Segment, Status,
    },
};
use std::sync::Arc;

/// Entries of a chunk.
const CHUNK: u64 = 32;

const BYTES_PER_CHUNK: u64 = CHUNK * size_of::<u32>() as u64;

/// Chunks of a cluster for which there is room at first, of lists that hold each pair once and of those of both sides.
const FIRST_CHUNKS: [u64; 2] = [5, 8];

/// Clusters to a warp that adds both sides of pairs, where there are many: fewer and longer blocks share caches better,
/// and launches that are forbidden cost less.
const MOST_PER_WARP: usize = 8;

/// Warps below which there are not enough to share work among.
const ENOUGH_WARPS: usize = 25_000;

/// Lists for the particles in memory order, of everything within range and skin.
pub(crate) struct ClusterList {
    gpu: Arc<dyn Gpu>,
    skin: f32,
    /// How far particles may move while a list serves.
    limit: f32,
    segment: Buffer<Segment>,
    entry: Buffer<u32>,
    control: Buffer<ClusterControl>,
    valid: bool,
    /// Whether it holds each pair once.
    once: bool,
    /// Whether most clusters have nothing near them.
    sparse: bool,
    /// Whether it is known that there was room for the list.
    settled: bool,
    /// Whether the list serves the present positions, where that is known without looking at them.
    known: Option<bool>,
    /// Evaluations by the list.
    served: u64,
    /// Of lists since that was last asked for.
    together: Served,
}

/// What lists have served for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Served {
    pub lists: u64,
    /// Evaluations by these.
    pub evaluations: u64,
    /// Chunks of the last one.
    pub chunks: u64,
}

/// What came of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Outcome {
    /// Steps made.
    pub made: u64,
    /// Steps of these by the last list.
    pub by_last: u64,
    /// Lists that were made on the way.
    pub lists: u64,
    /// How many of these came after a single evaluation by the list before.
    pub dangerous: u64,
    /// Most steps by one list.
    pub longest: u64,
    /// Whether the last list serves the positions.
    pub fresh: bool,
}

/// What steps need beside the list.
pub(crate) struct StepQuery<'a> {
    pub physics: &'a Physics,
    pub state: &'a mut State,
    /// Room for positions or forces.
    pub spare: &'a mut Buffer<Float4>,
    pub integrator: Integrator,
    pub status: Ptr<Status>,
}

impl ClusterList {
    /// No list yet.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            gpu: gpu.clone(),
            skin: 0.0,
            limit: 0.0,
            segment: Buffer::new(gpu, "lists of clusters"),
            entry: Buffer::new(gpu, "lists of clusters"),
            control: Buffer::new(gpu, "lists of clusters"),
            valid: false,
            once: false,
            sparse: false,
            settled: false,
            known: None,
            served: 0,
            together: Served::default(),
        }
    }

    pub fn skin(&self) -> f32 {
        self.skin
    }

    /// Forgets the list; others will have this skin.
    pub fn set_skin(&mut self, skin: f32, physics: &Physics) {
        // The margins cover roundings of displacements and of coordinates.
        let limit = 0.5 * skin * (1.0 - 1e-5) - physics.slack;
        self.skin = if limit > 0.0 { skin } else { 0.0 };
        self.limit = limit.max(0.0);
        self.valid = false;
    }

    /// What lists have served for since this was last asked.
    pub fn take_served(&mut self) -> Served {
        std::mem::take(&mut self.together)
    }

    /// Whether there was room for the list, as far as is known.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Whether the list still holds every pair. Waits for the device unless the last steps were by the list.
    pub fn is_fresh(&mut self, physics: &Physics, state: &State, grid: &Grid) -> Result<bool> {
        let known = self.known.take();
        if !self.valid {
            return Ok(false);
        }
        if let Some(fresh) = known {
            return Ok(fresh);
        }
        if self.skin == 0.0 {
            return Ok(false);
        }
        let arguments = ClustersMovedArgs {
            space: physics.space,
            position: state.moving.position.ptr(),
            reference: grid.slots(),
            control: self.control.ptr(),
            n: state.len() as u32,
            limit2: self.limit * self.limit,
        };
        // SAFETY: the arrays have n elements each.
        unsafe { launch(&*self.gpu, kernels::CLUSTERS_MOVED, state.len() as u64, &arguments)? };
        Ok(self.read_control()?.rebuild_at > 0)
    }

    /// Makes room for a list of positions that the one before does not serve; each pair once, but where lists are sparse or
    /// `exact`: then from both sides. To be called before [`ClusterList::enqueue`].
    pub fn prepare(
        &mut self,
        state: &State,
        variant: Variant,
        exact: bool,
        budget: u64,
        report: &mut Report,
    ) -> Result<()> {
        self.sparse = variant == Variant::SparseList;
        self.once = !self.sparse && !exact;
        let first = state.len().div_ceil(CLUSTER) as u64 * FIRST_CHUNKS[usize::from(!self.once)];
        self.make_room(state, self.room().max(first).min(budget / BYTES_PER_CHUNK))?;
        report.list_builds += 1;
        if self.served == 1 && self.skin > 0.0 && report.list_builds > 1 {
            report.dangerous_builds += 1;
        }
        self.served = 0;
        self.together.lists += 1;
        (self.valid, self.settled) = (true, false);
        Ok(())
    }

    /// For who sorts the particles, which ends the list.
    pub fn control(&self) -> Ptr<ClusterControl> {
        self.control.ptr()
    }

    /// Waits for the list that is being built and builds it again where there was no room; gives whether it fits the
    /// budget.
    pub fn settle(&mut self, physics: &Physics, state: &State, grid: &Grid, budget: u64) -> Result<bool> {
        while !self.settled {
            let needed = u64::from(self.read_control()?.chunks);
            self.together.chunks = needed;
            if needed * BYTES_PER_CHUNK > budget {
                self.entry.resize(0)?;
                self.valid = false;
                self.known = None;
                return Ok(false);
            }
            self.settled = needed <= self.room();
            if !self.settled {
                // Lists of other moments may be longer.
                self.make_room(state, (needed + needed / 8).min(budget / BYTES_PER_CHUNK))?;
                let control = ClusterControlArgs { control: self.control(), ..Default::default() };
                // SAFETY: the list has a control block.
                unsafe { launch(&*self.gpu, kernels::BEGIN_LIST, 1, &control)? };
                self.enqueue(&*self.gpu, physics, state, grid)?;
            }
        }
        Ok(true)
    }

    /// Chunks that there is room for.
    fn room(&self) -> u64 {
        self.entry.len() as u64 / CHUNK
    }

    fn make_room(&mut self, state: &State, chunks: u64) -> Result<()> {
        self.entry.resize((chunks * CHUNK) as usize)?;
        self.segment.resize(state.len().div_ceil(CLUSTER) + chunks as usize / SEGMENT)?;
        if self.control.is_empty() {
            self.control.upload(&[ClusterControl::zeroed()])?;
        }
        Ok(())
    }

    /// Enqueues the listing of what is near each cluster of particles, which were just put in the order of `grid`, that was
    /// counted for range and skin. Whether there was room for it is seen later: by [`ClusterList::settle`], or at the end
    /// of steps.
    pub fn enqueue(&self, queue: &dyn Queue, physics: &Physics, state: &State, grid: &Grid) -> Result<()> {
        let n_clusters = state.len().div_ceil(CLUSTER);
        let arguments = ClusterListArgs {
            law: Law { cutoff: physics.law.cutoff + self.skin, ..physics.law },
            space: physics.space,
            grid: grid.layout_in_memory_order(state.moving.position.ptr()),
            segment: self.segment.ptr(),
            entry: self.entry.ptr(),
            control: self.control.ptr(),
            n: state.len() as u32,
            n_clusters: n_clusters as u32,
            capacity: self.room() as u32,
            segment_capacity: self.segment.len() as u32,
            slack: grid.slack(),
            margin: 0.5 * self.skin + physics.slack,
            once: u32::from(self.once),
            unused: 0,
        };
        let (kernel, threads) = if self.sparse { (LIST_SPARSE, state.len()) } else { (LIST_CLUSTERS, 32 * n_clusters) };
        // SAFETY: positions are n, sorted by the grid's cells; segments and entries have room for what is said.
        unsafe { launch(queue, kernel, threads as u64, &arguments) }
    }

    /// Whether forces are added to: they must be zero before.
    pub fn scatters(&self) -> bool {
        self.once
    }

    /// Enqueues the forces on all particles. Exact ones take lists of both sides.
    pub fn forces(
        &mut self,
        physics: &Physics,
        state: &State,
        results: Results,
        exact: bool,
        energy: bool,
    ) -> Result<()> {
        self.served += 1;
        self.together.evaluations += 1;
        let arguments = self.listed(physics, state, results);
        if self.once {
            return add_pairs(&*self.gpu, LISTED_PAIRS.choose(&physics.law, exact, energy), &arguments);
        }
        let kernel = LISTED_FORCES.choose(&physics.law, exact, energy);
        let n_clusters = state.len().div_ceil(CLUSTER) as u64;
        // SAFETY: particles and results are n, in the order that the list was made in.
        unsafe { launch(&*self.gpu, kernel, 32 * n_clusters, &arguments) }
    }

    /// Enqueues that steps begin at `step`, whose positions the list serves, and end before `end`.
    pub fn begin_steps(&self, query: &mut StepQuery, step: u64, end: u64) -> Result<()> {
        query.spare.resize(query.state.len())?;
        if self.once {
            query.spare.zero()?;
        }
        let arguments = ClusterControlArgs { control: self.control.ptr(), step, end };
        // SAFETY: the list has a control block.
        unsafe { launch(&*self.gpu, kernels::BEGIN_STEPS, 1, &arguments) }
    }

    /// Enqueues so many steps, or one more, from forces at the present positions on, of which those are done that the list
    /// serves for and that are not beyond the end.
    pub fn enqueue_steps(&self, queue: &dyn Queue, query: &StepQuery, grid: &Grid, steps: u64) -> Result<()> {
        let StepQuery { physics, state, spare, integrator, status } = query;
        let n = state.len() as u64;
        let force = if self.once { spare.ptr() } else { Ptr::NULL };
        let listed = ListedArgs {
            control: self.control.ptr(),
            ..self.listed(physics, state, Results { force, ..Results::default() })
        };
        let position = state.moving.position.ptr();
        let mut arguments = ClusterStepArgs {
            listed,
            integrator: *integrator,
            particles: state.particles(),
            next: position,
            reference: grid.slots(),
            status: *status,
            limit2: self.limit * self.limit,
            unused: 0,
        };
        // Positions that go to and fro are back after two steps.
        let steps = steps.next_multiple_of(if self.once { 1 } else { 2 });
        for index in 0..steps as u32 {
            arguments.listed.index = index;
            if self.once {
                add_pairs(queue, LISTED_PAIRS.choose(&physics.law, false, false), &arguments.listed)?;
                // SAFETY: all arrays of particles have n elements.
                unsafe { launch(queue, MOVE_LISTED.choose(integrator), n, &arguments)? };
                continue;
            }
            let (from, to) = if index % 2 == 0 { (position, spare.ptr()) } else { (spare.ptr(), position) };
            arguments.listed.gather.grid.slot = from;
            arguments.particles.position = from;
            arguments.next = to;
            let kernel = STEP_SPARSE.choose(integrator).choose(&physics.law, false, false);
            // SAFETY: as above.
            unsafe { launch(queue, kernel, n, &arguments)? };
        }
        Ok(())
    }

    /// Waits for the steps that were begun at `step`.
    pub fn finish_steps(&mut self, step: u64) -> Result<Outcome> {
        let control = self.read_control()?;
        self.settled = u64::from(control.chunks) <= self.room();
        let (made, by_last) = (control.next - step, control.next - control.first);
        self.served = if control.lists > 0 { by_last } else { self.served + by_last };
        self.together.lists += u64::from(control.lists);
        self.together.evaluations += made;
        self.together.chunks = control.chunks.into();
        // A list for which there was no room is of the present positions.
        let fresh = !self.settled || control.rebuild_at > control.next;
        self.known = Some(fresh);
        Ok(Outcome {
            made,
            by_last,
            lists: control.lists.into(),
            dangerous: if self.skin > 0.0 { control.dangerous.into() } else { 0 },
            longest: by_last.max(control.longest.into()),
            fresh,
        })
    }

    fn listed(&self, physics: &Physics, state: &State, results: Results) -> ListedArgs {
        let grid = layouts::Grid { n_classes: 1, slot: state.moving.position.ptr(), ..Default::default() };
        ListedArgs {
            gather: GatherArgs {
                law: physics.law,
                space: physics.space,
                grid,
                velocity: state.moving.velocity.ptr(),
                results,
                n: state.len() as u32,
                slack: 0.0,
            },
            segment: self.segment.ptr(),
            entry: self.entry.ptr(),
            control: Ptr::NULL,
            index: 0,
            clusters_per_warp: per_warp(state.len()) as u32,
        }
    }

    fn read_control(&self) -> Result<ClusterControl> {
        Ok(self.control.download()?.pop().unwrap_or_else(ClusterControl::zeroed))
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.segment.bytes() + self.entry.bytes() + self.control.bytes()
    }
}

/// Enqueues the addition of forces to zeros, from a list that holds each pair once.
fn add_pairs(queue: &dyn Queue, kernel: Kernel<ListedArgs>, arguments: &ListedArgs) -> Result<()> {
    let clusters = (arguments.gather.n as usize).div_ceil(CLUSTER);
    let warps = clusters.div_ceil(arguments.clusters_per_warp as usize);
    // SAFETY: particles and results are n, in the order that the list was made in.
    unsafe { launch(queue, kernel, 32 * warps as u64, arguments) }
}

/// Clusters that a warp takes of `n` particles.
fn per_warp(n: usize) -> usize {
    (n.div_ceil(CLUSTER) / ENOUGH_WARPS).clamp(1, MOST_PER_WARP)
}
