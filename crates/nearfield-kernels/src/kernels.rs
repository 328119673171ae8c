//! Every kernel, by the structure it takes.

use crate::{
    ByForce, ByMotion, Kernel, Primitive, RayProgram,
    layouts::{
        AdvanceRays, BodiesArgs, BoundsArgs, BoxesArgs, CellStepArgs, ClusterControlArgs, ClusterListArgs,
        ClusterStepArgs, ClustersMovedArgs, CopyRowsArgs, FinishExactArgs, FirstStepArgs, ForceRays, GatherArgs,
        IntegrateArgs, ListArgs, ListRays, ListedArgs, MortonArgs, MotionArgs, NumberArgs, PermuteArgs, QueryArgs,
        RescaleArgs, RowsArgs, SampleArgs, ScanArgs, SortArgs, SortParticlesArgs, StageArgs, TotalsArgs,
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
/// Input indices in the order of cells.
pub const NUMBER_SLOTS: Kernel<NumberArgs> = Kernel::new("cells", "number_slots", 256);

/// Particles that a warp takes at a time.
pub const CLUSTER: usize = 8;

/// Forces from candidates in cells; a warp for each [`CLUSTER`].
pub const CELL_FORCES: ByForce<Kernel<GatherArgs>> = ByForce {
    uniform_lj: Kernel::new("cell_forces", "cell_uniform", 128),
    scaled_lj: Kernel::new("cell_forces", "cell_scaled", 128),
    fast: Kernel::new("cell_forces", "cell_any", 128),
    energy: Kernel::new("cell_forces", "cell_any_energy", 128),
    exact: Kernel::new("cell_forces", "cell_exact", 128),
    exact_energy: Kernel::new("cell_forces", "cell_exact_energy", 128),
};

/// Forces and a step, by cells where most particles have no neighbours and one cutoff serves all pairs; a thread for each
/// particle. In f32 and without energies.
pub const CELL_STEP: ByMotion<ByForce<Kernel<CellStepArgs>>> =
    steps(Kernel::new("cell_step", "cell_step_uniform", 128), Kernel::new("cell_step", "cell_step_any", 128));

/// Says which step [`CELL_STEP`] begins with.
pub const BEGIN_CELL_STEPS: Kernel<FirstStepArgs> = Kernel::new("cell_step", "begin_cell_steps", 32);

/// Forces from candidates in cells, each pair found once and added to zeros, but for sums that do not depend on order.
pub const CLUSTER_FORCES: ByForce<Kernel<GatherArgs>> = ByForce {
    uniform_lj: Kernel::new("cluster_forces", "cluster_uniform", 128),
    scaled_lj: Kernel::new("cluster_forces", "cluster_scaled", 128),
    fast: Kernel::new("cluster_forces", "cluster_any", 128),
    energy: Kernel::new("cluster_forces", "cluster_any_energy", 128),
    ..CELL_FORCES
};

/// Lists of what is near each [`CLUSTER`].
pub const LIST_CLUSTERS: Kernel<ClusterListArgs> = Kernel::new("cluster_list", "list_clusters", 128);
/// The same where most lists are empty, of both sides, in cells that hold about one particle; a thread for each particle.
pub const LIST_SPARSE: Kernel<ClusterListArgs> = Kernel::new("sparse_list", "list_sparse", 128);
/// Most chunks of a segment of these lists but the last.
pub const SEGMENT: usize = 15;
/// Says which steps may be made by lists.
pub const BEGIN_STEPS: Kernel<ClusterControlArgs> = Kernel::new("cluster_list", "begin_steps", 32);
/// Notes how the list has served, and that there is none now.
pub const BEGIN_LIST: Kernel<ClusterControlArgs> = Kernel::new("cluster_list", "begin_list", 32);
/// The same, and particles in the order of cells: in place of [`CELL_SCATTER`] and [`PERMUTE`]. A thread at least.
pub const SORT_PARTICLES: Kernel<SortParticlesArgs> = Kernel::new("cluster_list", "sort_particles", 256);
/// Whether lists serve the present positions.
pub const CLUSTERS_MOVED: Kernel<ClustersMovedArgs> = Kernel::new("cluster_list", "clusters_moved", 256);

/// Forces from lists of clusters, where one cutoff serves all pairs; a warp for each [`CLUSTER`].
pub const LISTED_FORCES: ByForce<Kernel<ListedArgs>> = ByForce {
    uniform_lj: Kernel::new("listed_forces", "listed_uniform", 128),
    scaled_lj: Kernel::new("listed_forces", "listed_any", 128),
    fast: Kernel::new("listed_forces", "listed_any", 128),
    energy: Kernel::new("listed_forces", "listed_any_energy", 128),
    exact: Kernel::new("listed_forces", "listed_exact", 128),
    exact_energy: Kernel::new("listed_forces", "listed_exact_energy", 128),
};

/// The same from lists that hold each pair once, added to zeros, but for sums that do not depend on order.
pub const LISTED_PAIRS: ByForce<Kernel<ListedArgs>> = ByForce {
    uniform_lj: Kernel::new("listed_pairs", "pairs_uniform", 128),
    scaled_lj: Kernel::new("listed_pairs", "pairs_any", 128),
    fast: Kernel::new("listed_pairs", "pairs_any", 128),
    energy: Kernel::new("listed_pairs", "pairs_any_energy", 128),
    ..LISTED_FORCES
};
/// A step by the forces of [`LISTED_PAIRS`], which become zero.
pub const MOVE_LISTED: ByMotion<Kernel<ClusterStepArgs>> = ByMotion {
    newton: Kernel::new("listed_pairs", "move_listed", 256),
    any: Kernel::new("listed_pairs", "move_listed_any", 256),
};

/// Forces and a step, by lists most of which are empty; a thread for each particle. In f32 and without energies.
pub const STEP_SPARSE: ByMotion<ByForce<Kernel<ClusterStepArgs>>> =
    steps(Kernel::new("cluster_step", "step_sparse_uniform", 128), Kernel::new("cluster_step", "step_sparse_any", 128));

const fn steps<A>(uniform_lj: Kernel<A>, any: Kernel<A>) -> ByMotion<ByForce<Kernel<A>>> {
    let always = ByForce { fast: any, energy: any, exact: any, exact_energy: any, uniform_lj: any, scaled_lj: any };
    ByMotion { newton: ByForce { uniform_lj, ..always }, any: always }
}

/// Forces by testing all pairs; a warp for each [`CLUSTER`].
pub const BRUTE_FORCES: ByForce<Kernel<GatherArgs>> = ByForce {
    uniform_lj: Kernel::new("brute", "brute_uniform", 128),
    scaled_lj: Kernel::new("brute", "brute_scaled", 128),
    fast: Kernel::new("brute", "brute_any", 128),
    energy: Kernel::new("brute", "brute_any_energy", 128),
    exact: Kernel::new("brute", "brute_exact", 128),
    exact_energy: Kernel::new("brute", "brute_exact_energy", 128),
};

/// Kernels that list neighbours; a warp for each [`CLUSTER`].
#[derive(Clone, Copy)]
pub struct ListKernels {
    /// Entries of each row.
    pub count: Kernel<ListArgs>,
    /// The rows.
    pub fill: Kernel<ListArgs>,
}

/// Lists from candidates in cells where one cutoff serves all pairs.
pub const CELL_LIST: ListKernels = ListKernels {
    count: Kernel::new("lists", "cell_list_count", 128),
    fill: Kernel::new("lists", "cell_list_fill", 128),
};
/// The same lists of short rows, each found once: rows wherever there is room, then at their places.
pub const CELL_LIST_STAGE: Kernel<StageArgs> = Kernel::new("staged_lists", "cell_list_stage", 128);
/// Most entries of a row that is staged.
pub const STAGED_ROW: usize = 80;
/// Rows to their places; [`ROW_LANES`] threads for each.
pub const COPY_ROWS: Kernel<CopyRowsArgs> = Kernel::new("staged_lists", "copy_rows", 256);
/// Threads to a row.
pub const ROW_LANES: usize = 8;

/// Lists from candidates in cells where radii are per particle.
pub const CELL_LIST_RADII: ListKernels = ListKernels {
    count: Kernel::new("lists", "cell_list_count_radii", 128),
    fill: Kernel::new("lists", "cell_list_fill_radii", 128),
};
/// Lists by testing all pairs where one cutoff serves all.
pub const BRUTE_LIST: ListKernels = ListKernels {
    count: Kernel::new("lists", "brute_list_count", 128),
    fill: Kernel::new("lists", "brute_list_fill", 128),
};
/// Lists by testing all pairs where radii are per particle.
pub const BRUTE_LIST_RADII: ListKernels = ListKernels {
    count: Kernel::new("lists", "brute_list_count_radii", 128),
    fill: Kernel::new("lists", "brute_list_fill_radii", 128),
};

/// Entries of the row of each query among points in cells; a warp for each [`CLUSTER`].
pub const QUERY_COUNT: Kernel<QueryArgs> = Kernel::new("queries", "query_count", 128);
/// These rows.
pub const QUERY_FILL: Kernel<QueryArgs> = Kernel::new("queries", "query_fill", 128);

/// Boxes around particles and ghosts.
pub const FIT_BOXES: Kernel<BoxesArgs> = Kernel::new("boxes", "fit_boxes", 256);
/// Centres of spheres around particles and ghosts.
pub const FIT_SPHERES: Kernel<BodiesArgs> = Kernel::new("bodies", "fit_spheres", 256);
/// Triangles of squares around particles and ghosts.
pub const FIT_SQUARES: Kernel<BodiesArgs> = Kernel::new("bodies", "fit_squares", 256);
/// Triangles of the two squares around a particle.
pub const TRIANGLES_PER_PARTICLE: u32 = 4;
/// Faces of particles, and the number of ghosts.
pub const COUNT_GHOSTS: Kernel<BoxesArgs> = Kernel::new("ghosts", "count_ghosts", 256);
/// Mirror particles.
pub const MAKE_GHOSTS: Kernel<BoxesArgs> = Kernel::new("ghosts", "make_ghosts", 256);

/// Forces from rows of neighbours.
pub const ROWS: ByForce<Kernel<RowsArgs>> = ByForce {
    fast: Kernel::new("rows", "rows", 128),
    energy: Kernel::new("rows", "rows_energy", 128),
    exact: Kernel::new("rows", "rows_exact", 128),
    exact_energy: Kernel::new("rows", "rows_exact_energy", 128),
    uniform_lj: Kernel::new("rows", "rows_uniform_lj", 128),
    scaled_lj: Kernel::new("rows", "rows_scaled_lj", 128),
};
/// Threads that share a row of [`ROWS`].
pub const ROWS_LANES: u64 = 8;

/// Most words that a ray carries, as in `raytracing.cuh`.
pub const PAYLOAD_WORDS: u32 = 16;

const fn program<A: crate::Layout>(module: &'static str, name: &'static str) -> RayProgram<A> {
    RayProgram::new(module, Primitive::Box, name)
}

/// The programs of a module of `ray_gather.cuh`. There is no scaled Lennard-Jones, which is for per-particle radii.
const fn gather(module: &'static str, primitive: Primitive) -> ByForce<RayProgram<ForceRays>> {
    ByForce {
        fast: RayProgram::new(module, primitive, "gather"),
        energy: RayProgram::new(module, primitive, "gather_energy"),
        exact: RayProgram::new(module, primitive, "gather_exact"),
        exact_energy: RayProgram::new(module, primitive, "gather_exact_energy"),
        uniform_lj: RayProgram::new(module, primitive, "gather_uniform_lj"),
        scaled_lj: RayProgram::new(module, primitive, "gather"),
    }
}

/// Forces of all particles where one cutoff serves all pairs, by point rays through boxes.
pub const RAY_GATHER: ByForce<RayProgram<ForceRays>> = gather("ray_gather", Primitive::Box);
/// The same by axis rays through spheres.
pub const AXIS_GATHER: ByForce<RayProgram<ForceRays>> = gather("axis_gather", Primitive::Sphere);
/// The same by edge rays through squares.
pub const EDGE_GATHER: ByForce<RayProgram<ForceRays>> = gather("edge_gather", Primitive::Triangle);
/// Forces of all particles, added to zeros.
pub const RAY_SCATTER: ByForce<RayProgram<ForceRays>> = ByForce {
    fast: program("ray_scatter", "scatter"),
    energy: program("ray_scatter", "scatter_energy"),
    exact: program("ray_scatter", "scatter_exact"),
    exact_energy: program("ray_scatter", "scatter_exact_energy"),
    uniform_lj: program("ray_scatter", "scatter_uniform_lj"),
    scaled_lj: program("ray_scatter", "scatter_scaled_lj"),
};
/// Forces of all particles and a step of theirs, in f32.
pub const RAY_ADVANCE: RayProgram<AdvanceRays> = program("ray_advance", "advance");
/// The same in sums that do not depend on order.
pub const RAY_ADVANCE_EXACT: RayProgram<AdvanceRays> = program("ray_advance", "advance_exact");
/// The same in f32 for plain Lennard-Jones.
pub const RAY_ADVANCE_UNIFORM_LJ: RayProgram<AdvanceRays> = program("ray_advance", "advance_uniform_lj");
/// Entries of each row of neighbours, by point rays.
pub const RAY_COUNT: RayProgram<ListRays> = program("ray_list", "count");
/// Rows of neighbours, by point rays.
pub const RAY_FILL: RayProgram<ListRays> = program("ray_list", "fill");
/// Entries of each row of neighbours, by axis rays.
pub const AXIS_COUNT: RayProgram<ListRays> = RayProgram::new("axis_list", Primitive::Sphere, "count");
/// Rows of neighbours, by axis rays.
pub const AXIS_FILL: RayProgram<ListRays> = RayProgram::new("axis_list", Primitive::Sphere, "fill");
/// Entries of each row of neighbours, by edge rays.
pub const EDGE_COUNT: RayProgram<ListRays> = RayProgram::new("edge_list", Primitive::Triangle, "count");
/// Rows of neighbours, by edge rays.
pub const EDGE_FILL: RayProgram<ListRays> = RayProgram::new("edge_list", Primitive::Triangle, "fill");
