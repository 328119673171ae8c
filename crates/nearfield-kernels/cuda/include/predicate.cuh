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

__device__ inline float squared_length(float x, float y, float z) {
    return fmaf(x, x, fmaf(y, y, z * z));
}

// From i to the image of j: the shift is added after the subtraction.
__device__ inline Shift displacement(const float4& xi, const float4& xj, const Shift& s) {
    return {(xj.x - xi.x) + s.x, (xj.y - xi.y) + s.y, (xj.z - xi.z) + s.z};
}
