// The one definition of "neighbour" (nearfield_core::predicate), with the same roundings in the same order. Sources
// are compiled without contraction of products and sums, so every operation is the one written.

#pragma once

#include "layouts.cuh"

struct Shift {
    float x, y, z;
};

#define HOME_IMAGE 13u

__device__ inline Shift shift_of(const Box3& space, u32 image) {
    return {(float)((int)(image % 3) - 1) * space.length[0], (float)((int)(image / 3 % 3) - 1) * space.length[1],
            (float)((int)(image / 9) - 1) * space.length[2]};
}

// Where structures see a particle: on open axes it may be anywhere, and those who trace rays lose far ones to rounding.
// That brings no two particles further apart on any axis, so neighbours stay where they are found.
__device__ inline float seen_axis(const Box3& space, int axis, float x) {
    const float beyond = 1024.0f * space.length[axis];
    return fminf(fmaxf(x, space.lo[axis] - beyond), space.hi[axis] + beyond);
}

__device__ inline float4 seen(const Box3& space, const float4& x) {
    return make_float4(seen_axis(space, 0, x.x), seen_axis(space, 1, x.y), seen_axis(space, 2, x.z), x.w);
}

__device__ inline float squared_length(float x, float y, float z) {
    return fmaf(x, x, fmaf(y, y, z * z));
}

// From i to the image of j: the shift is added after the subtraction.
__device__ inline Shift displacement(const float4& xi, const float4& xj, const Shift& s) {
    return {(xj.x - xi.x) + s.x, (xj.y - xi.y) + s.y, (xj.z - xi.z) + s.z};
}
