//! Forces and neighbour lists, by cells or by testing all pairs.

use super::Grid;
use crate::{Buffer, Gpu, gpu::launch, scan::Scan};
use nearfield_core::{ListKind, Result};
use nearfield_kernels::{
    Float4, Ptr,
    kernels::{self, CELL_FORCES, CLUSTER},
    layouts::{self, Box3, GatherArgs, Law, ListArgs, Results},
};
use std::sync::Arc;

/// Where candidates come from.
#[derive(Clone, Copy)]
pub enum Candidates<'a> {
    /// Cells that were built from the present positions.
    Cells(&'a Grid),
    /// All particles.
    All {
        /// Their positions, with radii in w where they are per particle.
        position: Ptr<Float4>,
        /// How many there are.
        n: usize,
    },
}

impl Candidates<'_> {
    fn n(&self) -> usize {
        match self {
            Self::Cells(grid) => grid.n,
            Self::All { n, .. } => *n,
        }
    }

    fn layout(&self) -> layouts::Grid {
        match self {
            Self::Cells(grid) => grid.layout(),
            Self::All { position, .. } => layouts::Grid { n_classes: 1, slot: *position, ..Default::default() },
        }
    }

    fn slack(&self) -> f32 {
        match self {
            Self::Cells(grid) => grid.plan.slack,
            Self::All { .. } => 0.0,
        }
    }

    /// One warp for each cluster; clusters do not straddle classes.
    fn threads(&self) -> u64 {
        let partial = self.layout().n_classes.saturating_sub(1);
        32 * (self.n().div_ceil(CLUSTER) as u64 + u64::from(partial))
    }

    /// Whether results are added to: they must be zero before, and order-independent sums be finished after.
    pub fn scatters(&self) -> bool {
        matches!(self, Self::Cells(grid) if grid.has_classes())
    }
}

/// What pairs do, and where their forces go.
#[derive(Clone, Copy, Debug)]
pub struct ForceQuery {
    /// The interaction.
    pub law: Law,
    /// The box.
    pub space: Box3,
    /// Velocities in memory order, for types in w.
    pub velocity: Ptr<Float4>,
    /// Where results go, in memory order.
    pub results: Results,
    /// Energies, virials and neighbour counts too.
    pub energy: bool,
    /// Sums that do not depend on order.
    pub exact: bool,
}

/// Enqueues the forces on all particles.
///
/// # Safety
/// Addresses in `query` and `candidates` are of as many particles as `candidates` has.
///
/// # Errors
/// As [`Gpu::launch`].
pub unsafe fn forces(gpu: &dyn Gpu, candidates: Candidates, query: &ForceQuery) -> Result<()> {
    let family = match candidates {
        Candidates::Cells(_) => CELL_FORCES,
        Candidates::All { .. } => kernels::BRUTE_FORCES,
    };
    let kernel = family.choose(&query.law, query.exact, query.energy);
    let arguments = GatherArgs {
        law: query.law,
        space: query.space,
        grid: candidates.layout(),
        velocity: query.velocity,
        results: query.results,
        n: candidates.n() as u32,
        slack: candidates.slack(),
    };
    // SAFETY: the caller's promise.
    unsafe { launch(gpu, kernel, candidates.threads(), &arguments) }
}

/// What is listed.
#[derive(Clone, Copy, Debug)]
pub struct ListQuery {
    /// The interaction, for ranges.
    pub law: Law,
    /// The box.
    pub space: Box3,
    /// Input index of each place.
    pub id: Ptr<u32>,
    /// Full rows, or only neighbours of larger input index.
    pub kind: ListKind,
    /// Whether the periodic image of each neighbour is stored.
    pub images: bool,
}

/// Neighbour lists on the device, by input index.
pub struct DeviceList {
    gpu: Arc<dyn Gpu>,
    count: Buffer<u32>,
    /// Row starts, `[n + 1]`.
    pub offset: Buffer<u64>,
    /// Neighbours, in no particular order within a row.
    pub index: Buffer<u32>,
    /// Periodic images, 13 being home; empty unless asked for.
    pub image: Buffer<u8>,
    scan: Scan,
}

impl DeviceList {
    /// Without rows yet.
    pub fn new(gpu: &Arc<dyn Gpu>) -> Self {
        Self {
            gpu: gpu.clone(),
            count: Buffer::new(gpu, "neighbour counts"),
            offset: Buffer::new(gpu, "rows of the neighbour list"),
            index: Buffer::new(gpu, "the neighbour list"),
            image: Buffer::new(gpu, "images of the neighbour list"),
            scan: Scan::new(gpu),
        }
    }

    /// Lists all neighbours; waits for the device once, to know how many there are.
    ///
    /// # Safety
    /// Addresses in `query` and `candidates` are of as many particles as `candidates` has; input indices are below
    /// that, each once.
    ///
    /// # Errors
    /// As [`Gpu::allocate`] and [`Gpu::launch`].
    pub unsafe fn fill(&mut self, candidates: Candidates, query: &ListQuery) -> Result<()> {
        let n = candidates.n();
        let kernels = match (candidates, query.law.variable != 0) {
            (Candidates::Cells(_), false) => kernels::CELL_LIST,
            (Candidates::Cells(_), true) => kernels::CELL_LIST_RADII,
            (Candidates::All { .. }, false) => kernels::BRUTE_LIST,
            (Candidates::All { .. }, true) => kernels::BRUTE_LIST_RADII,
        };
        self.count.resize(n)?;
        self.count.zero()?;
        let mut arguments = ListArgs {
            law: query.law,
            space: query.space,
            grid: candidates.layout(),
            id: query.id,
            count: self.count.ptr(),
            n: n as u32,
            half: u32::from(query.kind == ListKind::Half),
            slack: candidates.slack(),
            ..Default::default()
        };
        // SAFETY: the caller's promise, and a count for each row.
        unsafe { launch(&*self.gpu, kernels.count, candidates.threads(), &arguments)? };
        self.scan.run_wide(&self.count, &mut self.offset)?;
        let entries = self.offset.download_range(n, 1)?[0] as usize;
        self.index.resize_with_room(entries)?;
        self.image.resize_with_room(if query.images { entries } else { 0 })?;
        (arguments.offset, arguments.index, arguments.image) = (self.offset.ptr(), self.index.ptr(), self.image.ptr());
        // SAFETY: the same pairs are found again, for which there is room.
        unsafe { launch(&*self.gpu, kernels.fill, candidates.threads(), &arguments) }
    }

    /// Bytes held on the device.
    pub fn bytes(&self) -> u64 {
        self.count.bytes() + self.offset.bytes() + self.index.bytes() + self.image.bytes() + self.scan.bytes()
    }
}
