// The list consumer: rows of neighbours, counted by one launch and filled by another.
//
// The rays of a particle fill the front of its row, whose entries they count in the payload. Where radii differ, the
// acting ray also adds the pair to the other's row, with atomic operations and from the back.

#pragma once

#include "point_rays.cuh"

__device__ inline u32 number_of(const ListRays& list, u32 place) {
    return list.id ? list.id[place] : place;
}

__device__ inline void put(const ListRays& list, u64 at, u32 index, u32 image) {
    list.index[at - list.base] = index;
    if (list.image) list.image[at - list.base] = (u8)image;
}

template <class Probe, bool FILL> __device__ inline void list_rays(const ListRays& list) {
    const u32 i = list.rays.first + rt::ray_index();
    u32 payload[PAYLOAD_CONSUMER + 1] = {};
    send_rays<Probe>(list.rays, i, payload);
    if (FILL) return;
    u32& count = list.count[number_of(list, i)];
    if (list.rays.law.variable) {
        atomicAdd(&count, payload[PAYLOAD_CONSUMER]);
    } else {
        count = payload[PAYLOAD_CONSUMER];
    }
}

// Adds to the row of the particle whose ray it is.
template <bool FILL> __device__ inline void add_own(const ListRays& list, u32 row, u32 index, u32 image) {
    const u32 entries = rt::payload<PAYLOAD_CONSUMER>();
    if (FILL) put(list, list.offset[row] + entries, index, image);
    rt::set_payload<PAYLOAD_CONSUMER>(entries + 1);
}

// Adds to another row.
template <bool FILL> __device__ inline void add_other(const ListRays& list, u32 row, u32 index, u32 image) {
    if (FILL) {
        put(list, list.offset[row] + atomicSub(&list.count[row], 1u) - 1, index, image);
    } else {
        atomicAdd(&list.count[row], 1u);
    }
}

template <class Probe, bool FILL> __device__ inline void list_pair(const ListRays& list) {
    const Meeting m = Probe::meet(list.rays);
    if (!m.near || (list.rays.law.variable && !acts(list.rays, m))) return;
    const u32 i = number_of(list, m.i), j = number_of(list, m.j);
    if (!list.half || i < j) add_own<FILL>(list, i, j, m.image);
    // Seen from j, i is in the opposite image.
    if (list.rays.law.variable && (!list.half || j < i)) add_other<FILL>(list, j, i, 26 - m.image);
}

#define LIST_INTERSECTION(Probe, name, FILL)                                                                           \
    RAYGEN(name) {                                                                                                     \
        list_rays<Probe, FILL>(params);                                                                                \
    }                                                                                                                  \
    INTERSECTION(name) {                                                                                               \
        list_pair<Probe, FILL>(params);                                                                                \
    }

#define LIST_ANYHIT(Probe, name, FILL)                                                                                 \
    RAYGEN(name) {                                                                                                     \
        list_rays<Probe, FILL>(params);                                                                                \
    }                                                                                                                  \
    ANYHIT(name) {                                                                                                     \
        list_pair<Probe, FILL>(params);                                                                                \
        rt::ignore_hit();                                                                                              \
    }

// Both programs of a module, by `LIST_INTERSECTION` or `LIST_ANYHIT`.
#define LIST(PROGRAMS, Probe)                                                                                          \
    PROGRAMS(Probe, count, false)                                                                                      \
    PROGRAMS(Probe, fill, true)
