// Forces by cells: a warp takes 8 consecutive particles, each lane one candidate at a time.

#include "gather.cuh"

template <class L, bool EXACT, bool ENERGY> __device__ inline void cell_forces(const GatherArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = find_cluster(a.grid, a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    Gather<L, EXACT, ENERGY, DIRECTED> gather(a, cluster);
    search_cells<!Traits<L>::ONE_RANGE>(a.grid, a.space, a.slack, cluster, cluster_bounds(gather.x),
                                        scratch[threadIdx.x / WARP], gather);
    gather.store();
}

KERNEL_MIN_BLOCKS(cell_uniform, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    cell_forces<UniformLennardJones, false, false>(a);
}

KERNEL_MIN_BLOCKS(cell_scaled, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    cell_forces<ScaledLennardJones, false, false>(a);
}

KERNEL(cell_any, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cell_forces<AnyLaw, false, false>(a);
}

KERNEL(cell_any_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cell_forces<AnyLaw, false, true>(a);
}

KERNEL(cell_exact, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cell_forces<AnyLaw, true, false>(a);
}

KERNEL(cell_exact_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cell_forces<AnyLaw, true, true>(a);
}
