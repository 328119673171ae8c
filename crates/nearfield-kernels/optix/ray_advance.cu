// rt-perse (ORCS-persé, paper A, section 3.2.1): the ray that sums the force on a particle also moves it, by the second
// half kick of a step and the first of the next. Positions go to a second array, because rays of other particles still
// need the present ones; velocities and image counts are nobody else's, types excepted, which do not change.

#include "integrate.cuh"
#include "point_rays.cuh"
#include "ray_sums.cuh"

PARAMETERS(AdvanceRays)

// Not inlined: half a module's code, the same in all programs.
__device__ __noinline__ void move_particle(u32 i, float4 force) {
    Particles to = params.rays.particles;
    Moving p = load_moving(to, i);
    advance<true>(params.integrator, params.status, to, i, params.step, p, force);
    to.position = params.position;
    store_moving(to, i, p);
}

template <bool EXACT> __device__ inline void advance_rays() {
    const u32 i = params.rays.first + rt::ray_index();
    const Sums<EXACT, false> sums = sum_rays<PointRays, EXACT, false>(params.rays, i);
    store_sums<false>(params.results, params.rays.law, params.rays.particles.n, i, sums);
    move_particle(i, params.results.force[i]);
}

template <class L, bool EXACT> __device__ inline void advance_pair() {
    const Meeting m = PointRays::meet(params.rays);
    if (!m.near) return;
    add_to_ray<EXACT, false>(params.rays.law, m, force_between<L, false>(params.rays, m));
}

#define ADVANCE(name, L, EXACT)                                                                                        \
    RAYGEN(name) {                                                                                                     \
        advance_rays<EXACT>();                                                                                         \
    }                                                                                                                  \
    INTERSECTION(name) {                                                                                               \
        advance_pair<L, EXACT>();                                                                                      \
    }

ADVANCE(advance, AnyLaw, false)
ADVANCE(advance_exact, AnyLaw, true)
ADVANCE(advance_uniform_lj, UniformLennardJones, false)
