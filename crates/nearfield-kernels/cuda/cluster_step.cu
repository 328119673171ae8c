// Steps by lists of clusters most of which are empty: moving the particles is the work, a thread for each.

#include "cluster_step.cuh"
#include "law.cuh"
#include "sums.cuh"

// Force on particle `i` from what its cluster's list holds.
template <class L>
__device__ inline float4 listed_force(const ListedArgs& a, Segment segment, u32 i, const Moving& p) {
    const GatherArgs& g = a.gather;
    const bool typed = L::TYPED && g.law.n_types > 1;
    const float cutoff = g.law.cutoff;
    const u32 kind = __float_as_uint(p.velocity.w);
    Sums<false, false> sums = zero_sums<Sums<false, false>>();
    for (;;) {
        const u32* entry = a.entry + (u64)segment.begin * WARP;
        const u32* end = a.entry + (u64)segment.end * WARP;
#pragma unroll 1
        for (; entry < end && (*entry & LISTED_NONE) == 0; ++entry) {
            const u32 slot = *entry & LISTED_SLOT;
            if (slot == i) continue;
            const Shift d = separation<NEAREST>(g.space, p.position, g.grid.slot[slot], {0.0f, 0.0f, 0.0f});
            const float r2 = squared_length(d.x, d.y, d.z);
            if (!(r2 < cutoff * cutoff)) continue;
            const u32 kind_j = typed ? __float_as_uint(g.velocity[slot].w) : 0;
            const PairForce pair = L::template evaluate<false>(g.law, r2, cutoff, kind, kind_j);
            sums.add(g.law, d.x, d.y, d.z, pair.f_over_r, pair.energy, r2);
        }
        if (segment.next == NO_SEGMENT) return make_float4(sums.x, sums.y, sums.z, 0.0f);
        segment = a.segment[segment.next];
    }
}

template <class L, bool NOISE> __device__ inline void sparse_step(const ClusterStepArgs& a) {
    const u32 i = thread_index();
    if (i >= a.particles.n) return;
    // All that a step without neighbours reads is on its way before anything is waited for.
    const bool allowed = serves(a.listed);
    const Segment segment = a.listed.segment[i / CLUSTER];
    const Moving p = load_moving(a.particles, i);
    const float4 reference = a.reference[i];
    if (!allowed) {
        // Positions go to and fro. The first step that is not done takes them back to where the first step found them.
        const bool away = a.listed.index % 2 == 1 && step_of(a.listed) == a.listed.control->next;
        if (away) a.next[i] = p.position;
        return;
    }
    if (i == 0) a.listed.control->next = step_of(a.listed) + 1;
    float4 force = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
    if (segment.begin != segment.end) force = listed_force<L>(a.listed, segment, i, p);
    move_particle<NOISE>(a, i, p, force, reference);
}

KERNEL_MIN_BLOCKS(step_sparse_uniform, ClusterStepArgs, 128, 8) {
    sparse_step<UniformLennardJones, false>(a);
}

KERNEL(step_sparse_any, ClusterStepArgs, 128) {
    sparse_step<AnyLaw, true>(a);
}
