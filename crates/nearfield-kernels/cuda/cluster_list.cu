// Builds lists of clusters, and tells whether and how long they serve.

#include "listed.cuh"
#include "particles.cuh"

// Entries that a warp keeps before it writes them, all but the last chunk full.
#define STAGE (SEGMENT_ENTRIES + WARP)

// A candidate is listed if it is near any particle of the cluster, now or before the list is built anew; once, whatever
// its images near the cluster are.
struct Listing : Cluster {
    const ClusterListArgs& a;
    u32* stage;
    u32 count, staged;
    u32 segment;  // that is filled next
    bool apart;   // particles are searched for one by one, or some candidate may be near two of them at two images
    bool by_pair; // see `Segment`
    bool far;     // neither the cluster nor candidates may cross a face
    float reach2; // square of the range, skin and slack included

    __device__ Listing(const ClusterListArgs& arguments, const ClusterPlace& place, u32 number, u32* entries)
        : a(arguments), stage(entries), count(place.count), staged(0), segment(number) {
        load(a.law, a.grid.slot, place);
        if (a.once) least = first;
        const Bounds box = cluster_bounds(x);
        const float reach = cutoff + a.slack;
        reach2 = reach * reach;
        apart = is_spread(box, a.grid.classes[0], a.grid.classes[0].largest);
        by_pair = false;
        far = true;
        for (int axis = 0; axis < 3; ++axis) {
            if (a.space.boundary[axis] != 0) continue;
            const float extent = box.hi[axis] - box.lo[axis], length = a.space.length[axis];
            const float to_face = smaller(box.lo[axis] - a.space.lo[axis], a.space.hi[axis] - box.hi[axis]);
            apart = apart || !((extent + 2.0f * reach) * RANGE_MARGIN < length);
            by_pair = by_pair || to_face <= a.margin || !(2.0f * (extent + reach) * RANGE_MARGIN < length);
            far = far && to_face > reach + a.margin;
        }
        by_pair = by_pair || apart;
        if (!apart) list_own();
    }

    // Entries that need care for being the particles themselves are in one chunk, the first.
    __device__ void list_own() {
        const u32 lane = threadIdx.x % WARP;
        const float4 own = slots[first + smaller(lane, count - 1)];
        bool near = false;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) near = near | ((k != lane) & (k < count) & (distance2(own, k) < reach2));
        append(first + lane, near && lane < count, true);
    }

    __device__ float distance2(const float4& p, u32 k) const {
        return squared_length(p.x - x[k].x, p.y - x[k].y, p.z - x[k].z);
    }

    __device__ void meet(const Candidate& c) {
        if (apart) {
            append(c.slot, c.valid && is_listed(c.slot, c.x, c.image), true);
            return;
        }
        const bool care = c.image != HOME_IMAGE || (!far && is_near_face(c.x));
        // The margins cover that this is not rounded as pairs are.
        float4 xj = c.x;
        if (c.image != HOME_IMAGE) {
            const Shift shift = shift_of(a.space, c.image);
            xj = make_float4(xj.x + shift.x, xj.y + shift.y, xj.z + shift.z, xj.w);
        }
        float least = infinity();
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) least = fminf(least, distance2(xj, k));
        append(c.slot, c.valid && least < reach2 && c.slot - first >= count, care);
    }

    __device__ bool is_near_face(const float4& p) const {
        return is_near_face(0, p.x) || is_near_face(1, p.y) || is_near_face(2, p.z);
    }

    __device__ bool is_near_face(int axis, float v) const {
        return a.space.boundary[axis] == 0 &&
               (v - a.space.lo[axis] <= a.margin || a.space.hi[axis] - v <= a.margin);
    }

    // Whether this image is that at which the first of the particles near the candidate sees it, and that particle is
    // searched for: so it is listed once.
    __device__ bool is_listed(u32 slot, const float4& xj, u32 image) const {
        const u32 own = slot - first;
        u32 nearest = image, near = 0;
#pragma unroll
        for (int k = CLUSTER - 1; k >= 0; --k) {
            const Shift d = separation<NEAREST>(a.space, x[k], xj, {0.0f, 0.0f, 0.0f});
            if (squared_length(d.x, d.y, d.z) < reach2 && own != k && k < count) {
                near |= 1u << k;
                nearest = nearest_image(a.space, x[k], xj);
            }
        }
        return (near & (0u - near) & active) != 0 && nearest == image;
    }

    __device__ void append(u32 slot, bool listed, bool care) {
        const u32 votes = __ballot_sync(ALL_LANES, listed);
        if (listed) stage[staged + __popc(votes & lanes_below())] = slot | (care ? LISTED_CARE : 0);
        staged += __popc(votes);
        __syncwarp();
        if (staged > SEGMENT_ENTRIES) write(SEGMENT_ENTRIES, false);
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
            if (segment < a.segment_capacity) a.segment[segment] = {begin, begin + chunks, next, by_pair};
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
    const ClusterPlace cluster = consecutive_cluster(a.n, number);
    if (cluster.count == 0) return;
    Listing listing(a, cluster, number, stage[warp]);
    search_cells<false>(a.grid, a.space, a.slack, cluster, cluster_bounds(listing.x), scratch[warp], listing);
    listing.finish();
}

KERNEL(begin_steps, ClusterControlArgs, 32) {
    if (thread_index() != 0) return;
    ClusterControl& c = *a.control;
    c.first = c.next = a.step;
    c.end = a.end;
    c.lists = c.longest = c.dangerous = 0;
}

// Notes how the list has served, and that there is none now.
__device__ inline void end_list(ClusterControl& c) {
    const u32 served = (u32)(c.next - c.first);
    if (served > 0) {
        ++c.lists;
        c.longest = larger(c.longest, served);
        c.dangerous += served == 1 && c.rebuild_at <= c.next;
    }
    c.first = c.next;
    c.rebuild_at = ~0ull;
    c.chunks = c.segments = 0;
}

KERNEL(begin_list, ClusterControlArgs, 32) {
    if (thread_index() == 0) end_list(*a.control);
}

// Where they were just sorted, particles hardly move: writes are nearly in order.
KERNEL(sort_particles, SortParticlesArgs, 256) {
    const u32 i = thread_index();
    if (i == 0) end_list(*a.control);
    if (i >= a.sort.n) return;
    const u32 slot = take_slot(a.sort, i);
    a.sort.grid.slot[slot] = a.from.position[i];
    copy_particle(a.from, i, a.to, slot, a.place);
}

KERNEL(clusters_moved, ClustersMovedArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    if (has_moved(a.space, a.reference[i], a.position[i], a.limit2)) atomicMin(&a.control->rebuild_at, (u64)0);
}
