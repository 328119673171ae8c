// rt-forces (ORCS-forces, paper A, section 3.2.2): each pair is computed by the ray of the smaller radius and added to
// both particles, whose sums are zero before.

#include "point_rays.cuh"
#include "ray_sums.cuh"

PARAMETERS(ForceRays)

template <bool EXACT, bool ENERGY> __device__ inline void scatter_rays() {
    const u32 i = params.rays.first + rt::ray_index();
    const Sums<EXACT, ENERGY> sums = sum_rays<PointRays, EXACT, ENERGY>(params.rays, i);
    scatter_sums<ENERGY>(params.results, params.rays.law, params.rays.particles.n, i, sums);
}

template <class L, bool EXACT, bool ENERGY> __device__ inline void scatter_pair() {
    const Meeting m = PointRays::meet(params.rays);
    if (!m.near || !acts(params.rays, m)) return;
    const PairForce pair = force_between<L, ENERGY>(params.rays, m);
    add_to_ray<EXACT, ENERGY>(params.rays.law, m, pair);
    Sums<EXACT, ENERGY> of_j = zero_sums<Sums<EXACT, ENERGY>>();
    of_j.add(params.rays.law, -m.d.x, -m.d.y, -m.d.z, pair.f_over_r, pair.energy, m.r2);
    scatter_sums<ENERGY>(params.results, params.rays.law, params.rays.particles.n, m.j, of_j);
}

#define SCATTER(name, L, EXACT, ENERGY)                                                                                \
    RAYGEN(name) {                                                                                                     \
        scatter_rays<EXACT, ENERGY>();                                                                                 \
    }                                                                                                                  \
    INTERSECTION(name) {                                                                                               \
        scatter_pair<L, EXACT, ENERGY>();                                                                              \
    }

SCATTER(scatter, AnyLaw, false, false)
SCATTER(scatter_energy, AnyLaw, false, true)
SCATTER(scatter_exact, AnyLaw, true, false)
SCATTER(scatter_exact_energy, AnyLaw, true, true)
SCATTER(scatter_uniform_lj, UniformLennardJones, false, false)
SCATTER(scatter_scaled_lj, ScaledLennardJones, false, false)
