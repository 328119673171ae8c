// How contributions of pairs are summed: in f32, fast, or in 64-bit fixed point, whose sums do not depend on order.

#pragma once

#include "predicate.cuh"

// A contribution beyond this many quanta is taken as infinite: 2^20 units at 2^34 quanta a unit. Sums of up to 512 such
// contributions still do not overflow.
#define QUANTA_LIMIT 18014398509481984.0f // 2^54
#define QUANTA_INFINITE 9007199254740992ll // 2^53

__device__ inline i64 to_quanta(float value, float quanta) {
    const float scaled = value * quanta;
    // NaN compares false: it becomes the positive limit.
    if (fabsf(scaled) < QUANTA_LIMIT) return __float2ll_rn(scaled);
    return scaled < 0.0f ? -(i64)QUANTA_LIMIT : (i64)QUANTA_LIMIT;
}

// `capped`: overlaps are allowed, so sums of contributions at the limit stay numbers.
__device__ inline double from_quanta(i64 sum, float quanta, bool capped) {
    if (!capped && sum >= QUANTA_INFINITE) return (double)infinity();
    if (!capped && sum <= -QUANTA_INFINITE) return -(double)infinity();
    return (double)sum / (double)quanta;
}

// Sums of one particle in one thread.
template <bool EXACT, bool ENERGY> struct Sums;

template <bool ENERGY> struct Sums<false, ENERGY> {
    float x, y, z;
    double energy, virial;
    u32 neighbors;

    // A neighbour at displacement d with force factor f and pair energy e: the force on i is -f d.
    __device__ void add(const Law&, float dx, float dy, float dz, float f, float e, float r2) {
        x = fmaf(-f, dx, x);
        y = fmaf(-f, dy, y);
        z = fmaf(-f, dz, z);
        if (ENERGY) {
            energy += 0.5 * (double)e;
            virial += 0.5 * (double)(f * r2);
            neighbors += 1;
        }
    }
};

template <bool ENERGY> struct Sums<true, ENERGY> {
    i64 x, y, z, energy, virial;
    u32 neighbors;

    __device__ void add(const Law& law, float dx, float dy, float dz, float f, float e, float r2) {
        x += to_quanta(-f * dx, law.force_quanta);
        y += to_quanta(-f * dy, law.force_quanta);
        z += to_quanta(-f * dz, law.force_quanta);
        if (ENERGY) {
            // Halves, so that both sides of a pair add up to its energy.
            energy += to_quanta(0.5f * e, law.energy_quanta);
            virial += to_quanta(0.5f * (f * r2), law.energy_quanta);
            neighbors += 1;
        }
    }
};

template <class S> __device__ inline S zero_sums() {
    S s;
    s.x = 0;
    s.y = 0;
    s.z = 0;
    s.energy = 0;
    s.virial = 0;
    s.neighbors = 0;
    return s;
}

__device__ inline float lane_sum(float v) {
    for (int step = WARP / 2; step > 0; step /= 2) v += __shfl_xor_sync(ALL_LANES, v, step);
    return v;
}

__device__ inline double lane_sum(double v) {
    for (int step = WARP / 2; step > 0; step /= 2) v += __shfl_xor_sync(ALL_LANES, v, step);
    return v;
}

__device__ inline i64 lane_sum(i64 v) {
    for (int step = WARP / 2; step > 0; step /= 2) v += __shfl_xor_sync(ALL_LANES, v, step);
    return v;
}

__device__ inline u32 lane_sum(u32 v) {
    for (int step = WARP / 2; step > 0; step /= 2) v += __shfl_xor_sync(ALL_LANES, v, step);
    return v;
}

// Sums over the lanes of a warp, the same in all of them.
template <bool EXACT, bool ENERGY> __device__ inline void sum_lanes(Sums<EXACT, ENERGY>& s) {
    s.x = lane_sum(s.x);
    s.y = lane_sum(s.y);
    s.z = lane_sum(s.z);
    if (ENERGY) {
        s.energy = lane_sum(s.energy);
        s.virial = lane_sum(s.virial);
        s.neighbors = lane_sum(s.neighbors);
    }
}

// Stores the sums of particle `i`, which nobody else writes.
template <bool ENERGY>
__device__ inline void store_sums(const Results& out, const Law&, u32, u32 i, const Sums<false, ENERGY>& s) {
    out.force[i] = make_float4(s.x, s.y, s.z, 0.0f);
    if (ENERGY) {
        out.energy[i] = s.energy;
        out.virial[i] = s.virial;
        out.neighbors[i] = s.neighbors;
    }
}

template <bool ENERGY>
__device__ inline void store_sums(const Results& out, const Law& law, u32, u32 i, const Sums<true, ENERGY>& s) {
    const bool capped = law.cap < infinity();
    const float quanta = law.force_quanta;
    out.force[i] = make_float4((float)from_quanta(s.x, quanta, capped), (float)from_quanta(s.y, quanta, capped),
                               (float)from_quanta(s.z, quanta, capped), 0.0f);
    if (ENERGY) {
        out.energy[i] = from_quanta(s.energy, law.energy_quanta, capped);
        out.virial[i] = from_quanta(s.virial, law.energy_quanta, capped);
        out.neighbors[i] = s.neighbors;
    }
}

// Adds to a vector that others add to. Sources that define VECTOR_REDUCTIONS are compiled for compute capability 9.0
// too, where one instruction does it.
__device__ inline void add_vector(float4* to, float x, float y, float z) {
#if defined(VECTOR_REDUCTIONS) && defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("{ .reg .u64 a; cvta.to.global.u64 a, %0; red.global.add.v4.f32 [a], {%1, %2, %3, %4}; }" ::"l"(to),
                 "f"(x), "f"(y), "f"(z), "f"(0.0f)
                 : "memory");
#else
    float* sum = &to->x;
    atomicAdd(sum, x);
    atomicAdd(sum + 1, y);
    atomicAdd(sum + 2, z);
#endif
}

// Adds to the sums of particle `i`, which others add to.
template <bool ENERGY>
__device__ inline void scatter_sums(const Results& out, const Law&, u32, u32 i, const Sums<false, ENERGY>& s) {
    add_vector(&out.force[i], s.x, s.y, s.z);
    if (ENERGY) {
        atomicAdd(&out.energy[i], s.energy);
        atomicAdd(&out.virial[i], s.virial);
        atomicAdd(&out.neighbors[i], s.neighbors);
    }
}

template <bool ENERGY>
__device__ inline void scatter_sums(const Results& out, const Law&, u32 n, u32 i, const Sums<true, ENERGY>& s) {
    u64* exact = (u64*)out.exact + i;
    atomicAdd(exact, (u64)s.x);
    atomicAdd(exact + n, (u64)s.y);
    atomicAdd(exact + 2 * (u64)n, (u64)s.z);
    if (ENERGY) {
        atomicAdd(exact + 3 * (u64)n, (u64)s.energy);
        atomicAdd(exact + 4 * (u64)n, (u64)s.virial);
        atomicAdd(&out.neighbors[i], s.neighbors);
    }
}
