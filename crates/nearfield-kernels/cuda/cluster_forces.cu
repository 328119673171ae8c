// Forces by cells, each pair found once and added to both particles.

#define VECTOR_REDUCTIONS

#include "gather.cuh"

template <class L, bool ENERGY> __device__ inline void cluster_forces(const GatherArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = find_cluster(a.grid, a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    Gather<L, false, ENERGY, ONCE> gather(a, cluster);
    search_cells<!Traits<L>::ONE_RANGE>(a.grid, a.space, a.slack, cluster, cluster_bounds(gather.x),
                                        scratch[threadIdx.x / WARP], gather);
    gather.store();
}

// Occupancy beats spills: 64 registers took 10.66 ms, 80 took 11.31, 123 without a limit 12.02 (an H200, 1.4e10 pairs).
KERNEL_MIN_BLOCKS(cluster_uniform, GatherArgs, WARPS_PER_BLOCK* WARP, 8) {
    cluster_forces<UniformLennardJones, false>(a);
}

KERNEL_MIN_BLOCKS(cluster_scaled, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    cluster_forces<ScaledLennardJones, false>(a);
}

KERNEL(cluster_any, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cluster_forces<AnyLaw, false>(a);
}

KERNEL(cluster_any_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    cluster_forces<AnyLaw, true>(a);
}
