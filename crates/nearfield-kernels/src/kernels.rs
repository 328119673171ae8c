//! Every kernel, by the structure it takes.

use crate::{
    Kernel,
    layouts::{
        BoundsArgs, FinishExactArgs, IntegrateArgs, MortonArgs, MotionArgs, PermuteArgs, RescaleArgs, SampleArgs,
        ScanArgs, TotalsArgs,
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
