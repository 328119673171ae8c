// Generated from nearfield-kernels/src/layouts by `cargo xtask ptx`; edit there.

#pragma once

#include "base.cuh"

// The orthorhombic box. Periodic image `c` of 27 is `(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1)` box lengths away, so
// 13 is the box itself.
struct Box3 {
    // Lower corner.
    float lo[3];
    // Upper corner.
    float hi[3];
    // Edge lengths, rounded to f32: periodic shifts are multiples of these.
    float length[3];
    // Of each axis: 0 periodic, 1 wall, 2 open.
    u32 boundary[3];
};
static_assert(sizeof(Box3) == 48, "Box3 differs between host and device");

// Potential, truncation and parameters of pairs.
struct Law {
    // 0 Lennard-Jones, 1 WCA, 2 Yukawa, 3 Morse, 4 Gaussian, 5 table.
    u32 potential;
    // 0 cut, 1 energy shifted, 2 force shifted.
    u32 truncation;
    // Number of particle types.
    u32 n_types;
    // 1 where radii are per particle, 0 where one cutoff serves all pairs.
    u32 variable;
    // The one cutoff.
    float cutoff;
    // Sigma of a pair over its range, where radii are per particle.
    float sigma_per_range;
    // Upper limit of f/r and of a pair's energy; infinite unless overlaps are allowed.
    float cap;
    // Kappa of Yukawa, alpha of Morse.
    float parameter;
    // 48 epsilon sigma^12 of the only type, for the uniform Lennard-Jones kernel; epsilon for the scaled one.
    float lj_repulsion;
    // 24 epsilon sigma^6 of the only type.
    float lj_attraction;
    // First distance of the table over sigma.
    float table_start;
    // Last distance of the table over sigma.
    float table_end;
    // Intervals of the table per sigma.
    float table_per_sigma;
    // Number of intervals of the table.
    u32 table_intervals;
    // Quanta of order-independent sums in a unit of force, a power of two.
    float force_quanta;
    // Quanta of order-independent sums in a unit of energy, a power of two.
    float energy_quanta;
    // Epsilon, sigma, energy shift and force shift by pair of types, row-major; sigma and shifts are unused where
    // radii are per particle.
    float4 *pairs;
    // Polynomial coefficients of U over epsilon in each interval of the table, in fractions of the interval.
    float4 *table_energy;
    // The same of the force times sigma over epsilon; the fourth is zero.
    float4 *table_force;
};
static_assert(sizeof(Law) == 88, "Law differs between host and device");

// Where forces and energies of particles go, in memory order. Scattering methods add to zeroed arrays; exact sums
// go to `exact` instead and are converted afterwards.
struct Results {
    // Forces, `[n]`.
    float4 *force;
    // Half of the energies of each particle's pairs, `[n]`.
    double *energy;
    // Half of the virials of each particle's pairs, `[n]`.
    double *virial;
    // Number of neighbours, `[n]`.
    u32 *neighbors;
    // Sums in quanta: force x, y, z, energy, virial of each particle, `[5][n]`; the last two only with energies.
    i64 *exact;
};
static_assert(sizeof(Results) == 40, "Results differs between host and device");

// The particles in memory order.
struct Particles {
    // Position; w is the radius where radii are per particle.
    float4 *position;
    // Velocity; the bits of w are the type.
    float4 *velocity;
    // Box crossings, `[n][3]`.
    i32 *image;
    // Input index of each particle.
    u32 *id;
    // Number of particles.
    u32 n;
    // Zero.
    u32 unused;
};
static_assert(sizeof(Particles) == 40, "Particles differs between host and device");

// What went wrong first: `step << 32 | id` of the least step and id, all ones while nothing did.
struct Status {
    // A force is not finite.
    u64 force;
    // A coordinate is not finite.
    u64 position;
};
static_assert(sizeof(Status) == 16, "Status differs between host and device");

// Velocity Verlet and its thermostats.
struct Integrator {
    // The box.
    Box3 space;
    // Time step.
    float dt;
    // Largest speed, from the displacement limit; infinite without.
    float speed_limit;
    // 1 for Langevin dynamics.
    u32 langevin;
    // exp(-friction dt).
    float damping;
    // Seed of the thermostat, low and high half.
    u32 seed[2];
    // Half a time step over the mass, by type.
    float *half_kick;
    // Standard deviation of Langevin noise, by type.
    float *noise;
};
static_assert(sizeof(Integrator) == 88, "Integrator differs between host and device");

// Arguments of `integrate`.
struct IntegrateArgs {
    // How.
    Integrator integrator;
    // The particles.
    Particles particles;
    // Forces at the present positions.
    float4 *force;
    // What went wrong.
    Status *status;
    // The step that the forces belong to.
    u64 step;
    // 1 for the second half kick of `step`.
    u32 finish;
    // 1 for the first half kick and the drift of the step after.
    u32 start;
};
static_assert(sizeof(IntegrateArgs) == 160, "IntegrateArgs differs between host and device");

// Sums over particles.
struct TotalSums {
    // Kinetic energy.
    double kinetic;
    // Total momentum.
    double momentum[3];
    // Largest squared force.
    double max_force2;
    // Potential energy.
    double potential;
    // Virial.
    double virial;
    // Neighbours of all particles.
    u64 neighbors;
};
static_assert(sizeof(TotalSums) == 64, "TotalSums differs between host and device");

// Arguments of `totals`: sums over particles in input order, so that they do not depend on memory order.
struct TotalsArgs {
    // The particles.
    Particles particles;
    // Place of each input index.
    u32 *place;
    // Mass by type.
    double *mass;
    // Forces and energies; null members are left out.
    Results results;
    // Sums of each block, then of all, `[blocks + 1]`.
    TotalSums *sums;
    // What went wrong.
    Status *status;
    // Step the forces belong to.
    u64 step;
};
static_assert(sizeof(TotalsArgs) == 120, "TotalsArgs differs between host and device");

// Arguments of `rescale`: velocity rescaling after a step (Bussi, Donadio and Parrinello, 2007).
struct RescaleArgs {
    // The particles.
    Particles particles;
    // The sums whose kinetic energy counts.
    TotalSums *sums;
    // Standard normal draws of the batch of steps.
    double *normal;
    // Chi-squared draws of the batch of steps.
    double *chi_squared;
    // Target temperature.
    double temperature;
    // exp(-dt / relaxation time).
    double decay;
    // Which draw.
    u64 index;
};
static_assert(sizeof(RescaleArgs) == 88, "RescaleArgs differs between host and device");

// Arguments of `motion`: how far particles have moved from remembered positions.
struct MotionArgs {
    // The particles.
    Particles particles;
    // Box lengths.
    float length[3];
    // The one cutoff; zero where radii are per particle.
    float cutoff;
    // Remembered positions.
    float4 *position;
    // Remembered box crossings, `[n][3]`.
    i32 *image;
    // Largest squared distance (bits of an f32) and sum of distances over radii in units of 2^-20, `[2]`.
    u64 *moved;
};
static_assert(sizeof(MotionArgs) == 80, "MotionArgs differs between host and device");

// Arguments of `permute`: the particles in another memory order.
struct PermuteArgs {
    // From.
    Particles from;
    // To.
    Particles to;
    // Forces, from and to.
    float4 *force[2];
    // Place of origin of each particle.
    u32 *order;
    // Place of each input index, written.
    u32 *place;
};
static_assert(sizeof(PermuteArgs) == 112, "PermuteArgs differs between host and device");

// Arguments of `morton_count` and `morton_scatter`: the order along the Morton curve.
struct MortonArgs {
    // Positions.
    float4 *position;
    // Cell of each particle, written by the count.
    u32 *cell;
    // Its number within the cell.
    u32 *rank;
    // Particles of each cell, zeroed, `[8^bits]`.
    u32 *count;
    // First place of each cell.
    u32 *start;
    // The particle at each place, written by the scatter.
    u32 *order;
    // Where cells begin; the outermost extend to infinity.
    float lo[3];
    // Cells per length.
    float per_length[3];
    // Cells along an axis are two to this power, at most 10.
    u32 bits;
    // Number of particles.
    u32 n;
};
static_assert(sizeof(MortonArgs) == 80, "MortonArgs differs between host and device");

// Arguments of `bounds`.
struct BoundsArgs {
    // Positions, at least one.
    float4 *position;
    // Low and high corner by `ordered_bits`, `[6]`; low all ones and high zeros before.
    u32 *bounds;
    // Number of particles.
    u64 n;
};
static_assert(sizeof(BoundsArgs) == 24, "BoundsArgs differs between host and device");

// Arguments of `sample`: positions at even strides.
struct SampleArgs {
    // Positions.
    float4 *position;
    // Sampled ones.
    float4 *sample;
    // Number of particles.
    u64 n;
    // Size of the sample, at most `n`.
    u64 n_sampled;
};
static_assert(sizeof(SampleArgs) == 32, "SampleArgs differs between host and device");

// Arguments of `finish_exact`: from quanta to numbers.
struct FinishExactArgs {
    // From `exact` to the others.
    Results results;
    // Quanta in a unit of force.
    float force_quanta;
    // Quanta in a unit of energy.
    float energy_quanta;
    // Number of particles.
    u32 n;
    // 1 to convert energies and virials too.
    u32 energy;
    // 1 where overlaps are allowed.
    u32 capped;
    // Zero.
    u32 unused;
};
static_assert(sizeof(FinishExactArgs) == 64, "FinishExactArgs differs between host and device");

// The cells of one class of radii: rows of `n[0]` cells along x, `n[1]` rows to a plane, `n[2]` planes. Rows run
// backwards in odd rows and planes (snake order), so that consecutive particles are near each other.
struct CellClass {
    // Where cells begin; the outermost extend to infinity.
    float lo[3];
    // Cells per length.
    float per_length[3];
    // Lengths of a cell.
    float width[3];
    // Cells along each axis.
    u32 n[3];
    // Zero.
    u32 unused;
    // Index of the first cell among those of all classes.
    u32 first_cell;
    // Upper limit of the radii of the class; infinite for the last.
    float limit;
    // Largest radius of the class now, the cutoff where there is one for all.
    float largest;
};
static_assert(sizeof(CellClass) == 64, "CellClass differs between host and device");

// All classes, by ascending radius.
struct Grid {
    // The classes.
    CellClass classes[8];
    // How many there are.
    u32 n_classes;
    // Cells of all classes.
    u32 n_cells;
    // First slot of each cell, `[n_cells + 1]`.
    u32 *cell_start;
    // Particles in cell order: position, and radius in w.
    float4 *slot;
    // Place of each slot's particle; null where slots are places.
    u32 *particle;
};
static_assert(sizeof(Grid) == 544, "Grid differs between host and device");

// Arguments of `cell_count` and `cell_scatter`.
struct SortArgs {
    // Cells to sort into.
    Grid grid;
    // Particles in each cell: counted from zero, and zero again once all have their slots.
    u32 *count;
    // State of the scan between the two, zeroed by the count, `[n_tiles]`.
    u64 *tiles;
    // Positions, with radii in w where `variable`.
    float4 *position;
    // Cell of each particle, written by the count.
    u32 *cell;
    // Its number within the cell.
    u32 *rank;
    // Number of particles.
    u32 n;
    // 1 where radii are per particle.
    u32 variable;
    // Length of that state.
    u32 n_tiles;
    // Zero.
    u32 unused;
};
static_assert(sizeof(SortArgs) == 600, "SortArgs differs between host and device");

// Arguments of `scan_u32` and `scan_u64`: exclusive prefix sums in one pass with look-back.
struct ScanArgs {
    // Counts, `[n]` of u32.
    u32 *input;
    // Sums, `[n + 1]` of u32 or u64.
    u8 *output;
    // State of each tile, zeroed, `[tiles + 1]`; the last is the ticket counter.
    u64 *tiles;
    // Number of counts.
    u32 n;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ScanArgs) == 32, "ScanArgs differs between host and device");

// Arguments of `brute_*` and `cell_*`: forces of all particles.
struct GatherArgs {
    // The interaction.
    Law law;
    // The box.
    Box3 space;
    // The cells; only `slot` and `particle` for `brute`.
    Grid grid;
    // Velocities, for types in w.
    float4 *velocity;
    // Where results go.
    Results results;
    // Number of particles.
    u32 n;
    // Added to ranges so that roundings lose no candidate.
    float slack;
};
static_assert(sizeof(GatherArgs) == 736, "GatherArgs differs between host and device");

// Arguments of `cell_step_*`: forces, and with them a step of all particles.
struct CellStepArgs {
    // Where forces come from; results are not stored.
    GatherArgs gather;
    // How particles move.
    Integrator integrator;
    // The particles, at the positions that were sorted.
    Particles particles;
    // What went wrong.
    Status *status;
    // The step that the present launches begin with.
    u64 *first;
    // The step that the forces belong to, from that on.
    u32 index;
    // Zero.
    u32 unused;
};
static_assert(sizeof(CellStepArgs) == 888, "CellStepArgs differs between host and device");

// Arguments of `begin_cell_steps`.
struct FirstStepArgs {
    // Where [`CellStepArgs`] find it.
    u64 *first;
    // The step.
    u64 step;
};
static_assert(sizeof(FirstStepArgs) == 16, "FirstStepArgs differs between host and device");

// Arguments of `number_slots`.
struct NumberArgs {
    // Place of each slot's particle.
    u32 *particle;
    // Input index of each place.
    u32 *id;
    // Input index of each slot's particle.
    u32 *number;
    // Number of particles.
    u32 n;
    // Zero.
    u32 unused;
};
static_assert(sizeof(NumberArgs) == 32, "NumberArgs differs between host and device");

// Arguments of the kernels that list neighbours.
struct ListArgs {
    // The interaction, for ranges.
    Law law;
    // The box.
    Box3 space;
    // The cells; only `slot` and `particle` for `brute`.
    Grid grid;
    // Input index of each slot's particle.
    u32 *id;
    // Entries of each row, by input index; counted, or counted down while rows are filled.
    u32 *count;
    // Row starts, `[n + 1]`.
    u64 *offset;
    // Neighbours, by input index.
    u32 *index;
    // Periodic image of each neighbour.
    u8 *image;
    // Number of particles.
    u32 n;
    // 1 for half lists: only neighbours of larger input index.
    u32 half;
    // Added to ranges so that roundings lose no candidate.
    float slack;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ListArgs) == 736, "ListArgs differs between host and device");

// What is known of rows that were listed before their places were.
struct StagingControl {
    // Entries of all rows.
    u64 entries;
    // 1 where a row or all of them had too little room.
    u32 overflow;
    // Zero.
    u32 unused;
};
static_assert(sizeof(StagingControl) == 16, "StagingControl differs between host and device");

// Arguments of `cell_list_stage`: rows wherever there is room.
struct StageArgs {
    // What is listed; rows are counted too.
    ListArgs list;
    // Neighbours, by input index, those of a row together.
    u32 *staged;
    // Where each row begins there, by input index.
    u64 *start;
    // Zeroed before.
    StagingControl *control;
    // Entries that there is room for.
    u64 capacity;
};
static_assert(sizeof(StageArgs) == 768, "StageArgs differs between host and device");

// Arguments of `copy_rows`: rows to their places.
struct CopyRowsArgs {
    // Row starts, `[n + 1]`.
    u64 *offset;
    // See [`StageArgs`].
    u64 *start;
    // See [`StageArgs`].
    u32 *staged;
    // Neighbours, by input index.
    u32 *index;
    // See [`StageArgs`].
    StagingControl *control;
    // Neighbours that there is room for: where there are more, nothing is copied.
    u64 room;
    // Number of rows.
    u32 n;
    // Zero.
    u32 unused;
};
static_assert(sizeof(CopyRowsArgs) == 56, "CopyRowsArgs differs between host and device");

// Arguments of `query_*`: lists of queries among points of another set.
struct QueryArgs {
    // The points, in cells of one class, with rows by query; [`ListArgs::n`] is the number of queries. Radii are per
    // query, whatever the law says.
    ListArgs list;
    // Queries in an order that keeps near ones together, with radii in w.
    float4 *query;
    // Row of each of these.
    u32 *row;
};
static_assert(sizeof(QueryArgs) == 752, "QueryArgs differs between host and device");

// Consecutive chunks of 32 entries of a cluster's list.
struct Segment {
    // First chunk.
    u32 begin;
    // The chunk after the last.
    u32 end;
    // The segment where the list goes on; all ones where it ends.
    u32 next;
    // 1 where each pair needs an image of its own, 0 where one serves a candidate and the whole cluster.
    u32 by_pair;
};
static_assert(sizeof(Segment) == 16, "Segment differs between host and device");

// What kernels tell each other and the host about a list.
struct ClusterControl {
    // The first step whose positions the list may not serve; all ones while none is known, zero where there was no
    // room for the list.
    u64 rebuild_at;
    // The step that the present launches of steps begin with.
    u64 first;
    // The step that the positions belong to, which is to be computed next.
    u64 next;
    // The first step that is not to be computed.
    u64 end;
    // Chunks of all lists.
    u32 chunks;
    // Segments beyond the first of each cluster.
    u32 segments;
    // Lists made since `begin_steps` after others that had served.
    u32 lists;
    // Most steps that one of those others has served for since then.
    u32 longest;
    // How many of them did not serve for a second step.
    u32 dangerous;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ClusterControl) == 56, "ClusterControl differs between host and device");

// Arguments of `begin_steps` and `begin_list`.
struct ClusterControlArgs {
    // The list.
    ClusterControl *control;
    // The step that the positions belong to.
    u64 step;
    // The first step that is not to be computed.
    u64 end;
};
static_assert(sizeof(ClusterControlArgs) == 24, "ClusterControlArgs differs between host and device");

// Arguments of `sort_particles`.
struct SortParticlesArgs {
    // The sort, counted and scanned.
    SortArgs sort;
    // The particles.
    Particles from;
    // The particles in the order of the cells.
    Particles to;
    // Place of each input index.
    u32 *place;
    // The list there has been; there is none then.
    ClusterControl *control;
};
static_assert(sizeof(SortParticlesArgs) == 696, "SortParticlesArgs differs between host and device");

// Arguments of `list_clusters` and `list_sparse`.
struct ClusterListArgs {
    // The interaction, its cutoff longer by the skin.
    Law law;
    // The box.
    Box3 space;
    // Cells of particles in memory order.
    Grid grid;
    // One for each cluster, then those that follow, `[segment_capacity]`.
    Segment *segment;
    // Entries, `[capacity][32]`.
    u32 *entry;
    // Chunks and segments are counted from zero, beyond what there is room for.
    ClusterControl *control;
    // Number of particles.
    u32 n;
    // Number of clusters.
    u32 n_clusters;
    // Chunks that there is room for.
    u32 capacity;
    // Segments that there is room for.
    u32 segment_capacity;
    // Added to ranges so that roundings lose no candidate.
    float slack;
    // How near a periodic face a particle may cross it while the list serves.
    float margin;
    // 1 where pairs are listed once: by the cluster whose slots come first, those within a cluster from both sides.
    u32 once;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ClusterListArgs) == 736, "ClusterListArgs differs between host and device");

// Arguments of `listed_*` and `pairs_*`: forces of all particles.
struct ListedArgs {
    // As for all kernels that gather forces, of particles in memory order.
    GatherArgs gather;
    // See [`ClusterListArgs`].
    Segment *segment;
    // See [`ClusterListArgs`].
    u32 *entry;
    // Nothing is done unless the list serves; null where that is known.
    ClusterControl *control;
    // The step that the forces belong to, from [`ClusterControl::first`] on.
    u32 index;
    // Clusters that a warp of `pairs_*` takes, one after another.
    u32 clusters_per_warp;
};
static_assert(sizeof(ListedArgs) == 768, "ListedArgs differs between host and device");

// Arguments of `step_*` and `move_listed`: a step of all particles by forces that are computed or read.
struct ClusterStepArgs {
    // Where forces come from. In `step_*` results are not stored, in `move_listed` they are zeroed once read.
    ListedArgs listed;
    // How particles move.
    Integrator integrator;
    // The particles.
    Particles particles;
    // Where positions go: in `step_*` not to where they are.
    float4 *next;
    // Positions that the list was made for.
    float4 *reference;
    // What went wrong.
    Status *status;
    // Square of the distance that particles may move while the list serves.
    float limit2;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ClusterStepArgs) == 928, "ClusterStepArgs differs between host and device");

// Arguments of `clusters_moved`: whether a list serves the present positions.
struct ClustersMovedArgs {
    // The box.
    Box3 space;
    // Positions.
    float4 *position;
    // Positions that the list was made for.
    float4 *reference;
    // `rebuild_at` becomes zero where the list does not serve.
    ClusterControl *control;
    // Number of particles.
    u32 n;
    // Square of the distance that particles may move.
    float limit2;
};
static_assert(sizeof(ClustersMovedArgs) == 80, "ClustersMovedArgs differs between host and device");

// A mirror particle: a box around a periodic image.
struct Ghost {
    // Place of the particle.
    u32 particle;
    // Periodic image.
    u32 image;
};
static_assert(sizeof(Ghost) == 8, "Ghost differs between host and device");

// Arguments of `fit_boxes`, `count_ghosts` and `make_ghosts`.
struct BoxesArgs {
    // The box.
    Box3 space;
    // Positions, with radii in w where they are per particle.
    float4 *position;
    // Low and high corner of a box around each particle, then of each ghost, `[n + n_ghosts][6]`.
    float *boxes;
    // Mirror particles, `[n_ghosts]`.
    Ghost *ghost;
    // Faces for which each particle has ghosts, `[n]`: bit `2 axis` the lower, bit `2 axis + 1` the upper one.
    // Null where there are no ghosts.
    u8 *faces;
    // Number of ghosts, counted or made; for `fit_boxes` set to 1 where a particle needs one that it lacks.
    u32 *counter;
    // Number of particles.
    u32 n;
    // Number of ghosts.
    u32 n_ghosts;
    // The one cutoff; zero where radii are per particle.
    float cutoff;
    // Added to radii.
    float skin;
    // What roundings of coordinates may amount to.
    float slack;
    // How far particles may move before they lack ghosts.
    float margin;
};
static_assert(sizeof(BoxesArgs) == 112, "BoxesArgs differs between host and device");

// Spheres or squares around particles and the rays that meet them (paper B), whose origins are not their
// particles. Zero where bodies are boxes.
struct Geometry {
    // Least coordinates that bodies and rays are given, whatever those of particles.
    float lo[3];
    // Greatest coordinates.
    float hi[3];
    // Radius of spheres; half the side of squares.
    float body;
    // Distance of squares from their particle along x, and of rays from theirs along y and z.
    float offset;
    // How far beyond their diagonal the triangles of a square reach.
    float overlap;
    // From the particle to the beginning of its rays, along them.
    float start;
    // Length of rays.
    float length;
    // Zero.
    u32 unused;
};
static_assert(sizeof(Geometry) == 48, "Geometry differs between host and device");

// Arguments of `fit_spheres` and `fit_squares`.
struct BodiesArgs {
    // As for boxes, of which there are none.
    BoxesArgs boxes;
    // Sizes and places.
    Geometry geometry;
    // Centres of spheres around each particle, then each ghost, `[n + n_ghosts]`.
    float4 *centers;
    // Vertices of the triangles of squares, `[n + n_ghosts][2][2][3][3]`: by square, triangle, vertex and axis.
    float *vertices;
};
static_assert(sizeof(BodiesArgs) == 176, "BodiesArgs differs between host and device");

// What rays need to know.
struct Rays {
    // The interaction.
    Law law;
    // The box.
    Box3 space;
    // The particles, each with a ray from its position and a box around it, or what `geometry` says.
    Particles particles;
    // Bodies other than boxes.
    Geometry geometry;
    // What rays are traced against.
    u64 handle;
    // Mirror particles, whose bodies follow those of the particles.
    Ghost *ghost;
    // How rays see periodic images: 0 by gamma rays, 1 in instances, 2 as ghosts.
    u32 view;
    // Number of images.
    u32 n_images;
    // The images, in order of instances; the box itself comes first.
    u8 image[32];
    // Particles at or below this need gamma rays to image -1.
    float near_lo[3];
    // Particles at or above this need gamma rays to image +1.
    float near_hi[3];
    // Added to ranges.
    float skin;
    // Place of the particle of the first ray.
    u32 first;
};
static_assert(sizeof(Rays) == 312, "Rays differs between host and device");

// Parameters of the programs in `ray_gather`, `axis_gather`, `edge_gather` and `ray_scatter`.
struct ForceRays {
    // The rays.
    Rays rays;
    // Where forces go.
    Results results;
};
static_assert(sizeof(ForceRays) == 352, "ForceRays differs between host and device");

// Parameters of the programs in `ray_advance`.
struct AdvanceRays {
    // The rays.
    Rays rays;
    // Where forces go.
    Results results;
    // How particles move.
    Integrator integrator;
    // Where positions go: rays of other particles still need the present ones.
    float4 *position;
    // What went wrong.
    Status *status;
    // The step that the forces belong to.
    u64 step;
};
static_assert(sizeof(AdvanceRays) == 464, "AdvanceRays differs between host and device");

// Parameters of the programs in `ray_list`, `axis_list` and `edge_list`.
struct ListRays {
    // The rays.
    Rays rays;
    // Row and number in the list of each particle; null where these are places.
    u32 *id;
    // Entries of each row; where radii are per particle zero before they are counted, and counted down while rows
    // are filled.
    u32 *count;
    // Row starts, `[n + 1]`.
    u64 *offset;
    // Neighbours.
    u32 *index;
    // Periodic image of each neighbour; null where nobody asks.
    u8 *image;
    // Entries before the first that is stored.
    u64 base;
    // 1 for half lists: only neighbours of larger number.
    u32 half;
    // Zero.
    u32 unused;
};
static_assert(sizeof(ListRays) == 368, "ListRays differs between host and device");

// Arguments of `rows_*`: forces from stored rows of neighbours, numbered by place.
struct RowsArgs {
    // The interaction.
    Law law;
    // The box.
    Box3 space;
    // The particles.
    Particles particles;
    // Row starts, `[n + 1]`.
    u64 *offset;
    // Candidates: they may have left the range since they were listed.
    u32 *index;
    // Where forces go.
    Results results;
    // Entries before the first that is stored.
    u64 base;
    // First row.
    u32 first;
    // Number of rows.
    u32 n_rows;
};
static_assert(sizeof(RowsArgs) == 248, "RowsArgs differs between host and device");
