// rt-list (RT-REF of paper A): rows of neighbours, counted by one launch and filled by another.
//
// Where all radii are equal, a ray meets all neighbours of its particle and writes their row alone. Where they differ,
// the acting ray adds a pair to the rows of both.

#include "rays.cuh"

PARAMETERS(ListRays)

__device__ inline u32 number_of(u32 place) {
    return params.id ? params.id[place] : place;
}

__device__ inline void put(u64 at, u32 index, u32 image) {
    params.index[at - params.base] = index;
    if (params.image) params.image[at - params.base] = (u8)image;
}

template <bool FILL> __device__ inline void list_rays() {
    const u32 i = params.rays.first + rt::ray_index();
    u32 payload[PAYLOAD_CONSUMER + 1] = {};
    send_rays(params.rays, i, payload);
    if (!FILL && !params.rays.law.variable) params.count[number_of(i)] = payload[PAYLOAD_CONSUMER];
}

// Adds to a row that others add to.
template <bool FILL> __device__ inline void add_entry(u32 row, u32 index, u32 image) {
    if (!FILL) {
        atomicAdd(&params.count[row], 1u);
    } else {
        put(params.offset[row] + atomicSub(&params.count[row], 1u) - 1, index, image);
    }
}

template <bool FILL> __device__ inline void list_pair() {
    const Meeting m = meet(params.rays);
    if (!m.near) return;
    const u32 i = number_of(m.i), j = number_of(m.j);
    if (params.rays.law.variable) {
        if (!acts(params.rays, m)) return;
        // Seen from j, i is in the opposite image.
        if (!params.half || i < j) add_entry<FILL>(i, j, m.image);
        if (!params.half || j < i) add_entry<FILL>(j, i, 26 - m.image);
    } else if (!params.half || i < j) {
        const u32 entries = rt::payload<PAYLOAD_CONSUMER>();
        if (FILL) put(params.offset[i] + entries, j, m.image);
        rt::set_payload<PAYLOAD_CONSUMER>(entries + 1);
    }
}

RAYGEN(count) {
    list_rays<false>();
}
INTERSECTION(count) {
    list_pair<false>();
}
RAYGEN(fill) {
    list_rays<true>();
}
INTERSECTION(fill) {
    list_pair<true>();
}
