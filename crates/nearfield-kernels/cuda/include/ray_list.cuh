// The list consumer: rows of neighbours, counted by one launch and filled by another.
//
// Where all radii are equal, the rays of a particle meet all of its neighbours and write their row alone. Where they
// differ, the acting ray adds a pair to the rows of both.

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
    if (!FILL && !list.rays.law.variable) list.count[number_of(list, i)] = payload[PAYLOAD_CONSUMER];
}

// Adds to a row that others add to.
template <bool FILL> __device__ inline void add_entry(const ListRays& list, u32 row, u32 index, u32 image) {
    if (!FILL) {
        atomicAdd(&list.count[row], 1u);
    } else {
        put(list, list.offset[row] + atomicSub(&list.count[row], 1u) - 1, index, image);
    }
}

template <class Probe, bool FILL> __device__ inline void list_pair(const ListRays& list) {
    const Meeting m = Probe::meet(list.rays);
    if (!m.near) return;
    const u32 i = number_of(list, m.i), j = number_of(list, m.j);
    if (list.rays.law.variable) {
        if (!acts(list.rays, m)) return;
        // Seen from j, i is in the opposite image.
        if (!list.half || i < j) add_entry<FILL>(list, i, j, m.image);
        if (!list.half || j < i) add_entry<FILL>(list, j, i, 26 - m.image);
    } else if (!list.half || i < j) {
        const u32 entries = rt::payload<PAYLOAD_CONSUMER>();
        if (FILL) put(list, list.offset[i] + entries, j, m.image);
        rt::set_payload<PAYLOAD_CONSUMER>(entries + 1);
    }
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
