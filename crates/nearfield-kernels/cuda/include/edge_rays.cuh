// Four rays along the edges of a cube through squares, two faces of a cube (paper B, section 4.3).
//
// The cubes of neighbours are of width r. The edge of i's cube on the side of j along y and z passes through j's: of
// the face at x_j - r/2, where j is not below i along x, else of the face at x_j + r/2. Squares are larger than faces
// and rays longer than edges by margins, and of the two triangles of a square each reaches beyond the diagonal by a
// margin. So that ray meets that triangle for certain, and no other hit counts. Proof in docs/rays.md.

#pragma once

#include "geometry.cuh"
#include "rays.cuh"

struct EdgeRays {
    template <int WORDS>
    __device__ static void send(const Rays& rays, const float4& x, const Shift& s, u32 (&payload)[WORDS]) {
        const Geometry& g = rays.geometry;
        const float4 p = place(g, x);
        const u32 image = payload[PAYLOAD_IMAGE];
#pragma unroll 1
        for (u32 edge = 0; edge < 4; ++edge) {
            payload[PAYLOAD_IMAGE] = image | edge << RAY_NUMBER_SHIFT;
            rt::trace(rays.handle, p.x - s.x + g.start, p.y - s.y + (edge & 1 ? -g.offset : g.offset),
                      p.z - s.z + (edge & 2 ? -g.offset : g.offset), 1.0f, 0.0f, 0.0f, g.length, payload);
        }
    }

    __device__ static Meeting meet(const Rays& rays) {
        const u32 primitive = rt::primitive_index();
        Meeting m = meet_body(rays, primitive / 4);
        const Shift d = offset(rays.geometry, m.xi, m.xj, shift_of(rays.space, m.image));
        const u32 below_y = d.y < 0.0f, below_z = d.z < 0.0f;
        const u32 square = d.x < 0.0f;
        // Where the ray passes through the square.
        const float y = (below_y ? -rays.geometry.offset : rays.geometry.offset) - d.y;
        const float z = (below_z ? -rays.geometry.offset : rays.geometry.offset) - d.z;
        const u32 triangle = z > y;
        m.near = m.near && primitive % 4 == 2 * square + triangle &&
                 rt::payload<PAYLOAD_IMAGE>() >> RAY_NUMBER_SHIFT == below_y + 2 * below_z;
        return m;
    }
};
