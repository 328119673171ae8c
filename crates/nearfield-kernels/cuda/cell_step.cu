// Steps of particles most of which have no neighbours, by cells that hold about one: a thread looks around a particle
// and moves it. Others are looked at where they were sorted to, so particles move in place.

#include "around.cuh"
#include "integrate.cuh"
#include "law.cuh"
#include "sums.cuh"

// The force on the particle in a slot, of kind `kind`.
template <class L> struct ForceIn {
    const GatherArgs& g;
    const u32 slot;
    const float4& x;
    const u32 kind;
    Sums<false, false> sums;

    __device__ void meet(u32 j, u32 image, const Shift& s) {
        if (j == slot && image == HOME_IMAGE) return;
        const Shift d = displacement(x, g.grid.slot[j], s);
        const float r2 = squared_length(d.x, d.y, d.z), cutoff = g.law.cutoff;
        if (!(r2 < cutoff * cutoff)) return;
        const u32 kind_j = L::TYPED && g.law.n_types > 1 ? __float_as_uint(g.velocity[g.grid.particle[j]].w) : 0;
        const PairForce pair = L::template evaluate<false>(g.law, r2, cutoff, kind, kind_j);
        sums.add(g.law, d.x, d.y, d.z, pair.f_over_r, pair.energy, r2);
    }
};

template <class L, bool NOISE> __device__ inline void cell_step(const CellStepArgs& a) {
    const GatherArgs& g = a.gather;
    const u32 slot = thread_index();
    if (slot >= g.n) return;
    const u32 i = g.grid.particle[slot];
    Moving p = {g.grid.slot[slot], a.particles.velocity[i], {0, 0, 0}, false};
    ForceIn<L> force = {g, slot, p.position, __float_as_uint(p.velocity.w), zero_sums<Sums<false, false>>()};
    search_around(g.grid, g.space, p.position, g.law.cutoff + g.slack, force);
    const Sums<false, false>& sums = force.sums;
    const u64 step = *a.first + a.index;
    advance<NOISE>(a.integrator, a.status, a.particles, i, step, p, make_float4(sums.x, sums.y, sums.z, 0.0f));
    store_moving(a.particles, i, p);
}

KERNEL(begin_cell_steps, FirstStepArgs, 32) {
    if (thread_index() == 0) *a.first = a.step;
}

KERNEL_MIN_BLOCKS(cell_step_uniform, CellStepArgs, 128, 12) {
    cell_step<UniformLennardJones, false>(a);
}

KERNEL(cell_step_any, CellStepArgs, 128) {
    cell_step<AnyLaw, true>(a);
}
