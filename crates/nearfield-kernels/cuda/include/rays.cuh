// Rays from particles: which periodic images they look at, and which particles they meet.
//
// Particle j is a box around its position whose half width is its radius, so an infinitesimal ray from i meets exactly
// the j with |x_i - x_j| < r_j on each axis; the predicate refuses the rest. A pair with r_j <= d < r_i is met from the
// side of j alone: where radii differ, the particle of the smaller radius acts for both.

#pragma once

#include "predicate.cuh"
#include "raytracing.cuh"

enum View { GAMMA, INSTANCES, GHOSTS };

// Words of the payload: position and radius of the ray's particle, the image that the ray looks at, then words of the
// consumer.
#define PAYLOAD_POSITION 0
#define PAYLOAD_IMAGE 4
#define PAYLOAD_CONSUMER 5

// Whether images of particles -1, 0 and +1 boxes away along an axis are within reach, as bits 0 to 2.
__device__ inline u32 reach(float x, float near_lo, float near_hi) {
    return (x <= near_lo ? 1u : 0u) | 2u | (x >= near_hi ? 4u : 0u);
}

// Sends the rays of a particle. Gamma rays (paper A, section 3.3) start where the particle is seen from the image.
template <int WORDS> __device__ inline void send_rays(const Rays& rays, u32 i, u32 (&payload)[WORDS]) {
    const float4 x = rays.particles.position[i];
    payload[PAYLOAD_POSITION] = __float_as_uint(x.x);
    payload[PAYLOAD_POSITION + 1] = __float_as_uint(x.y);
    payload[PAYLOAD_POSITION + 2] = __float_as_uint(x.z);
    payload[PAYLOAD_POSITION + 3] = __float_as_uint(x.w);
    u32 n_images = 1, near[3] = {};
    if (rays.view == GAMMA) {
        near[0] = reach(x.x, rays.near_lo[0], rays.near_hi[0]);
        near[1] = reach(x.y, rays.near_lo[1], rays.near_hi[1]);
        near[2] = reach(x.z, rays.near_lo[2], rays.near_hi[2]);
        // Most particles are far from all faces.
        if ((near[0] | near[1] | near[2]) != 2u) n_images = rays.n_images;
    }
    for (u32 k = 0; k < n_images; ++k) {
        const u32 image = rays.image[k];
        if (k > 0 && !(near[0] >> image % 3 & near[1] >> image / 3 % 3 & near[2] >> image / 9 & 1)) continue;
        const Shift s = shift_of(rays.space, image);
        payload[PAYLOAD_IMAGE] = image;
        rt::trace(rays.handle, x.x - s.x, x.y - s.y, x.z - s.z, payload);
    }
}

// What an intersection program sees: particle i, whose ray it is, and the image of j whose box holds the ray.
struct Meeting {
    u32 i, j, image;
    float4 xi, xj;
    Shift d;
    float r2, range;
    // Whether they are neighbours, by the predicate.
    bool near;
};

__device__ inline Meeting meet(const Rays& rays) {
    Meeting m;
    m.i = rays.first + rt::ray_index();
    m.j = rt::primitive_index();
    m.image = HOME_IMAGE;
    if (rays.view == GAMMA) {
        m.image = rt::payload<PAYLOAD_IMAGE>();
    } else if (rays.view == INSTANCES) {
        m.image = rays.image[rt::instance_index()];
    } else if (m.j >= rays.particles.n) {
        const Ghost ghost = rays.ghost[m.j - rays.particles.n];
        m.j = ghost.particle;
        m.image = ghost.image;
    }
    m.xi = make_float4(__uint_as_float(rt::payload<PAYLOAD_POSITION>()),
                       __uint_as_float(rt::payload<PAYLOAD_POSITION + 1>()),
                       __uint_as_float(rt::payload<PAYLOAD_POSITION + 2>()),
                       __uint_as_float(rt::payload<PAYLOAD_POSITION + 3>()));
    m.xj = rays.particles.position[m.j];
    // Most pairs are seen in the box itself.
    const Shift s = m.image == HOME_IMAGE ? Shift{0.0f, 0.0f, 0.0f} : shift_of(rays.space, m.image);
    m.d = displacement(m.xi, m.xj, s);
    m.r2 = squared_length(m.d.x, m.d.y, m.d.z);
    m.range = (rays.law.variable ? fmaxf(m.xi.w, m.xj.w) : rays.law.cutoff) + rays.skin;
    m.near = m.r2 < m.range * m.range && !(m.j == m.i && m.image == HOME_IMAGE);
    return m;
}

// Whether the ray of i is the one that counts for the pair: that of the smaller radius, which is sure to be inside of
// the other's box, and of equal ones that of the smaller place.
__device__ inline bool acts(const Rays& rays, const Meeting& m) {
    if (!rays.law.variable || m.xi.w == m.xj.w) return m.i < m.j;
    return m.xi.w < m.xj.w;
}
