// rt-boxes: each ray sums the forces on its particle. Complete where all radii are equal.

#include "ray_sums.cuh"

PARAMETERS(ForceRays)

template <bool EXACT, bool ENERGY> __device__ inline void gather_rays() {
    const u32 i = params.rays.first + rt::ray_index();
    const Sums<EXACT, ENERGY> sums = sum_rays<EXACT, ENERGY>(params.rays, i);
    store_sums<ENERGY>(params.results, params.rays.law, params.rays.particles.n, i, sums);
}

template <class L, bool EXACT, bool ENERGY> __device__ inline void gather_pair() {
    const Meeting m = meet(params.rays);
    if (!m.near) return;
    add_to_ray<EXACT, ENERGY>(params.rays.law, m, force_between<L, ENERGY>(params.rays, m));
}

#define GATHER(name, L, EXACT, ENERGY)                                                                                 \
    RAYGEN(name) {                                                                                                     \
        gather_rays<EXACT, ENERGY>();                                                                                  \
    }                                                                                                                  \
    INTERSECTION(name) {                                                                                               \
        gather_pair<L, EXACT, ENERGY>();                                                                               \
    }

GATHER(gather, AnyLaw, false, false)
GATHER(gather_energy, AnyLaw, false, true)
GATHER(gather_exact, AnyLaw, true, false)
GATHER(gather_exact_energy, AnyLaw, true, true)
GATHER(gather_uniform_lj, UniformLennardJones, false, false)
