// Steps by lists of clusters: forces, the rest of a step and the beginning of the next in one kernel.
//
#include "cluster_step.cuh"
#include "gather.cuh"

// A warp takes so many clusters, one after another: one where they have many neighbours, more where most have none and
// moving the particles is the work.
template <class L, u32 CLUSTERS> __device__ inline void cluster_step(const ClusterStepArgs& a) {
    if (!begin_step(a)) return;
    const GatherArgs& g = a.listed.gather;
    __shared__ u32 entries[WARPS_PER_BLOCK * SEGMENT_ENTRIES];
    const u32 warp = thread_index() / WARP, lane = threadIdx.x % WARP;
    float4 force = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
#pragma unroll 1
    for (u32 c = 0; c < CLUSTERS; ++c) {
        const u32 number = warp * CLUSTERS + c;
        const ClusterPlace cluster = consecutive_cluster(g.n, number);
        if (cluster.count == 0) break;
        if (CLUSTERS > 1) {
            const Segment segment = a.listed.segment[number];
            if (segment.begin == segment.end) continue;
        }
        Gather<L, false, false, NO_IMAGE> gather(g, cluster);
        meet_listed(a.listed, number, entries, gather);
        typedef Sums<false, false> S;
        const float x = gather.sum(&S::x), y = gather.sum(&S::y), z = gather.sum(&S::z);
        // From the four lanes that have the sums of a particle to the one that moves it.
        const u32 source = CLUSTERS > 1 ? lane % CLUSTER * 4 : lane;
        const float4 of_source = make_float4(__shfl_sync(ALL_LANES, x, source), __shfl_sync(ALL_LANES, y, source),
                                             __shfl_sync(ALL_LANES, z, source), 0.0f);
        if (CLUSTERS == 1 || lane / CLUSTER == c) force = of_source;
    }
    const u32 i = CLUSTERS > 1 ? warp * WARP + lane : warp * CLUSTER + lane / 4;
    if (i < g.n && (CLUSTERS > 1 || lane % 4 == 0)) move_particle(a, i, force);
}

KERNEL_MIN_BLOCKS(step_uniform, ClusterStepArgs, WARPS_PER_BLOCK* WARP, 6) {
    cluster_step<UniformLennardJones, 1>(a);
}

KERNEL(step_any, ClusterStepArgs, WARPS_PER_BLOCK* WARP) {
    cluster_step<AnyLaw, 1>(a);
}

KERNEL_MIN_BLOCKS(step_sparse_uniform, ClusterStepArgs, WARPS_PER_BLOCK* WARP, 8) {
    cluster_step<UniformLennardJones, 4>(a);
}

KERNEL(step_sparse_any, ClusterStepArgs, WARPS_PER_BLOCK* WARP) {
    cluster_step<AnyLaw, 4>(a);
}
