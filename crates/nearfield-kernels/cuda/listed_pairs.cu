// Forces by lists that hold each pair once, added to both particles, and what else steps by them need.

#define VECTOR_REDUCTIONS

#include "cluster_step.cuh"
#include "gather.cuh"

// The warps of a block take consecutive clusters at a time, so that they find each other's particles in the cache.
template <class L, bool ENERGY> __device__ inline void listed_pairs(const ListedArgs& a) {
    __shared__ u32 entries[WARPS_PER_BLOCK * SEGMENT_ENTRIES];
    if (!serves(a)) return;
    u32 number = blockIdx.x * WARPS_PER_BLOCK * a.clusters_per_warp + threadIdx.x / WARP;
#pragma unroll 1
    for (u32 k = 0; k < a.clusters_per_warp; ++k, number += WARPS_PER_BLOCK) {
        const ClusterPlace cluster = consecutive_cluster(a.gather.n, number);
        if (cluster.count == 0) return;
        Gather<L, false, ENERGY, LISTED_ONCE> gather(a.gather, cluster);
        meet_listed(a, number, entries, gather);
        gather.store();
    }
}

KERNEL_MIN_BLOCKS(pairs_uniform, ListedArgs, WARPS_PER_BLOCK* WARP, 6) {
    listed_pairs<UniformLennardJones, false>(a);
}

KERNEL(pairs_any, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_pairs<AnyLaw, false>(a);
}

KERNEL(pairs_any_energy, ListedArgs, WARPS_PER_BLOCK* WARP) {
    listed_pairs<AnyLaw, true>(a);
}

template <bool NOISE> __device__ inline void move_all(const ClusterStepArgs& a) {
    const u32 i = thread_index();
    if (i >= a.particles.n) return;
    // All that is read is on its way before anything is waited for.
    float4& sum = a.listed.gather.results.force[i];
    const float4 force = sum, reference = a.reference[i];
    const Moving p = load_moving(a.particles, i);
    if (!begin_step(a)) return;
    sum = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
    move_particle<NOISE>(a, i, p, force, reference);
}

// The rest of a step and the beginning of the next.
KERNEL_MIN_BLOCKS(move_listed, ClusterStepArgs, 256, 4) {
    move_all<false>(a);
}

KERNEL(move_listed_any, ClusterStepArgs, 256) {
    move_all<true>(a);
}
