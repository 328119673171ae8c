// Forces by cells: a warp takes 8 consecutive particles, each lane one candidate at a time.

#include "gather.cuh"

KERNEL_MIN_BLOCKS(cell_uniform, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    forces_by_cells<UniformLennardJones, false, false, DIRECTED>(a);
}

KERNEL_MIN_BLOCKS(cell_scaled, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    forces_by_cells<ScaledLennardJones, false, false, DIRECTED>(a);
}

KERNEL(cell_any, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, false, false, DIRECTED>(a);
}

KERNEL(cell_any_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, false, true, DIRECTED>(a);
}

KERNEL(cell_exact, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, true, false, DIRECTED>(a);
}

KERNEL(cell_exact_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    forces_by_cells<AnyLaw, true, true, DIRECTED>(a);
}
