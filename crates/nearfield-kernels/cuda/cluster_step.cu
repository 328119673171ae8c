// Steps by lists of clusters most of which are empty: moving the particles is the work.

#include "cluster_step.cuh"
#include "gather.cuh"

// Clusters of a warp, a lane for each particle.
#define CLUSTERS (WARP / CLUSTER)

template <class L, bool NOISE> __device__ inline void sparse_step(const ClusterStepArgs& a) {
    __shared__ u32 entries[WARPS_PER_BLOCK * SEGMENT_ENTRIES];
    const GatherArgs& g = a.listed.gather;
    const u32 i = thread_index(), warp = i / WARP, lane = i % WARP, own = warp * CLUSTERS + lane;
    // All that a step without neighbours reads is on its way before anything is waited for.
    const bool allowed = serves(a.listed);
    Segment segment = {0, 0, 0, 0};
    if (lane < CLUSTERS && own < clusters_of(g.n)) segment = a.listed.segment[own];
    Moving p = {};
    if (i < g.n) p = load_moving(a.particles, i);
    if (!allowed) return;
    if (i == 0) a.listed.control->done = a.listed.step;
    u32 lists = __ballot_sync(ALL_LANES, segment.begin != segment.end);
    float4 force = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
    if (lists == 0) {
        if (i < g.n) move_particle<NOISE>(a, i, p, force);
        return;
    }
#pragma unroll 1
    for (; lists != 0; lists &= lists - 1) {
        const u32 c = __ffs(lists) - 1, number = warp * CLUSTERS + c;
        Gather<L, false, false, NO_IMAGE> gather(g, consecutive_cluster(g.n, number));
        meet_listed(a.listed, number, entries, gather);
        typedef Sums<false, false> S;
        const float x = gather.sum(&S::x), y = gather.sum(&S::y), z = gather.sum(&S::z);
        // From the four lanes that have the sums of a particle to the one that moves it.
        const u32 source = lane % CLUSTER * 4;
        const float4 of_source = make_float4(__shfl_sync(ALL_LANES, x, source), __shfl_sync(ALL_LANES, y, source),
                                             __shfl_sync(ALL_LANES, z, source), 0.0f);
        if (lane / CLUSTER == c) force = of_source;
    }
    if (i < g.n) move_particle<NOISE>(a, i, load_moving(a.particles, i), force);
}

KERNEL_MIN_BLOCKS(step_sparse_uniform, ClusterStepArgs, WARPS_PER_BLOCK* WARP, 8) {
    sparse_step<UniformLennardJones, false>(a);
}

KERNEL(step_sparse_any, ClusterStepArgs, WARPS_PER_BLOCK* WARP) {
    sparse_step<AnyLaw, true>(a);
}
