// Builds lists of clusters most of which are empty, in cells that hold about one particle: a thread looks around each.

#include "around.cuh"
#include "listed.cuh"


// What a cluster's list holds because of one of its particles: what is near it and near none of those before it, at its
// nearest image, so that it is listed once.
struct NearFirst {
    const ClusterListArgs& a;
    const u32 slot;
    const float4& x;
    const float reach2;
    u32 count;
    u32* to; // where entries are written; they are only counted where it is null
    u32 only; // the entry, where there is one

    __device__ void meet(u32 j, u32 image, const Shift& s) {
        if (j == slot) return;
        const float4 xj = a.grid.slot[j];
        const Shift d = displacement(x, xj, s);
        if (!(squared_length(d.x, d.y, d.z) < reach2) || nearest_image(a.space, x, xj) != image) return;
        for (u32 k = slot / CLUSTER * CLUSTER; k < slot; ++k) {
            if (k != j && is_near(a.grid.slot[k], xj)) return;
        }
        only = j | LISTED_CARE;
        if (to) to[count] = only;
        ++count;
    }

    __device__ bool is_near(const float4& p, const float4& xj) const {
        const Shift d = separation<NEAREST>(a.space, p, xj, {0.0f, 0.0f, 0.0f});
        return squared_length(d.x, d.y, d.z) < reach2;
    }
};

// Says which chunks are a cluster's, in as many segments as they need.
__device__ inline void write_segments(const ClusterListArgs& a, u32 number, u32 begin, u32 chunks) {
    const u32 end = begin + chunks;
    for (u32 segment = number;;) {
        const u32 here = smaller(end - begin, u32(SEGMENT_ENTRIES / WARP));
        const bool last = begin + here == end;
        const u32 next = last ? NO_SEGMENT : a.n_clusters + atomicAdd(&a.control->segments, 1u);
        if (segment < a.segment_capacity) a.segment[segment] = {begin, begin + here, next, 1};
        if (last) return;
        begin += here;
        segment = next;
    }
}

KERNEL_MIN_BLOCKS(list_sparse, ClusterListArgs, 128, 8) {
    const u32 slot = thread_index(), lane = threadIdx.x % WARP, number = slot / CLUSTER;
    const float4 x = a.grid.slot[smaller(slot, a.n - 1)];
    const float reach = a.law.cutoff + a.slack;
    NearFirst near = {a, slot, x, reach * reach, 0, nullptr, LISTED_NONE};
    if (slot < a.n) search_around(a.grid, a.space, x, reach, near);
    const u32 found = near.count;
    // Entries of the cluster by its particles before this one, and by all of them.
    u32 before = 0, all = 0;
    for (u32 k = 0; k < CLUSTER; ++k) {
        const u32 of = __shfl_sync(ALL_LANES, found, lane / CLUSTER * CLUSTER + k);
        if (k < lane % CLUSTER) before += of;
        all += of;
    }
    const u32 chunks = (all + WARP - 1) / WARP;
    u32 begin = 0;
    if (lane % CLUSTER == 0 && chunks > 0) begin = atomicAdd(&a.control->chunks, chunks);
    begin = __shfl_sync(ALL_LANES, begin, lane / CLUSTER * CLUSTER);
    if (lane % CLUSTER == 0 && number < a.n_clusters) write_segments(a, number, begin, chunks);
    if (all == 0) return;
    if ((u64)begin + chunks > a.capacity) {
        if (lane % CLUSTER == 0) atomicMin(&a.control->rebuild_at, (u64)0);
        return;
    }
    u32* entry = a.entry + (u64)begin * WARP;
    for (u32 k = all + lane % CLUSTER; k < chunks * WARP; k += CLUSTER) entry[k] = LISTED_NONE;
    if (found == 1) entry[before] = near.only;
    if (found > 1) {
        NearFirst again = {a, slot, x, reach * reach, 0, entry + before, 0};
        search_around(a.grid, a.space, x, reach, again);
    }
}
