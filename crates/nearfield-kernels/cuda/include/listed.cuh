// Lists of clusters: for each cluster of 8 consecutive particles, what is near any of them, in chunks of 32.

#pragma once

#include "cluster.cuh"

// An entry is a slot, with this bit where its pairs need care: they may be at another image than home, now or once a
// particle has crossed a face, or be of a particle with itself.
#define LISTED_CARE 0x80000000u

// Fills the last chunk.
#define LISTED_NONE 0xffffffffu

#define NO_SEGMENT 0xffffffffu

__device__ inline u32 clusters_of(u32 n) {
    return (n + CLUSTER - 1) / CLUSTER;
}

__device__ inline u32 slot_of(u32 entry, u32 otherwise) {
    return entry == LISTED_NONE ? otherwise : entry & ~LISTED_CARE;
}

// Takes the list of a cluster 32 entries at a time to `v`. The next entries and positions are on their way meanwhile.
template <class V> __device__ inline void meet_listed(const ListedArgs& a, u32 cluster, V& v) {
    for (u32 s = cluster; s != NO_SEGMENT;) {
        const Segment segment = a.segment[s];
        s = segment.next;
        const u32* entry = a.entry + (u64)segment.begin * WARP + threadIdx.x % WARP;
        const u32 chunks = segment.end - segment.begin;
        if (chunks == 0) continue;
        u32 now = entry[0], next = chunks > 1 ? entry[WARP] : LISTED_NONE;
        float4 x = v.slots[slot_of(now, v.first)];
        for (u32 k = 0; k < chunks; ++k) {
            const u32 e = now;
            const float4 xj = x;
            now = next;
            if (k + 1 < chunks) x = v.slots[slot_of(now, v.first)];
            next = k + 2 < chunks ? entry[(k + 2) * WARP] : LISTED_NONE;
            const u32 slot = slot_of(e, v.first);
            const bool valid = e != LISTED_NONE;
            if (v.is_partial() || __any_sync(ALL_LANES, valid && (e & LISTED_CARE))) {
                v.template pairs<NEAREST, true>(slot, xj, valid, HOME_IMAGE);
            } else {
                v.template pairs<HOME, false>(slot, xj, valid, HOME_IMAGE);
            }
        }
    }
}

// Whether a particle is further than a limit from where it was when a list was made. Whole periods do not count: lists
// hold for any of them.
__device__ inline bool has_moved(const Box3& space, const float4& from, const float4& to, float limit2) {
    u32 image;
    const Shift d = separation<NEAREST>(space, from, to, {0.0f, 0.0f, 0.0f}, image);
    return !(squared_length(d.x, d.y, d.z) <= limit2);
}
