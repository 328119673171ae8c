// Counting sort of particles into cells: how many are in each and which number each has, a scan of the counts, and the
// particles in that order.

#include "grid.cuh"

// `cell_start` counts from zero.
KERNEL(cell_count, SortArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const float4 p = a.position[i];
    const u32 cell = cell_of(a.grid.classes[a.variable ? class_of(a.grid, p.w) : 0], p);
    a.cell[i] = cell;
    a.rank[i] = atomicAdd(a.grid.cell_start + cell, 1u);
}

KERNEL(cell_scatter, SortArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const u32 slot = a.grid.cell_start[a.cell[i]] + a.rank[i];
    a.grid.slot[slot] = a.position[i];
    a.grid.particle[slot] = i;
}
