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

__device__ inline void kick(const Integrator& how, Moving& p, const float4& force) {
    const float half_kick = how.half_kick[__float_as_uint(p.velocity.w)];
    p.velocity.x += half_kick * force.x;
    p.velocity.y += half_kick * force.y;
    p.velocity.z += half_kick * force.z;
}

// Shortens a velocity that would carry the particle beyond the displacement limit.
__device__ inline void limit(const Integrator& how, Moving& p) {
    // Nearly always, and without square roots.
    const float below = how.speed_limit * how.speed_limit * 0.9999f;
    if (p.velocity.x * p.velocity.x + p.velocity.y * p.velocity.y + p.velocity.z * p.velocity.z < below) return;
    if (how.speed_limit == infinity()) return;
    // In f64: capped forces of 1e30 square beyond f32.
    const double x = p.velocity.x, y = p.velocity.y, z = p.velocity.z;
    const double speed = sqrt((x * x + y * y) + z * z);
    if (speed > (double)how.speed_limit) {
        const double scale = (double)how.speed_limit / speed;
        p.velocity.x = (float)(x * scale);
        p.velocity.y = (float)(y * scale);
        p.velocity.z = (float)(z * scale);
    }
}

// SimBox::wrap of one axis.
__device__ inline void wrap(const Box3& space, int axis, float& x, int& crossings) {
    const double lo = space.lo[axis], hi = space.hi[axis];
    const double count = floor(((double)x - lo) / (hi - lo));
    const float wrapped = (float)((double)x - count * (hi - lo));
    // Rounding to f32 may land on `hi` itself, which is the image of `lo`.
    const bool at_end = wrapped >= space.hi[axis];
    x = at_end || wrapped < space.lo[axis] ? space.lo[axis] : wrapped;
    crossings = (int)count + (at_end ? 1 : 0);
}

__device__ inline double euclidean_remainder(double x, double period) {
    const double r = fmod(x, period);
    return r < 0.0 ? r + period : r;
}

// Elastic reflection at both walls; a fast particle may bounce several times.
__device__ inline void reflect(const Box3& space, int axis, float& x, float& v) {
    const float lo = space.lo[axis], hi = space.hi[axis];
    if ((x >= lo && x <= hi) || !(fabsf(x) < infinity())) return;
    const double length = (double)hi - (double)lo, from_lo = (double)x - (double)lo;
    const double phase = euclidean_remainder(from_lo, 2.0 * length);
    const double reflected = phase > length ? 2.0 * length - phase : phase;
    x = clamped((float)((double)lo + reflected), lo, hi);
    if (euclidean_remainder(floor(from_lo / length), 2.0) == 1.0) v = -v;
}

__device__ inline void apply_boundary(const Box3& space, int axis, float& x, float& v, Moving& p) {
    if (x >= space.lo[axis] && x < space.hi[axis]) return;
    if (space.boundary[axis] == 0) {
        int crossings;
        wrap(space, axis, x, crossings);
        p.image[axis] += crossings;
        p.crossed = true;
    } else if (space.boundary[axis] == 1) {
        reflect(space, axis, x, v);
    }
}

__device__ inline void drift(const Integrator& how, Moving& p, float dt) {
    p.position.x += dt * p.velocity.x;
    p.position.y += dt * p.velocity.y;
    p.position.z += dt * p.velocity.z;
    apply_boundary(how.space, 0, p.position.x, p.velocity.x, p);
    apply_boundary(how.space, 1, p.position.y, p.velocity.y, p);
    apply_boundary(how.space, 2, p.position.z, p.velocity.z, p);
}

// First half kick and drift of `step`.
__device__ inline void start_step(const Integrator& how, Moving& p, const float4& force, u32 id, u64 step) {
    kick(how, p, force);
    limit(how, p);
    if (!how.langevin) {
        drift(how, p, how.dt);
        return;
    }
    drift(how, p, 0.5f * how.dt);
    double noise[3];
    normals(how.seed, step, id, noise);
    const float strength = how.noise[__float_as_uint(p.velocity.w)];
    p.velocity.x = how.damping * p.velocity.x + strength * (float)noise[0];
    p.velocity.y = how.damping * p.velocity.y + strength * (float)noise[1];
    p.velocity.z = how.damping * p.velocity.z + strength * (float)noise[2];
    limit(how, p);
    drift(how, p, 0.5f * how.dt);
}

// Second half kick, limited too, so that observers see a velocity that the particle will move by.
__device__ inline void finish_step(const Integrator& how, Moving& p, const float4& force) {
    kick(how, p, force);
    limit(how, p);
}

// The rest of `step` of particle `i`, `p`, and the beginning of the next. A particle that has failed is noted and left
// where it was, so that coordinates stay finite until the run is stopped.
__device__ inline bool advance(const Integrator& how, Status* status, const u32* ids, u32 i, u64 step, Moving& p,
                               const float4& force) {
    if (!all_finite(force)) {
        atomicMin(&status->force, failure(step, ids[i]));
        return false;
    }
    const Moving before = p;
    // Random numbers take input indices; nothing else does.
    const u32 id = how.langevin ? ids[i] : 0;
    finish_step(how, p, force);
    start_step(how, p, force, id, step + 1);
    if (!all_finite(p.position)) {
        atomicMin(&status->position, failure(step + 1, ids[i]));
        p = before;
        return false;
    }
    return true;
}
