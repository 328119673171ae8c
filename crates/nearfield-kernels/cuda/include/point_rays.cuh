// Infinitesimal rays through boxes.
//
// Particle j is a box around its position whose half width is its radius, so an infinitesimal ray from i meets exactly
// the j with |x_i - x_j| < r_j on each axis; the predicate refuses the rest. A pair with r_j <= d < r_i is met from the
// side of j alone: where radii differ, the particle of the smaller radius acts for both.

#pragma once

#include "rays.cuh"

struct PointRays {
    template <int WORDS>
    __device__ static void send(const Rays& rays, const float4& x, const Shift& s, u32 (&payload)[WORDS]) {
        const float4 p = seen(rays.space, x);
        rt::trace_point(rays.handle, p.x - s.x, p.y - s.y, p.z - s.z, payload);
    }

    __device__ static Meeting meet(const Rays& rays) {
        return meet_body(rays, rt::primitive_index());
    }
};

// Whether the ray of i is the one that counts for the pair: that of the smaller radius, which is sure to be inside of
// the other's box, and of equal ones that of the smaller place.
__device__ inline bool acts(const Rays& rays, const Meeting& m) {
    if (!rays.law.variable || m.xi.w == m.xj.w) return m.i < m.j;
    return m.xi.w < m.xj.w;
}
