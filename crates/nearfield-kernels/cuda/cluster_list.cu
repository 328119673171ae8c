// Builds lists of clusters, and tells whether they serve.

#include "listed.cuh"

// Entries that a warp keeps before it writes them, all but the last chunk full.
#define STAGE 512
#define FULL_STAGE (STAGE - WARP)

// A candidate is listed if it is near any particle of the cluster, now or before the list is built anew; once, whatever
// its images near the cluster are.
struct Listing : Cluster {
    const ClusterListArgs& a;
    u32* stage;
    u32 count, staged;
    u32 segment; // that is filled next
    bool crowded, near_face;

    __device__ Listing(const ClusterListArgs& arguments, const ClusterPlace& place, u32 number, u32* entries)
        : a(arguments), stage(entries), count(place.count), staged(0), segment(number) {
        load(a.law, a.grid.slot, place);
        const Bounds box = cluster_bounds(x);
        crowded = near_face = false;
        for (int axis = 0; axis < 3; ++axis) {
            if (a.space.boundary[axis] != 0) continue;
            const float extent = box.hi[axis] - box.lo[axis], reach = 2.0f * (cutoff + a.slack);
            // Two images of one candidate may be near two particles.
            crowded = crowded || !((extent + reach) * RANGE_MARGIN < a.space.length[axis]);
            near_face = near_face || is_near_face(axis, box.lo[axis]) || is_near_face(axis, box.hi[axis]);
        }
    }

    __device__ bool is_near_face(int axis, float v) const {
        return a.space.boundary[axis] == 0 &&
               (v - a.space.lo[axis] <= a.margin || a.space.hi[axis] - v <= a.margin);
    }

    __device__ void meet(u32 slot, bool valid, u32 image) {
        if (crowded) {
            list<NEAREST>(slot, valid, image);
        } else if (__any_sync(ALL_LANES, valid && image != HOME_IMAGE)) {
            list<SHIFTED>(slot, valid, image);
        } else {
            list<HOME>(slot, valid, image);
        }
    }

    template <Images IMAGES> __device__ void list(u32 slot, bool valid, u32 image) {
        const float4 xj = slots[slot];
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && image != HOME_IMAGE) shift = shift_of(a.space, image);
        const u32 own = slot - first;
        u32 nearest = image, near = 0;
#pragma unroll
        for (int k = CLUSTER - 1; k >= 0; --k) {
            u32 at = image;
            const Shift d = separation<IMAGES>(a.space, x[k], xj, shift, at);
            if (squared_length(d.x, d.y, d.z) < cutoff * cutoff && own != k && k < count) {
                near |= 1u << k;
                nearest = at;
            }
        }
        // The first of the particles that it is near decides when it is listed, if each is searched for by itself.
        const bool listed = valid && (near & (0u - near) & active) != 0 && nearest == image;
        const u32 votes = __ballot_sync(ALL_LANES, listed);
        if (listed) {
            const bool care = crowded || near_face || image != HOME_IMAGE || own < count || is_near_face(0, xj.x) ||
                              is_near_face(1, xj.y) || is_near_face(2, xj.z);
            stage[staged + __popc(votes & lanes_below())] = slot | (care ? LISTED_CARE : 0);
        }
        staged += __popc(votes);
        __syncwarp();
        if (staged > FULL_STAGE) write(FULL_STAGE, false);
    }

    // The rest of the list.
    __device__ void finish() {
        const u32 lane = threadIdx.x % WARP, end = (staged + WARP - 1) / WARP * WARP;
        if (staged + lane < end) stage[staged + lane] = LISTED_NONE;
        __syncwarp();
        write(end, true);
    }

    // Writes the first entries, as many as fill chunks. Where there is no room, they are counted.
    __device__ void write(u32 entries, bool last) {
        const u32 lane = threadIdx.x % WARP, chunks = entries / WARP;
        u32 begin = 0, next = NO_SEGMENT;
        if (lane == 0) {
            if (chunks > 0) begin = atomicAdd(&a.control->chunks, chunks);
            if (!last) next = a.n_clusters + atomicAdd(&a.control->segments, 1u);
            if (segment < a.segment_capacity) a.segment[segment] = {begin, begin + chunks, next, 0};
        }
        begin = __shfl_sync(ALL_LANES, begin, 0);
        segment = __shfl_sync(ALL_LANES, next, 0);
        if ((u64)begin + chunks <= a.capacity) {
            u32* to = a.entry + (u64)begin * WARP;
            for (u32 k = lane; k < entries; k += WARP) to[k] = stage[k];
        } else if (lane == 0) {
            atomicMin(&a.control->rebuild_at, (u64)0);
        }
        __syncwarp();
        if (staged > entries && lane < staged - entries) stage[lane] = stage[entries + lane];
        staged -= smaller(staged, entries);
        __syncwarp();
    }
};

KERNEL_MIN_BLOCKS(list_clusters, ClusterListArgs, WARPS_PER_BLOCK* WARP, 6) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    __shared__ u32 stage[WARPS_PER_BLOCK][STAGE];
    const u32 number = thread_index() / WARP, warp = threadIdx.x / WARP;
    const ClusterPlace cluster = find_cluster(a.grid, a.n, number);
    if (cluster.count == 0) return;
    Listing listing(a, cluster, number, stage[warp]);
    search_cells<false>(a.grid, a.space, a.slack, cluster, cluster_bounds(listing.x), scratch[warp], listing);
    listing.finish();
}

KERNEL(clusters_moved, ClustersMovedArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    if (has_moved(a.space, a.reference[i], a.position[i], a.limit2)) atomicMin(&a.control->rebuild_at, (u64)0);
}
