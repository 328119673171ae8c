// Cells: which one a particle is in, in which order they are numbered, and which particles a warp takes.

#pragma once

#include "predicate.cuh"

// Particles that a warp takes at a time, consecutive in cell order.
#define CLUSTER 8

// Cell along an axis. It never decreases with `x`, rounding included, so the particles between two coordinates are in
// the cells between theirs. The outermost cells extend to infinity; NaN is in cell 0.
__device__ inline u32 cell_coordinate(const CellClass& c, int axis, float x) {
    return (u32)fminf(fmaxf((x - c.lo[axis]) * c.per_length[axis], 0.0f), (float)(c.n[axis] - 1));
}

// Number of a row in snake order: backwards in odd planes.
__device__ inline u32 row_number(const CellClass& c, u32 y, u32 z) {
    return z * c.n[1] + (z & 1 ? c.n[1] - 1 - y : y);
}

// First cell of cells `x0` to `x1` of a row, all of which are consecutive: backwards in odd rows.
__device__ inline u32 first_of_cells(const CellClass& c, u32 row, u32 x0, u32 x1) {
    return c.first_cell + row * c.n[0] + (row & 1 ? c.n[0] - 1 - x1 : x0);
}

__device__ inline u32 class_of(const Grid& grid, float radius) {
    u32 k = 0;
    while (k + 1 < grid.n_classes && radius > grid.classes[k].limit) ++k;
    return k;
}

// Cell of a particle among those of all classes.
__device__ inline u32 cell_of(const CellClass& c, const float4& p) {
    const u32 x = cell_coordinate(c, 0, p.x);
    return first_of_cells(c, row_number(c, cell_coordinate(c, 1, p.y), cell_coordinate(c, 2, p.z)), x, x);
}

// Slot of a particle in a sort that has been counted and scanned; its cell is then counted from zero again.
__device__ inline u32 take_slot(const SortArgs& a, u32 i) {
    const u32 cell = a.cell[i];
    a.count[cell] = 0;
    return a.grid.cell_start[cell] + a.rank[i];
}

// Place of a slot's particle; slots are places where nothing has been sorted.
__device__ inline u32 place_of(const Grid& grid, u32 slot) {
    return grid.particle ? grid.particle[slot] : slot;
}

// The slots of a warp: up to CLUSTER consecutive ones of one class.
struct ClusterPlace {
    u32 first, count; // none: no cluster
    u32 of_class;
};

// Each class has clusters of its own, so that none straddles two.
__device__ inline ClusterPlace find_cluster(const Grid& grid, u32 n, u32 number) {
    u32 begin = 0;
    for (u32 k = 0; k < grid.n_classes; ++k) {
        const u32 end = k + 1 < grid.n_classes ? grid.cell_start[grid.classes[k + 1].first_cell] : n;
        const u32 clusters = (end - begin + CLUSTER - 1) / CLUSTER;
        if (number < clusters) {
            const u32 first = begin + number * CLUSTER;
            return {first, smaller(end - first, (u32)CLUSTER), k};
        }
        number -= clusters;
        begin = end;
    }
    return {0, 0, 0};
}

// Clusters regardless of classes.
__device__ inline ClusterPlace consecutive_cluster(u32 n, u32 number) {
    const u64 first = (u64)number * CLUSTER;
    if (first >= n) return {0, 0, 0};
    return {(u32)first, smaller(n - (u32)first, (u32)CLUSTER), 0};
}
