// Steps by lists of clusters: forces, the rest of a step and the beginning of the next in one kernel.
//
// The host enqueues steps without knowing how long the list will serve. A step that finds a particle too far from where
// it was when the list was made forbids the next, and steps that are forbidden do nothing. So no pair is missed, and
// the host need not wait for a step.

#include "gather.cuh"
#include "integrate.cuh"
#include "listed.cuh"

__device__ inline void move_particle(const ClusterStepArgs& a, u32 i, const float4& force) {
    Particles to = a.particles;
    to.position = a.next;
    Moving p = load_moving(a.particles, i);
    const float4 start = p.position;
    // A particle that has failed is left where it was, so that coordinates stay finite until the run is stopped.
    if (!all_finite(force)) {
        atomicMin(&a.status->force, failure(a.step, a.particles.id[i]));
        to.position[i] = start;
        return;
    }
    // Random numbers take input indices; nothing else does.
    const u32 id = a.integrator.langevin ? a.particles.id[i] : 0;
    finish_step(a.integrator, p, force);
    start_step(a.integrator, p, force, id, a.step + 1);
    if (!all_finite(p.position)) {
        atomicMin(&a.status->position, failure(a.step + 1, a.particles.id[i]));
        to.position[i] = start;
        return;
    }
    store_moving(to, i, p);
    if (has_moved(a.integrator.space, a.reference[i], p.position, a.limit2)) {
        atomicMin(&a.control->rebuild_at, a.step + 1);
    }
}

// A warp takes so many clusters, one after another: one where they have many neighbours, more where most have none and
// moving the particles is the work.
template <class L, u32 CLUSTERS> __device__ inline void cluster_step(const ClusterStepArgs& a) {
    if (a.control->rebuild_at <= a.step) return;
    if (thread_index() == 0) a.control->done = a.step;
    const GatherArgs& g = a.listed.gather;
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
        meet_listed(a.listed, number, gather);
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

KERNEL_MIN_BLOCKS(step_uniform, ClusterStepArgs, WARPS_PER_BLOCK* WARP, 7) {
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
