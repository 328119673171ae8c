// Forces by testing all pairs: a warp takes 8 particles, each lane one of all others at a time.

#include "gather.cuh"

template <class L, bool EXACT, bool ENERGY> __device__ inline void brute_forces(const GatherArgs& a) {
    const ClusterPlace cluster = consecutive_cluster(a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    Gather<L, EXACT, ENERGY, NO_IMAGE> gather(a, cluster);
    meet_all(a.n, gather);
    gather.store();
}

KERNEL_MIN_BLOCKS(brute_uniform, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    brute_forces<UniformLennardJones, false, false>(a);
}

KERNEL_MIN_BLOCKS(brute_scaled, GatherArgs, WARPS_PER_BLOCK* WARP, 6) {
    brute_forces<ScaledLennardJones, false, false>(a);
}

KERNEL(brute_any, GatherArgs, WARPS_PER_BLOCK* WARP) {
    brute_forces<AnyLaw, false, false>(a);
}

KERNEL(brute_any_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    brute_forces<AnyLaw, false, true>(a);
}

KERNEL(brute_exact, GatherArgs, WARPS_PER_BLOCK* WARP) {
    brute_forces<AnyLaw, true, false>(a);
}

KERNEL(brute_exact_energy, GatherArgs, WARPS_PER_BLOCK* WARP) {
    brute_forces<AnyLaw, true, true>(a);
}
