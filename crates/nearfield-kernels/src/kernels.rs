//! Every kernel, by the structure it takes.

use crate::{
    Kernel,
    layouts::{
        BoundsArgs, FinishExactArgs, GatherArgs, IntegrateArgs, ListArgs, MortonArgs, MotionArgs, PermuteArgs,
        RescaleArgs, SampleArgs, ScanArgs, SortArgs, TotalsArgs,
    },
};

/// Half kicks and drift.
pub const INTEGRATE: Kernel<IntegrateArgs> = Kernel::new("integrate", "integrate", 256);

/// Sums over particles by block.
pub const TOTALS: Kernel<TotalsArgs> = Kernel::new("totals", "totals", 256);
/// Sums over the blocks of [`TOTALS`], in one block.
pub const TOTALS_OF_BLOCKS: Kernel<TotalsArgs> = Kernel::new("totals", "totals_of_blocks", 256);
/// Velocity rescaling.
pub const RESCALE: Kernel<RescaleArgs> = Kernel::new("totals", "rescale", 256);
/// Distances moved.
pub const MOTION: Kernel<MotionArgs> = Kernel::new("totals", "motion", 256);

/// Particles by cell along the Morton curve.
pub const MORTON_COUNT: Kernel<MortonArgs> = Kernel::new("order", "morton_count", 256);
/// The order along the Morton curve.
pub const MORTON_SCATTER: Kernel<MortonArgs> = Kernel::new("order", "morton_scatter", 256);
/// Bounds of positions.
pub const BOUNDS: Kernel<BoundsArgs> = Kernel::new("order", "bounds", 256);
/// Positions at even strides.
pub const SAMPLE: Kernel<SampleArgs> = Kernel::new("order", "sample", 256);
/// Particles in another order.
pub const PERMUTE: Kernel<PermuteArgs> = Kernel::new("order", "permute", 256);
/// Order-independent sums as numbers.
pub const FINISH_EXACT: Kernel<FinishExactArgs> = Kernel::new("order", "finish_exact", 256);

/// Exclusive prefix sums in 32 bits.
pub const SCAN_U32: Kernel<ScanArgs> = Kernel::new("scan", "scan_u32", 256);
/// Exclusive prefix sums in 64 bits.
pub const SCAN_U64: Kernel<ScanArgs> = Kernel::new("scan", "scan_u64", 256);
/// Counts that a block of the scans takes.
pub const SCAN_TILE: usize = 2048;

/// Particles by cell.
pub const CELL_COUNT: Kernel<SortArgs> = Kernel::new("cells", "cell_count", 256);
/// Particles in the order of cells.
pub const CELL_SCATTER: Kernel<SortArgs> = Kernel::new("cells", "cell_scatter", 256);

/// Kernels for the forces on all particles by one way to find candidates; a warp for each [`CLUSTER`].
#[derive(Clone, Copy)]
pub struct ForceKernels {
    /// Lennard-Jones of one type and one cutoff, not shifted in force.
    pub uniform: Kernel<GatherArgs>,
    /// Lennard-Jones of one type and a radius for each particle, not shifted in force.
    pub scaled: Kernel<GatherArgs>,
    /// Any law.
    pub any: Kernel<GatherArgs>,
    /// Any law, with energies, virials and neighbour counts.
    pub any_energy: Kernel<GatherArgs>,
    /// Any law in sums that do not depend on order.
    pub exact: Kernel<GatherArgs>,
    /// The same with energies, virials and neighbour counts.
    pub exact_energy: Kernel<GatherArgs>,
}

/// Particles that a warp takes at a time.
pub const CLUSTER: usize = 8;

/// Candidates from cells.
pub const CELL_FORCES: ForceKernels = ForceKernels {
    uniform: Kernel::new("cell_forces", "cell_uniform", 128),
    scaled: Kernel::new("cell_forces", "cell_scaled", 128),
    any: Kernel::new("cell_forces", "cell_any", 128),
    any_energy: Kernel::new("cell_forces", "cell_any_energy", 128),
    exact: Kernel::new("cell_forces", "cell_exact", 128),
    exact_energy: Kernel::new("cell_forces", "cell_exact_energy", 128),
};

/// All particles as candidates.
pub const BRUTE_FORCES: ForceKernels = ForceKernels {
    uniform: Kernel::new("brute", "brute_uniform", 128),
    scaled: Kernel::new("brute", "brute_scaled", 128),
    any: Kernel::new("brute", "brute_any", 128),
    any_energy: Kernel::new("brute", "brute_any_energy", 128),
    exact: Kernel::new("brute", "brute_exact", 128),
    exact_energy: Kernel::new("brute", "brute_exact_energy", 128),
};

/// Neighbours of each particle, counted.
pub const CELL_LIST_COUNT: Kernel<ListArgs> = Kernel::new("lists", "cell_list_count", 128);
/// Neighbours of each particle, listed.
pub const CELL_LIST_FILL: Kernel<ListArgs> = Kernel::new("lists", "cell_list_fill", 128);
/// Neighbours of each particle, counted by testing all pairs.
pub const BRUTE_LIST_COUNT: Kernel<ListArgs> = Kernel::new("lists", "brute_list_count", 128);
/// Neighbours of each particle, listed by testing all pairs.
pub const BRUTE_LIST_FILL: Kernel<ListArgs> = Kernel::new("lists", "brute_list_fill", 128);
