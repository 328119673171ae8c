// Steps of particles most of which have no neighbours, by cells that hold about one: a thread looks around a particle
// and moves it. Others are looked at where they were sorted to, so particles move in place.

#include "integrate.cuh"
#include "law.cuh"
#include "pencils.cuh"
#include "sums.cuh"

// Force on the particle in a slot, of kind `kind`.
template <class L>
__device__ inline Sums<false, false> force_in(const GatherArgs& g, u32 slot, const float4& x, u32 kind) {
    const CellClass& cells = g.grid.classes[0];
    const bool typed = L::TYPED && g.law.n_types > 1;
    const float cutoff = g.law.cutoff, reach = cutoff + g.slack;
    Sums<false, false> sums = zero_sums<Sums<false, false>>();
    for (u32 images = reachable_images(g.space, point_bounds(x), reach); images != 0; images &= images - 1) {
        const u32 image = __ffs(images) - 1;
        Shift s = {0.0f, 0.0f, 0.0f};
        if (image != HOME_IMAGE) s = shift_of(g.space, image);
        const u32 x0 = cell_coordinate(cells, 0, x.x - reach - s.x), x1 = cell_coordinate(cells, 0, x.x + reach - s.x);
        const u32 y0 = cell_coordinate(cells, 1, x.y - reach - s.y), y1 = cell_coordinate(cells, 1, x.y + reach - s.y);
        const u32 z0 = cell_coordinate(cells, 2, x.z - reach - s.z), z1 = cell_coordinate(cells, 2, x.z + reach - s.z);
#pragma unroll 1
        for (u32 y = y0, z = z0; z <= z1; y < y1 ? ++y : (y = y0, ++z)) {
            const u32 first = first_of_cells(cells, row_number(cells, y, z), x0, x1);
            const u32 end = g.grid.cell_start[first + (x1 - x0) + 1];
#pragma unroll 1
            for (u32 j = g.grid.cell_start[first]; j < end; ++j) {
                if (j == slot && image == HOME_IMAGE) continue;
                const Shift d = displacement(x, g.grid.slot[j], s);
                const float r2 = squared_length(d.x, d.y, d.z);
                if (!(r2 < cutoff * cutoff)) continue;
                const u32 kind_j = typed ? __float_as_uint(g.velocity[g.grid.particle[j]].w) : 0;
                const PairForce pair = L::template evaluate<false>(g.law, r2, cutoff, kind, kind_j);
                sums.add(g.law, d.x, d.y, d.z, pair.f_over_r, pair.energy, r2);
            }
        }
    }
    return sums;
}

template <class L, bool NOISE> __device__ inline void cell_step(const CellStepArgs& a) {
    const GatherArgs& g = a.gather;
    const u32 slot = thread_index();
    if (slot >= g.n) return;
    const u32 i = g.grid.particle[slot];
    Moving p = {g.grid.slot[slot], a.particles.velocity[i], {0, 0, 0}, false};
    const Sums<false, false> sums = force_in<L>(g, slot, p.position, __float_as_uint(p.velocity.w));
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
