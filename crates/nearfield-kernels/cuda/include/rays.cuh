// Rays from particles: which periodic images they look at, and which particles they meet.
//
// What the rays are is the `Probe` of a template: point_rays.cuh, axis_rays.cuh or edge_rays.cuh.

#pragma once

#include "predicate.cuh"
#include "raytracing.cuh"

enum View { GAMMA, INSTANCES, GHOSTS };

// Words of the payload: position and radius of the ray's particle, the image that the ray looks at, then words of the
// consumer.
#define PAYLOAD_POSITION 0
#define PAYLOAD_IMAGE 4
#define PAYLOAD_CONSUMER 5
// In the word of the image, above its number: which of its particle's rays it is, where there are several.
#define RAY_NUMBER_SHIFT 8

// Whether images of particles -1, 0 and +1 boxes away along an axis are within reach, as bits 0 to 2.
__device__ inline u32 reach(float x, float near_lo, float near_hi) {
    return (x <= near_lo ? 1u : 0u) | 2u | (x >= near_hi ? 4u : 0u);
}

// Sends the rays of a particle. Gamma rays (paper A, section 3.3) start where the particle is seen from the image.
template <class Probe, int WORDS> __device__ inline void send_rays(const Rays& rays, u32 i, u32 (&payload)[WORDS]) {
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
        Probe::send(rays, x, s, payload);
    }
}

// What the program of a primitive sees: particle i, whose ray it is, and the image of j whose body the ray meets.
struct Meeting {
    u32 i, j, image;
    float4 xi, xj;
    Shift d;
    float r2, range;
    // Whether they are neighbours, by the predicate.
    bool near;
};

// Of a ray with a body: a particle's, or after those a ghost's.
__device__ inline Meeting meet_body(const Rays& rays, u32 body) {
    Meeting m;
    m.i = rays.first + rt::ray_index();
    m.j = body;
    m.image = HOME_IMAGE;
    if (rays.view == GAMMA) {
        m.image = rt::payload<PAYLOAD_IMAGE>() & ((1u << RAY_NUMBER_SHIFT) - 1);
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
