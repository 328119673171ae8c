// Places of spheres, squares and their rays.
//
// Coordinates are clamped to the box and some way beyond, so that their rounding is known: on open axes particles may
// be anywhere. That brings no two particles further apart on any axis, so neighbours stay where rays find them.

#pragma once

#include "predicate.cuh"

__device__ inline float4 place(const Geometry& g, const float4& x) {
    return make_float4(fminf(fmaxf(x.x, g.lo[0]), g.hi[0]), fminf(fmaxf(x.y, g.lo[1]), g.hi[1]),
                       fminf(fmaxf(x.z, g.lo[2]), g.hi[2]), x.w);
}

// From the place of i to that of the image of j. What decides which ray counts is a function of this alone, and
// therefore the same in all hits of a pair.
__device__ inline Shift offset(const Geometry& g, const float4& xi, const float4& xj, const Shift& s) {
    return displacement(place(g, xi), place(g, xj), s);
}
