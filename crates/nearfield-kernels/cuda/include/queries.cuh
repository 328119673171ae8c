// Queries of one set of points against another: for each query the points within its own radius.

#pragma once

#include "lists.cuh"

// What counting and filling share. Points have no radii, and none is a query; a row is written by the warp of its query.
template <class D> struct QueryLister : Cluster {
    const ListArgs& a;
    u32 id; // lane k: row of query k

    __device__ QueryLister(const QueryArgs& arguments, const ClusterPlace& place) : a(arguments.list) {
        load(arguments.list.law, arguments.query, place);
        slots = a.grid.slot;
        id = arguments.row[first + smaller(threadIdx.x % WARP, place.count - 1)];
    }

    __device__ bool owns_rows() const {
        return true;
    }

    __device__ void meet(const Candidate& c) {
        if (__any_sync(ALL_LANES, c.valid && c.image != HOME_IMAGE)) {
            pairs<SHIFTED>(c);
        } else {
            pairs<HOME>(c);
        }
    }

    template <Images IMAGES> __device__ void pairs(const Candidate& c) {
        const u32 id_j = D::FILLS ? a.id[c.slot] : 0;
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && c.image != HOME_IMAGE) shift = shift_of(a.space, c.image);
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            const Shift d = separation<IMAGES>(a.space, x[k], c.x, shift);
            const bool in = c.valid & (squared_length(d.x, d.y, d.z) < x[k].w * x[k].w) & ((active >> k & 1) != 0);
            static_cast<D*>(this)->mine(k, in, id_j, c.image);
        }
    }
};

// Points near the queries of a cluster, whose radii are at most `v.radius`.
template <class V>
__device__ inline void search_points(const QueryArgs& a, const ClusterPlace& cluster, Scratch& scratch, V& v) {
    const Grid& grid = a.list.grid;
    const CellClass& cells = grid.classes[0];
    const Bounds box = cluster_bounds(v.x);
    const bool apart = is_spread(box, cells, v.radius);
    Pending pending = {0, 0, 0};
    for (u32 part = 0; part < (apart ? cluster.count : 1); ++part) {
        const float4 own = a.query[cluster.first + part];
        v.active = apart ? 1u << part : (1u << cluster.count) - 1;
        const Bounds part_box = apart ? point_bounds(own) : box;
        const float range = apart ? own.w : v.radius;
        const RowSearch search = {cells, grid.cell_start, a.list.space, part_box, range, a.list.slack, 0};
        search_class<false>(search, scratch, pending, true, v);
    }
}
