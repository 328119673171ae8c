// Velocity Verlet and its thermostats, one particle at a time; the arithmetic of nearfield-cpu's engine.
//
// Langevin dynamics are the BAOAB splitting (Leimkuhler and Matthews, 2013): half kick, half drift, Ornstein-Uhlenbeck
// step, half drift, new forces, half kick. Noise is a function of (seed, step, id) alone.

#pragma once

#include "philox.cuh"
#include "predicate.cuh"

struct Moving {
    float4 position, velocity;
    int image[3];
    bool crossed;
};

__device__ inline Moving load_moving(const Particles& particles, u32 i) {
    return {particles.position[i], particles.velocity[i], {0, 0, 0}, false};
}

// Image counts change rarely, so `image` holds only what is to be added.
__device__ inline void store_moving(const Particles& particles, u32 i, const Moving& p) {
    particles.position[i] = p.position;
    particles.velocity[i] = p.velocity;
    if (p.crossed) {
        for (int axis = 0; axis < 3; ++axis) particles.image[3 * (u64)i + axis] += p.image[axis];
    }
}

__device__ inline bool all_finite(const float4& v) {
    // Zero times anything finite is zero.
    return (v.x * 0.0f + v.y * 0.0f) + v.z * 0.0f == 0.0f;
}

__device__ inline u64 failure(u64 step, u32 id) {
    return step << 32 | id;
}

__device__ inline float half_kick_of(const Integrator& how, const Moving& p) {
    return how.half_kick[__float_as_uint(p.velocity.w)];
}

__device__ inline void kick(Moving& p, float half_kick, const float4& force) {
    p.velocity.x += half_kick * force.x;
    p.velocity.y += half_kick * force.y;
    p.velocity.z += half_kick * force.z;
}

// In f64: capped forces of 1e30 square beyond f32.
RARE float3 shortened(double x, double y, double z, double most) {
    const double speed = sqrt((x * x + y * y) + z * z);
    const double scale = speed > most ? most / speed : 1.0;
    return make_float3((float)(x * scale), (float)(y * scale), (float)(z * scale));
}

// Shortens a velocity that would carry the particle beyond the displacement limit.
__device__ inline void limit(const Integrator& how, Moving& p) {
    float4& v = p.velocity;
    // Nearly always, and without square roots.
    const float below = how.speed_limit * how.speed_limit * 0.9999f;
    if (v.x * v.x + v.y * v.y + v.z * v.z < below || how.speed_limit == infinity()) return;
    const float3 within = shortened(v.x, v.y, v.z, how.speed_limit);
    v = make_float4(within.x, within.y, within.z, v.w);
}

// A coordinate and a velocity along an axis, and the periods that were taken from the coordinate.
struct Returned {
    float x, v;
    int crossings;
};

// SimBox::wrap of one axis.
__device__ inline Returned wrap(float lower, float upper, float x, float v) {
    const double lo = lower, hi = upper;
    const double count = floor(((double)x - lo) / (hi - lo));
    const float wrapped = (float)((double)x - count * (hi - lo));
    // Rounding to f32 may land on `upper` itself, which is the image of `lower`.
    const bool at_end = wrapped >= upper;
    return {at_end || wrapped < lower ? lower : wrapped, v, (int)count + (at_end ? 1 : 0)};
}

__device__ inline double euclidean_remainder(double x, double period) {
    const double r = fmod(x, period);
    return r < 0.0 ? r + period : r;
}

// Elastic reflection at both walls; a fast particle may bounce several times.
__device__ inline Returned reflect(float lower, float upper, float x, float v) {
    if (x == upper || !(fabsf(x) < infinity())) return {x, v, 0};
    const double lo = lower, hi = upper, length = hi - lo, from_lo = (double)x - lo;
    const double phase = euclidean_remainder(from_lo, 2.0 * length);
    const double reflected = phase > length ? 2.0 * length - phase : phase;
    const bool turned = euclidean_remainder(floor(from_lo / length), 2.0) == 1.0;
    return {clamped((float)(lo + reflected), lower, upper), turned ? -v : v, 0};
}

// What becomes of a particle that is not within the box.
RARE Returned returned(int boundary, float lower, float upper, float x, float v) {
    return boundary == 0 ? wrap(lower, upper, x, v) : reflect(lower, upper, x, v);
}

__device__ inline void apply_boundary(const Box3& space, int axis, float& x, float& v, Moving& p) {
    const int boundary = space.boundary[axis];
    if ((x >= space.lo[axis] && x < space.hi[axis]) || boundary > 1) return;
    const Returned at = returned(boundary, space.lo[axis], space.hi[axis], x, v);
    x = at.x;
    v = at.v;
    p.image[axis] += at.crossings;
    p.crossed |= boundary == 0;
}

__device__ inline void drift(const Integrator& how, Moving& p, float dt) {
    p.position.x += dt * p.velocity.x;
    p.position.y += dt * p.velocity.y;
    p.position.z += dt * p.velocity.z;
    apply_boundary(how.space, 0, p.position.x, p.velocity.x, p);
    apply_boundary(how.space, 1, p.position.y, p.velocity.y, p);
    apply_boundary(how.space, 2, p.position.z, p.velocity.z, p);
}

// First half kick and drift of `step`. Only with NOISE can it be one of Langevin dynamics.
template <bool NOISE>
__device__ inline void start_step(const Integrator& how, Moving& p, float half_kick, const float4& force, u32 id,
                                  u64 step) {
    kick(p, half_kick, force);
    limit(how, p);
    if (!NOISE || !how.langevin) {
        drift(how, p, how.dt);
        return;
    }
    drift(how, p, 0.5f * how.dt);
    const Normals noise = normals(how.seed[0], how.seed[1], step, id);
    const float strength = how.noise[__float_as_uint(p.velocity.w)];
    p.velocity.x = how.damping * p.velocity.x + strength * (float)noise.x;
    p.velocity.y = how.damping * p.velocity.y + strength * (float)noise.y;
    p.velocity.z = how.damping * p.velocity.z + strength * (float)noise.z;
    limit(how, p);
    drift(how, p, 0.5f * how.dt);
}

// Second half kick, limited too, so that observers see a velocity that the particle will move by.
__device__ inline void finish_step(const Integrator& how, Moving& p, float half_kick, const float4& force) {
    kick(p, half_kick, force);
    limit(how, p);
}

// The rest of `step` of particle `i`, `p`, and the beginning of the next. A particle that has failed is noted and left
// where it was, so that coordinates stay finite until the run is stopped.
template <bool NOISE>
__device__ inline bool advance(const Integrator& how, Status* status, const Particles& particles, u32 i, u64 step,
                               Moving& p, const float4& force) {
    if (!all_finite(force)) {
        atomicMin(&status->force, failure(step, particles.id[i]));
        return false;
    }
    // Random numbers take input indices; nothing else does.
    const u32 id = NOISE && how.langevin ? particles.id[i] : 0;
    const float half_kick = half_kick_of(how, p);
    finish_step(how, p, half_kick, force);
    start_step<NOISE>(how, p, half_kick, force, id, step + 1);
    if (!all_finite(p.position)) {
        atomicMin(&status->position, failure(step + 1, particles.id[i]));
        p = load_moving(particles, i);
        return false;
    }
    return true;
}
