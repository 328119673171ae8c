//! Forces and neighbour lists, by cells or by testing all pairs.

use super::{Grid, staged};
use crate::{
    DeviceList,
    gpu::{Queue, launch},
};
use nearfield_core::{ListKind, Result};
use nearfield_kernels::{
    Float4, Ptr,
    kernels::{self, CELL_FORCES, CLUSTER, CLUSTER_FORCES, ListKernels},
    layouts::{self, Box3, GatherArgs, Law, ListArgs, NumberArgs, Results},
};

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
    pub(super) fn threads(&self) -> u64 {
        let partial = self.layout().n_classes.saturating_sub(1);
        32 * (self.n().div_ceil(CLUSTER) as u64 + u64::from(partial))
    }

    /// Whether results are added to: they must be zero before, and order-independent sums be finished after.
    pub fn scatters(&self, pairs: Pairs) -> bool {
        matches!(self, Self::Cells(grid) if grid.has_classes() || pairs == Pairs::Once)
    }
}

/// How often pairs of one class are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairs {
    /// From both sides, each of which sums its own force.
    Directed,
    /// Once, and added to both particles: less work, but sums depend on order. In cells only.
    Once,
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
    /// Sums that do not depend on order; pairs are directed then.
    pub exact: bool,
    /// How often pairs are found.
    pub pairs: Pairs,
}

/// Enqueues the forces on all particles.
///
/// # Safety
/// Addresses in `query` and `candidates` are of as many particles as `candidates` has.
///
/// # Errors
/// As [`Queue::launch`].
pub unsafe fn forces(queue: &dyn Queue, candidates: Candidates, query: &ForceQuery) -> Result<()> {
    let family = match candidates {
        Candidates::Cells(_) if query.pairs == Pairs::Once => CLUSTER_FORCES,
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
    unsafe { launch(queue, kernel, candidates.threads(), &arguments) }
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

/// Counts the neighbours of all particles, by input index.
///
/// # Safety
/// Addresses in `query` and `candidates` are of as many particles as `candidates` has; input indices are below that,
/// each once.
///
/// # Errors
/// As [`crate::Gpu::allocate`] and [`Queue::launch`].
pub unsafe fn count(queue: &dyn Queue, candidates: Candidates, query: &ListQuery, list: &mut DeviceList) -> Result<()> {
    list.start(candidates.n())?;
    if let Candidates::Cells(grid) = candidates {
        // SAFETY: the caller's promise.
        unsafe { number_slots(queue, grid, query.id, list)? };
    }
    let kernel = list_kernels(candidates, query).count;
    // SAFETY: the caller's promise, and a count for each row.
    unsafe { launch(queue, kernel, candidates.threads(), &arguments(candidates, query, list)) }
}

/// Enqueues the input indices of slots, from those of places.
///
/// # Safety
/// `id` is the address of an index for each particle of the cells.
pub(super) unsafe fn number_slots(queue: &dyn Queue, grid: &Grid, id: Ptr<u32>, list: &mut DeviceList) -> Result<()> {
    list.number.resize(grid.n)?;
    let (particle, number) = (grid.particle.ptr(), list.number.ptr());
    let arguments = NumberArgs { particle, id, number, n: grid.n as u32, unused: 0 };
    // SAFETY: the caller's promise, and a number for each slot.
    unsafe { launch(queue, kernels::NUMBER_SLOTS, grid.n as u64, &arguments) }
}

/// Lists the neighbours of all particles, by input index; waits for the device once, to know how many there are.
///
/// # Safety
/// As [`count`].
///
/// # Errors
/// As [`count`].
pub unsafe fn list(queue: &dyn Queue, candidates: Candidates, query: &ListQuery, list: &mut DeviceList) -> Result<()> {
    list.at_once = match candidates {
        // SAFETY: the caller's promise.
        Candidates::Cells(grid) => unsafe { staged::list(queue, grid, query, list)? },
        Candidates::All { .. } => false,
    };
    if list.at_once {
        return Ok(());
    }
    // SAFETY: the caller's promise.
    unsafe { count(queue, candidates, query, list)? };
    let entries = list.place_rows()?;
    list.make_room(entries, query.images)?;
    let kernel = list_kernels(candidates, query).fill;
    // SAFETY: the same pairs are found again, for which there is room.
    unsafe { launch(queue, kernel, candidates.threads(), &arguments(candidates, query, list)) }
}

fn list_kernels(candidates: Candidates, query: &ListQuery) -> ListKernels {
    match (candidates, query.law.variable != 0) {
        (Candidates::Cells(_), false) => kernels::CELL_LIST,
        (Candidates::Cells(_), true) => kernels::CELL_LIST_RADII,
        (Candidates::All { .. }, false) => kernels::BRUTE_LIST,
        (Candidates::All { .. }, true) => kernels::BRUTE_LIST_RADII,
    }
}

pub(super) fn arguments(candidates: Candidates, query: &ListQuery, list: &DeviceList) -> ListArgs {
    ListArgs {
        law: query.law,
        space: query.space,
        grid: candidates.layout(),
        id: if let Candidates::Cells(_) = candidates { list.number.ptr() } else { query.id },
        count: list.count.ptr(),
        offset: list.offset.ptr(),
        index: list.index.ptr(),
        image: list.image.ptr(),
        n: candidates.n() as u32,
        half: u32::from(query.kind == ListKind::Half),
        slack: candidates.slack(),
        unused: 0,
    }
}
