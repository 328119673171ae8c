// Lists of clusters: for each cluster of 8 consecutive particles, what is near any of them, in chunks of 32.

#pragma once

#include "cluster.cuh"

// An entry is a slot, with this bit where its pairs need care: they may be at another image than home, now or once a
// particle has crossed a face, or be of a particle with itself.
#define LISTED_CARE 0x80000000u

// Fills the last chunk: slot 0 with this bit.
#define LISTED_NONE 0x40000000u

#define LISTED_SLOT 0x3fffffffu

#define NO_SEGMENT 0xffffffffu

// Most entries of a segment.
#define SEGMENT_ENTRIES (15 * WARP)

__device__ inline u64 step_of(const ListedArgs& a) {
    return a.control->first + a.index;
}

__device__ inline bool serves(const ListedArgs& a) {
    if (!a.control) return true;
    const u64 step = step_of(a);
    return step < a.control->rebuild_at && step < a.control->end;
}

// Takes the list of a cluster 32 entries at a time to `v`, by way of shared memory for a segment of each warp. The next
// positions are on their way meanwhile; entries are not, since no registers are left to keep them in.
template <class V>
__device__ inline void meet_listed(const ListedArgs& a, u32 cluster, u32 (&entries)[WARPS_PER_BLOCK * SEGMENT_ENTRIES],
                                   V& v) {
    const u32 begin = threadIdx.x / WARP * SEGMENT_ENTRIES + threadIdx.x % WARP;
    for (u32 s = cluster; s != NO_SEGMENT; s = a.segment[s].next) {
        const Segment segment = a.segment[s];
        if (segment.begin == segment.end) continue;
        const u32* entry = a.entry + (u64)segment.begin * WARP + threadIdx.x % WARP;
        const u32 end = begin + (segment.end - segment.begin) * WARP;
        // Each lane reads what it has written. Several loads are on their way at a time.
        for (u32 k = begin; k < end; k += 4 * WARP, entry += 4 * WARP) {
            u32 part[4];
#pragma unroll
            for (u32 q = 0; q < 4; ++q) part[q] = k + q * WARP < end ? entry[q * WARP] : LISTED_NONE;
#pragma unroll
            for (u32 q = 0; q < 4; ++q) {
                if (k + q * WARP < end) entries[k + q * WARP] = part[q];
            }
        }
        const bool by_pair = segment.by_pair || v.is_partial();
        u32 next = entries[begin];
        float4 next_x = v.slots[next & LISTED_SLOT];
#pragma unroll 1
        for (u32 k = begin + WARP; k < end + WARP; k += WARP) {
            const u32 now = next, slot = now & LISTED_SLOT;
            const float4 x = next_x;
            const bool valid = (now & LISTED_NONE) == 0;
            if (k < end) {
                next = entries[k];
                next_x = v.slots[next & LISTED_SLOT];
            }
            if (by_pair) {
                v.template pairs<NEAREST, true>(slot, x, valid);
            } else if (__any_sync(ALL_LANES, now & LISTED_CARE)) {
                v.care(slot, x, valid);
            } else {
                v.template pairs<HOME, false>(slot, x, valid);
            }
        }
    }
}

// Whether a particle is further than a limit from where it was when a list was made. Whole periods do not count: lists
// hold for any of them.
__device__ inline bool has_moved(const Box3& space, const float4& from, const float4& to, float limit2) {
    const Shift d = separation<NEAREST>(space, from, to, {0.0f, 0.0f, 0.0f});
    return !(squared_length(d.x, d.y, d.z) <= limit2);
}
