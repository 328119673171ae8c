// Forces by lists of clusters.

#include "gather.cuh"
#include "listed.cuh"

template <class L, bool EXACT, bool ENERGY> __device__ inline void listed_forces(const ListedArgs& a) {
    __shared__ u32 entries[WARPS_PER_BLOCK * SEGMENT_ENTRIES];
    const u32 number = thread_index() / WARP;
    const ClusterPlace cluster = consecutive_cluster(a.gather.n, number);
    if (cluster.count == 0) return;
    Gather<L, EXACT, ENERGY, NO_IMAGE> gather(a.gather, cluster);
    meet_listed(a, number, entries, gather);
    gather.store();
}

KERNEL_MIN_BLOCKS(listed_uniform, ListedArgs, WARPS_PER_BLOCK* WARP, 7) {
    listed_forces<UniformLennardJones, false, false>(a);
}

KERNEL(listed_any, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_forces<AnyLaw, false, false>(a);
}

KERNEL(listed_any_energy, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_forces<AnyLaw, false, true>(a);
}

KERNEL(listed_exact, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_forces<AnyLaw, true, false>(a);
}

KERNEL(listed_exact_energy, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_forces<AnyLaw, true, true>(a);
}
