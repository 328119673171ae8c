// Counting sort of particles into cells: how many are in each and which number each has, a scan of the counts, and the
// particles in that order. What must be zero at first is set by the kernels themselves: fills would take as long as they.

#include "grid.cuh"

// Launched for one thread at least.
KERNEL(cell_count, SortArgs, 256) {
    const u32 i = thread_index();
    for (u32 t = i; t < a.n_tiles; t += gridDim.x * blockDim.x) a.tiles[t] = 0;
    if (i >= a.n) return;
    const float4 p = a.position[i];
    const u32 cell = cell_of(a.grid.classes[a.variable ? class_of(a.grid, p.w) : 0], p);
    a.cell[i] = cell;
    a.rank[i] = atomicAdd(a.count + cell, 1u);
}

KERNEL(cell_scatter, SortArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const u32 slot = take_slot(a, i);
    a.grid.slot[slot] = a.position[i];
    a.grid.particle[slot] = i;
}

// So that who meets a slot need not look for its particle's number in two places.
KERNEL(number_slots, NumberArgs, 256) {
    const u32 slot = thread_index();
    if (slot < a.n) a.number[slot] = a.id[a.particle[slot]];
}
