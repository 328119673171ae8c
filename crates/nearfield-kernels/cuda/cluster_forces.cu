// Forces by cells, each pair found once and added to both particles.

#define VECTOR_REDUCTIONS

#include "gather.cuh"

// Occupancy beats spills: in a prototype of this kernel 64 registers took 10.66 ms, 80 took 11.31, 123 without a limit
// 12.02 (an H200, 1.4e10 pairs).
KERNEL_MIN_BLOCKS(cluster_uniform, GatherArgs, WARPS_PER_BLOCK* WARP, 8) {
    forces_by_cells<UniformLennardJones, false, false, ONCE>(a);
}

KERNEL_MIN_BLOCKS(cluster_scaled, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    forces_by_cells<ScaledLennardJones, false, false, ONCE>(a);
}

KERNEL(cluster_any, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, false, false, ONCE>(a);
}

KERNEL(cluster_any_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, false, true, ONCE>(a);
}
