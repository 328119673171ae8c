// The gather consumer: the rays of a particle sum the forces on it. `Rays` are those of a probe, `HIT` declares the
// program of what they meet.

#pragma once

#include "ray_sums.cuh"

template <class Probe, bool EXACT, bool ENERGY>
__device__ inline void gather_rays(const ForceRays& launch) {
    const u32 i = launch.rays.first + rt::ray_index();
    const Sums<EXACT, ENERGY> sums = sum_rays<Probe, EXACT, ENERGY>(launch.rays, i);
    store_sums<ENERGY>(launch.results, launch.rays.law, launch.rays.particles.n, i, sums);
}

template <class Probe, class L, bool EXACT, bool ENERGY> __device__ inline void gather_pair(const Rays& rays) {
    const Meeting m = Probe::meet(rays);
    if (m.near) add_to_ray<EXACT, ENERGY>(rays.law, m, force_between<L, ENERGY>(rays, m));
}

#define GATHER_INTERSECTION(Probe, name, L, EXACT, ENERGY)                                                             \
    RAYGEN(name) {                                                                                                     \
        gather_rays<Probe, EXACT, ENERGY>(params);                                                                     \
    }                                                                                                                  \
    INTERSECTION(name) {                                                                                               \
        gather_pair<Probe, L, EXACT, ENERGY>(params.rays);                                                             \
    }

#define GATHER_ANYHIT(Probe, name, L, EXACT, ENERGY)                                                                   \
    RAYGEN(name) {                                                                                                     \
        gather_rays<Probe, EXACT, ENERGY>(params);                                                                     \
    }                                                                                                                  \
    ANYHIT(name) {                                                                                                     \
        gather_pair<Probe, L, EXACT, ENERGY>(params.rays);                                                             \
        rt::ignore_hit();                                                                                              \
    }

// All programs of a module, by `GATHER_INTERSECTION` or `GATHER_ANYHIT`.
#define GATHER(PROGRAMS, Probe)                                                                                        \
    PROGRAMS(Probe, gather, AnyLaw, false, false)                                                                      \
    PROGRAMS(Probe, gather_energy, AnyLaw, false, true)                                                                \
    PROGRAMS(Probe, gather_exact, AnyLaw, true, false)                                                                 \
    PROGRAMS(Probe, gather_exact_energy, AnyLaw, true, true)                                                           \
    PROGRAMS(Probe, gather_uniform_lj, UniformLennardJones, false, false)
