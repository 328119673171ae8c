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
/// Particles in cell order.
pub const CELL_SCATTER: Kernel<SortArgs> = Kernel::new("cells", "cell_scatter", 256);

/// The kernels of a method that sums forces, by what they are for.
pub struct ForceKernels {
    /// One type of Lennard-Jones and one cutoff, forces only.
    pub uniform: Kernel<GatherArgs>,
    /// One type of Lennard-Jones whose sigma is proportional to the range, forces only.
    pub scaled: Kernel<GatherArgs>,
    /// Any law, forces only.
    pub any: Kernel<GatherArgs>,
    /// Any law.
    pub any_energy: Kernel<GatherArgs>,
    /// Any law, sums independent of order, forces only.
    pub exact: Kernel<GatherArgs>,
    /// Any law, sums independent of order.
    pub exact_energy: Kernel<GatherArgs>,
}

macro_rules! force_kernels {
    ($module:literal, $prefix:literal) => {
        ForceKernels {
            uniform: Kernel::new($module, concat!($prefix, "_uniform"), 128),
            scaled: Kernel::new($module, concat!($prefix, "_scaled"), 128),
            any: Kernel::new($module, concat!($prefix, "_any"), 128),
            any_energy: Kernel::new($module, concat!($prefix, "_any_energy"), 128),
            exact: Kernel::new($module, concat!($prefix, "_exact"), 128),
            exact_energy: Kernel::new($module, concat!($prefix, "_exact_energy"), 128),
        }
    };
}

/// Forces by testing all pairs, a warp for each 8 particles.
pub const BRUTE_FORCES: ForceKernels = force_kernels!("brute", "brute");
/// Forces by cells, a warp for each 8 particles.
pub const CELL_FORCES: ForceKernels = force_kernels!("cell_forces", "cell");

/// Entries of each row, by testing all pairs.
pub const BRUTE_LIST_COUNT: Kernel<ListArgs> = Kernel::new("lists", "brute_list_count", 128);
/// Entries, by testing all pairs.
pub const BRUTE_LIST_FILL: Kernel<ListArgs> = Kernel::new("lists", "brute_list_fill", 128);
/// Entries of each row, by cells.
pub const CELL_LIST_COUNT: Kernel<ListArgs> = Kernel::new("lists", "cell_list_count", 128);
/// Entries, by cells.
pub const CELL_LIST_FILL: Kernel<ListArgs> = Kernel::new("lists", "cell_list_fill", 128);
