// Three rays along the axes through spheres (paper B, section 4.2).
//
// The sphere around j has the radius √(2/3) r, and a margin. The axis nearest to j is that on which the displacement is
// largest; its ray passes the centre within √(2/3) r. It begins outside of every sphere around a neighbour and ends
// behind the first crossing of each, by a margin: so it enters the sphere exactly once, and that hit counts. All others
// do not: of other rays, and of rays that leave a sphere. Proof in docs/rays.md.

#pragma once

#include "geometry.cuh"
#include "rays.cuh"

struct AxisRays {
    template <int WORDS>
    __device__ static void send(const Rays& rays, const float4& x, const Shift& s, u32 (&payload)[WORDS]) {
        const Geometry& g = rays.geometry;
        const float4 p = place(g, x);
        const u32 image = payload[PAYLOAD_IMAGE];
#pragma unroll 1
        for (u32 axis = 0; axis < 3; ++axis) {
            const float dx = axis == 0, dy = axis == 1, dz = axis == 2;
            payload[PAYLOAD_IMAGE] = image | axis << RAY_NUMBER_SHIFT;
            rt::trace(rays.handle, p.x - s.x + dx * g.start, p.y - s.y + dy * g.start, p.z - s.z + dz * g.start, dx, dy,
                      dz, g.length, payload);
        }
    }

    __device__ static Meeting meet(const Rays& rays) {
        Meeting m = meet_body(rays, rt::primitive_index());
        const Shift d = offset(rays.geometry, m.xi, m.xj, shift_of(rays.space, m.image));
        const float x = fabsf(d.x), y = fabsf(d.y), z = fabsf(d.z);
        const u32 nearest = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
        const float along = nearest == 0 ? d.x : nearest == 1 ? d.y : d.z;
        // A ray enters before it passes the centre.
        const bool enters = rt::hit_distance() < along - rays.geometry.start;
        m.near = m.near && enters && nearest == rt::payload<PAYLOAD_IMAGE>() >> RAY_NUMBER_SHIFT;
        return m;
    }
};
