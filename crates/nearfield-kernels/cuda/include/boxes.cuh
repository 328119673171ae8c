// Boxes around particles and their images, and which images there are where particles are mirrored.

#pragma once

#include "predicate.cuh"

// Half the width of the box around a particle: its radius, rounded outwards as nearfield_core's conservative_range. Along
// open axes a particle may be far outside of the box, where corners are rounded more coarsely than `slack` knows.
__device__ inline float half_width(const BoxesArgs& a, const float4& x) {
    const float radius = (a.cutoff > 0.0f ? a.cutoff : x.w) + a.skin;
    const float farthest = fmaxf(fmaxf(fabsf(x.x), fabsf(x.y)), fabsf(x.z));
    return radius * 1.00000095367431640625f + a.slack + farthest * 4.76837158203125e-7f;
}

__device__ inline u32 faces_of_axis(const Box3& space, int axis, float x, float reach) {
    if (space.boundary[axis] != 0) return 0;
    return ((x - reach < space.lo[axis] ? 1u : 0u) | (x + reach >= space.hi[axis] ? 2u : 0u)) << 2 * axis;
}

// The periodic faces that a box of half width `reach` around a particle reaches. At the lower face, bit 2 axis, a
// particle is seen again in image +1, at the upper, bit 2 axis + 1, in image -1.
__device__ inline u32 faces_within(const Box3& space, const float4& x, float reach) {
    return faces_of_axis(space, 0, x.x, reach) | faces_of_axis(space, 1, x.y, reach) |
           faces_of_axis(space, 2, x.z, reach);
}

// The faces for which a particle has ghosts: those that it may reach before it has moved by the margin. Where it may
// even cross a face and be wrapped, it needs the opposite images, which stand by from the start.
__device__ inline u32 faces_with_ghosts(const BoxesArgs& a, const float4& x) {
    const u32 in_use = faces_within(a.space, x, half_width(a, x) + a.margin);
    if (in_use == 0) return 0;
    const u32 wrappable = faces_within(a.space, x, a.slack + a.margin);
    return in_use | wrappable | (wrappable & 0x15u) << 1 | (wrappable & 0x2au) >> 1;
}

// Notes when particle k, if it is one, needs a ghost that it lacks.
__device__ inline void note_missing_ghosts(const BoxesArgs& a, u32 k, const float4& x) {
    if (!a.faces || k >= a.n) return;
    if ((faces_within(a.space, x, half_width(a, x)) & ~(u32)a.faces[k]) != 0) *a.counter = 1;
}

// The faces by which a particle is seen in an image.
__device__ inline u32 faces_of_image(u32 image) {
    const u32 x = image % 3, y = image / 3 % 3, z = image / 9;
    return (x == 2 ? 1u : x == 0 ? 2u : 0u) | (y == 2 ? 1u : y == 0 ? 2u : 0u) << 2 |
           (z == 2 ? 1u : z == 0 ? 2u : 0u) << 4;
}

// Whether a particle with ghosts for these faces has one in an image.
__device__ inline bool has_ghost(u32 faces, u32 image) {
    return image != HOME_IMAGE && (faces_of_image(image) & ~faces) == 0;
}
