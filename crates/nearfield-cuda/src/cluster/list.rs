//! Lists of what is near each cluster, and forces and steps by them.

use crate::{
    Buffer, Gpu,
    engine::{physics::Physics, state::State},
    gpu::launch,
    grid::Grid,
};
use bytemuck::Zeroable;
use nearfield_core::{Report, Result};
use nearfield_kernels::{
    Float4, Kernel, Ptr,
    kernels::{self, CLUSTER, LISTED_FORCES, LISTED_PAIRS, SEGMENT, STEP_SPARSE},
    layouts::{
        self, ClusterControl, ClusterListArgs, ClusterStepArgs, ClustersMovedArgs, GatherArgs, Integrator, Law,
        ListedArgs, Results, Segment, Status,
    },
};
use std::sync::Arc;

/// Entries of a chunk.
const CHUNK: u64 = 32;

const BYTES_PER_CHUNK: u64 = CHUNK * size_of::<u32>() as u64;

/// Chunks of a cluster for which there is room at first, of lists that hold each pair once and of those of both sides.
const FIRST_CHUNKS: [u64; 2] = [5, 8];

/// Steps that a list is first thought to serve for.
const FIRST_LIFE: u64 = 8;

/// Steps enqueued beyond those that the list is thought to serve for: one that does nothing costs less than a wait.
const SPARE_STEPS: u64 = 2;

/// Most steps enqueued at a time.
const MOST_STEPS: u64 = 100;

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
    /// Whether it is known that there was room for the list.
    settled: bool,
    /// Whether the list serves the present positions, where that is known without looking at them.
    known: Option<bool>,
    /// Evaluations since the list was built.
    age: u64,
    /// Steps that the last list served for.
    life: u64,
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
    /// No list yet, with a skin as far as the box allows it: no pair may be within range and skin at two images.
    pub fn new(gpu: &Arc<dyn Gpu>, skin: f32, physics: &Physics) -> Self {
        let skin = skin.min(physics.sim_box.room_around(physics.largest)).max(0.0);
        // The margins cover roundings of displacements and of coordinates.
        let limit = 0.5 * skin * (1.0 - 1e-5) - physics.slack;
        Self {
            gpu: gpu.clone(),
            skin: if limit > 0.0 { skin } else { 0.0 },
            limit: limit.max(0.0),
            segment: Buffer::new(gpu, "lists of clusters"),
            entry: Buffer::new(gpu, "lists of clusters"),
            control: Buffer::new(gpu, "lists of clusters"),
            valid: false,
            once: false,
            settled: false,
            known: None,
            age: 0,
            life: FIRST_LIFE,
        }
    }

    pub fn skin(&self) -> f32 {
        self.skin
    }

    /// Forgets the list.
    pub fn invalidate(&mut self) {
        self.valid = false;
    }

    /// Whether the list still holds every pair. Waits for the device unless the last steps were by the list.
    pub fn is_fresh(&mut self, physics: &Physics, state: &State, grid: &Grid) -> Result<bool> {
        self.age += 1;
        let known = self.known.take();
        if !self.valid || self.skin == 0.0 {
            return Ok(false);
        }
        if let Some(fresh) = known {
            return Ok(fresh);
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
        Ok(self.control()?.rebuild_at > 0)
    }

    /// Enqueues the listing of what is near each cluster of particles in the order of `grid`, which was built for range
    /// and skin; each pair `once` or from both sides. Whether there was room for it is seen later: by
    /// [`ClusterList::settle`], or at the end of steps.
    pub fn build(
        &mut self,
        physics: &Physics,
        state: &State,
        grid: &Grid,
        once: bool,
        budget: u64,
        report: &mut Report,
    ) -> Result<()> {
        self.once = once;
        let first = state.len().div_ceil(CLUSTER) as u64 * FIRST_CHUNKS[usize::from(!once)];
        self.enqueue(physics, state, grid, self.room().max(first).min(budget / BYTES_PER_CHUNK))?;
        report.list_builds += 1;
        if self.age == 1 && self.skin > 0.0 && report.list_builds > 1 {
            report.dangerous_builds += 1;
        }
        self.life = self.age.max(1);
        self.age = 0;
        (self.valid, self.settled) = (true, false);
        Ok(())
    }

    /// Waits for the list that is being built and builds it again where there was no room; gives whether it fits the
    /// budget.
    pub fn settle(&mut self, physics: &Physics, state: &State, grid: &Grid, budget: u64) -> Result<bool> {
        while !self.settled {
            let needed = u64::from(self.control()?.chunks);
            if needed * BYTES_PER_CHUNK > budget {
                self.entry.resize(0)?;
                self.valid = false;
                return Ok(false);
            }
            self.settled = needed <= self.room();
            if !self.settled {
                // Lists of other moments may be longer.
                self.enqueue(physics, state, grid, (needed + needed / 8).min(budget / BYTES_PER_CHUNK))?;
            }
        }
        Ok(true)
    }

    /// Chunks that there is room for.
    fn room(&self) -> u64 {
        self.entry.len() as u64 / CHUNK
    }

    /// Enqueues the listing with room for so many chunks.
    fn enqueue(&mut self, physics: &Physics, state: &State, grid: &Grid, room: u64) -> Result<()> {
        let n_clusters = state.len().div_ceil(CLUSTER);
        self.entry.resize((room * CHUNK) as usize)?;
        self.segment.resize(n_clusters + room as usize / SEGMENT)?;
        let nothing_yet = ClusterControl { rebuild_at: u64::MAX, done: u64::MAX, ..ClusterControl::zeroed() };
        self.control.upload(&[nothing_yet])?;
        let arguments = ClusterListArgs {
            law: Law { cutoff: physics.law.cutoff + self.skin, ..physics.law },
            space: physics.space,
            grid: grid.layout_in_memory_order(state.moving.position.ptr()),
            segment: self.segment.ptr(),
            entry: self.entry.ptr(),
            control: self.control.ptr(),
            n: state.len() as u32,
            n_clusters: n_clusters as u32,
            capacity: room as u32,
            segment_capacity: self.segment.len() as u32,
            slack: grid.slack(),
            margin: 0.5 * self.skin + physics.slack,
            once: u32::from(self.once),
            unused: 0,
        };
        // SAFETY: positions are n, sorted by the grid's cells; segments and entries have room for what is said.
        unsafe { launch(&*self.gpu, kernels::LIST_CLUSTERS, 32 * n_clusters as u64, &arguments) }
    }

    /// Whether forces are added to: they must be zero before.
    pub fn scatters(&self) -> bool {
        self.once
    }

    /// Enqueues the forces on all particles. Exact ones take lists of both sides.
    pub fn forces(&self, physics: &Physics, state: &State, results: Results, exact: bool, energy: bool) -> Result<()> {
        let arguments = self.listed(physics, state, results, 0);
        if self.once {
            return self.add_pairs(LISTED_PAIRS.choose(&physics.law, exact, energy), state.len(), &arguments);
        }
        let kernel = LISTED_FORCES.choose(&physics.law, exact, energy);
        let n_clusters = state.len().div_ceil(CLUSTER) as u64;
        // SAFETY: particles and results are n, in the order that the list was made in.
        unsafe { launch(&*self.gpu, kernel, 32 * n_clusters, &arguments) }
    }

    /// Makes steps from forces at `step` on, at most `most`, at positions that the list serves; waits for the device to
    /// know how many there were. None are made where there was no room for the list: it is to be settled first.
    pub fn steps(&mut self, query: StepQuery, grid: &Grid, step: u64, most: u64) -> Result<u64> {
        let StepQuery { physics, state, spare, integrator, status } = query;
        let n = state.len();
        spare.resize(n)?;
        if self.once {
            spare.zero()?;
        }
        let asked = (self.life.saturating_sub(self.age) + SPARE_STEPS).clamp(1, MOST_STEPS.min(most));
        for step in step..step + asked {
            let force = if self.once { spare.ptr() } else { Ptr::NULL };
            let arguments = ClusterStepArgs {
                listed: self.listed(physics, state, Results { force, ..Results::default() }, step),
                integrator,
                particles: state.particles(),
                next: if self.once { state.moving.position.ptr() } else { spare.ptr() },
                reference: grid.slots(),
                status,
                limit2: self.limit * self.limit,
                unused: 0,
            };
            if self.once {
                self.add_pairs(LISTED_PAIRS.choose(&physics.law, false, false), n, &arguments.listed)?;
                // SAFETY: all arrays of particles have n elements.
                unsafe { launch(&*self.gpu, kernels::MOVE_LISTED, n as u64, &arguments)? };
            } else {
                // SAFETY: as above.
                unsafe { launch(&*self.gpu, STEP_SPARSE.choose(&physics.law, false, false), n as u64, &arguments)? };
                std::mem::swap(&mut state.moving.position, spare);
            }
        }
        let ClusterControl { rebuild_at, done, chunks, .. } = self.control()?;
        self.settled = u64::from(chunks) <= self.room();
        // Without particles nothing is done, and nothing is to do.
        let made = match (n, self.settled) {
            (0, _) => asked,
            (_, true) => done - step + 1,
            (_, false) => 0,
        };
        if !self.once && (asked - made) % 2 == 1 {
            std::mem::swap(&mut state.moving.position, spare);
        }
        if made == 0 {
            return Ok(0);
        }
        self.known = Some(rebuild_at > step + made);
        // The first evaluation was booked when freshness was asked for.
        self.age += made - 1;
        Ok(made)
    }

    /// Enqueues the addition of forces to zeros, from a list that holds each pair once, unless the list does not serve.
    fn add_pairs(&self, kernel: Kernel<ListedArgs>, n: usize, arguments: &ListedArgs) -> Result<()> {
        let clusters = n.div_ceil(CLUSTER);
        // SAFETY: particles and results are n, in the order that the list was made in.
        unsafe { launch(&*self.gpu, kernel, 32 * clusters.div_ceil(per_warp(n)) as u64, arguments) }
    }

    fn listed(&self, physics: &Physics, state: &State, results: Results, step: u64) -> ListedArgs {
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
            control: self.control.ptr(),
            step,
            clusters_per_warp: per_warp(state.len()) as u32,
            unused: 0,
        }
    }

    fn control(&self) -> Result<ClusterControl> {
        Ok(self.control.download()?.pop().unwrap_or_else(ClusterControl::zeroed))
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.segment.bytes() + self.entry.bytes() + self.control.bytes()
    }
}

/// Clusters that a warp takes of `n` particles.
fn per_warp(n: usize) -> usize {
    (n.div_ceil(CLUSTER) / ENOUGH_WARPS).clamp(1, MOST_PER_WARP)
}
