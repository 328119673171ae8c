// Force and energy of a pair within range: the potentials of nearfield_core with their truncation.

#pragma once

#include "predicate.cuh"

struct PairForce {
    float f_over_r; // -(1/r) dU/dr, truncated and capped
    float energy;
};

enum Potential { LENNARD_JONES, WCA, YUKAWA, MORSE, GAUSSIAN, TABLE };
enum Truncation { CUT, ENERGY_SHIFTED, FORCE_SHIFTED };

namespace potential {

struct Value {
    float f_over_r, energy;
};

template <bool ENERGY> __device__ inline Value lennard_jones(float r2, float epsilon, float sigma) {
    const float inverse = reciprocal(r2);
    const float s2 = sigma * sigma * inverse;
    const float s6 = s2 * s2 * s2;
    return {48.0f * epsilon * inverse * (s6 * (s6 - 0.5f)), ENERGY ? 4.0f * epsilon * (s6 * (s6 - 1.0f)) : 0.0f};
}

template <bool ENERGY> __device__ inline Value wca(float r2, float epsilon, float sigma) {
    if (!(r2 < 1.2599210498948732f * sigma * sigma)) return {0.0f, 0.0f};
    Value v = lennard_jones<ENERGY>(r2, epsilon, sigma);
    v.energy += epsilon;
    return v;
}

__device__ inline Value yukawa(float r2, float epsilon, float sigma, float kappa) {
    const float r = sqrtf(r2);
    const float e = epsilon * sigma * expf(-(kappa * r));
    return {e * (1.0f / r + kappa) / r2, e / r};
}

__device__ inline Value morse(float r2, float epsilon, float sigma, float alpha) {
    const float r = sqrtf(r2);
    const float e = expf(-(alpha * (r - sigma)));
    // At zero distance the force has no direction.
    return {r2 > 0.0f ? 2.0f * epsilon * alpha * e * (e - 1.0f) / r : 0.0f, epsilon * e * (e - 2.0f)};
}

__device__ inline Value gaussian(float r2, float epsilon, float sigma) {
    const float s2 = sigma * sigma;
    const float u = epsilon * expf(-(r2 / (2.0f * s2)));
    return {u / s2, u};
}

__device__ inline float polynomial(const float4& c, float t) {
    return fmaf(fmaf(fmaf(c.w, t, c.z), t, c.y), t, c.x);
}

__device__ inline Value table(const Law& law, float r2, float epsilon, float sigma) {
    const float r = sqrtf(r2), x = r / sigma;
    if (x > law.table_end) return {0.0f, 0.0f};
    float u, f;
    if (x < law.table_start) {
        f = law.table_force[0].x;
        u = fmaf(f, law.table_start - x, law.table_energy[0].x);
    } else {
        const float t = (x - law.table_start) * law.table_per_sigma;
        const u32 k = smaller((u32)t, law.table_intervals - 1);
        u = polynomial(law.table_energy[k], t - (float)k);
        f = polynomial(law.table_force[k], t - (float)k);
    }
    return {r2 > 0.0f ? epsilon / sigma * f / r : 0.0f, epsilon * u};
}

// Untruncated, of any kind.
template <bool ENERGY> __device__ inline Value evaluate(const Law& law, float r2, float epsilon, float sigma) {
    switch (law.potential) {
    case LENNARD_JONES: return lennard_jones<ENERGY>(r2, epsilon, sigma);
    case WCA: return wca<ENERGY>(r2, epsilon, sigma);
    case YUKAWA: return yukawa(r2, epsilon, sigma, law.parameter);
    case MORSE: return morse(r2, epsilon, sigma, law.parameter);
    case GAUSSIAN: return gaussian(r2, epsilon, sigma);
    default: return table(law, r2, epsilon, sigma);
    }
}

} // namespace potential

// Epsilon, sigma and shifts of a pair (nearfield_core::PairCoefficients).
struct Coefficients {
    float epsilon, sigma, energy_shift, force_shift;
};

__device__ inline Coefficients coefficients(const Law& law, u32 kind_i, u32 kind_j, float range) {
    const float4 c = law.pairs[kind_i * law.n_types + kind_j];
    if (!law.variable) return {c.x, c.y, c.z, c.w};
    Coefficients out = {c.x, range * law.sigma_per_range, 0.0f, 0.0f};
    if (law.truncation != CUT) {
        const potential::Value end = potential::evaluate<true>(law, range * range, out.epsilon, out.sigma);
        out.energy_shift = end.energy;
        if (law.truncation == FORCE_SHIFTED) out.force_shift = end.f_over_r * range;
    }
    return out;
}

// Any potential and truncation. The arithmetic is the same in every kernel, so that order-independent sums agree to the
// bit between methods; whether energies are asked for does not change the force.
struct AnyLaw {
    static const bool TYPED = true;

    template <bool ENERGY>
    __device__ static PairForce evaluate(const Law& law, float r2, float range, u32 kind_i, u32 kind_j) {
        const Coefficients c = coefficients(law, kind_i, kind_j, range);
        potential::Value v = potential::evaluate<ENERGY>(law, r2, c.epsilon, c.sigma);
        v.energy -= c.energy_shift;
        if (law.truncation == FORCE_SHIFTED) {
            // Coincident particles of a finite potential: any finite factor will do, it is multiplied by zero.
            const float r = sqrtf(fmaxf(r2, 1.17549435e-38f));
            v.f_over_r -= c.force_shift / r;
            if (ENERGY) v.energy += (r - range) * c.force_shift;
        }
        return {fminf(v.f_over_r, law.cap), ENERGY ? fminf(v.energy, law.cap) : 0.0f};
    }
};

// One type and one cutoff of Lennard-Jones: the constants are products of epsilon and sigma. Forces only.
struct UniformLennardJones {
    static const bool TYPED = false;

    template <bool ENERGY> __device__ static PairForce evaluate(const Law& law, float r2, float, u32, u32) {
        const float inverse = reciprocal(r2);
        const float inverse6 = inverse * inverse * inverse;
        return {fminf(fmaf(law.lj_repulsion, inverse6, -law.lj_attraction) * (inverse6 * inverse), law.cap), 0.0f};
    }
};

// One type of Lennard-Jones whose sigma is proportional to the pair's range. Forces only.
struct ScaledLennardJones {
    static const bool TYPED = false;

    template <bool ENERGY> __device__ static PairForce evaluate(const Law& law, float r2, float range, u32, u32) {
        const float sigma = range * law.sigma_per_range;
        const float inverse = reciprocal(r2);
        const float s2 = sigma * sigma * inverse;
        const float s6 = s2 * s2 * s2;
        return {fminf(48.0f * law.lj_repulsion * inverse * (s6 * (s6 - 0.5f)), law.cap), 0.0f};
    }
};
