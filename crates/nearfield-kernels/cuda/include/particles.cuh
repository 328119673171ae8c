// Particles that get another place in memory.

#pragma once

#include "layouts.cuh"

// Particle `i` becomes particle `k`.
__device__ inline void copy_particle(const Particles& from, u32 i, const Particles& to, u32 k, u32* place) {
    const u32 id = from.id[i];
    to.position[k] = from.position[i];
    to.velocity[k] = from.velocity[i];
    for (int axis = 0; axis < 3; ++axis) to.image[3 * (u64)k + axis] = from.image[3 * (u64)i + axis];
    to.id[k] = id;
    place[id] = k;
}
