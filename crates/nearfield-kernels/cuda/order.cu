// Memory order: keys along a curve, and particles moved to where a sort puts them.

#include "integrate.cuh"
#include "particles.cuh"
#include "sums.cuh"

namespace {

// The lower ten bits of x, two zero bits after each.
__device__ u32 spread(u32 x) {
    x &= 0x3ff;
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

__device__ u32 coordinate(float x, float lo, float per_length, u32 n) {
    // NaN becomes zero.
    return (u32)clamped((int)((x - lo) * per_length), 0, (int)n - 1);
}

} // namespace

// Counts particles by cell of a cube of cells, numbered along the Morton curve.
KERNEL(morton_count, MortonArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const float4 x = a.position[i];
    const u32 n = 1u << a.bits;
    const u32 cell = spread(coordinate(x.x, a.lo[0], a.per_length[0], n)) |
                     spread(coordinate(x.y, a.lo[1], a.per_length[1], n)) << 1 |
                     spread(coordinate(x.z, a.lo[2], a.per_length[2], n)) << 2;
    a.cell[i] = cell;
    a.rank[i] = atomicAdd(&a.count[cell], 1u);
}

KERNEL(morton_scatter, MortonArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    a.order[a.start[a.cell[i]] + a.rank[i]] = i;
}

// Bounds of all positions; floats as integers of the same order.
KERNEL(bounds, BoundsArgs, 256) {
    const float4 first = a.position[0];
    float lo[3] = {first.x, first.y, first.z}, hi[3] = {first.x, first.y, first.z};
    for (u64 i = thread_index(); i < a.n; i += (u64)gridDim.x * blockDim.x) {
        const float4 x = a.position[i];
        const float at[3] = {x.x, x.y, x.z};
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = fminf(lo[axis], at[axis]);
            hi[axis] = fmaxf(hi[axis], at[axis]);
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (int step = WARP / 2; step > 0; step /= 2) {
            lo[axis] = fminf(lo[axis], __shfl_xor_sync(ALL_LANES, lo[axis], step));
            hi[axis] = fmaxf(hi[axis], __shfl_xor_sync(ALL_LANES, hi[axis], step));
        }
        if (threadIdx.x % WARP == 0) {
            atomicMin(&a.bounds[axis], ordered_bits(lo[axis]));
            atomicMax(&a.bounds[3 + axis], ordered_bits(hi[axis]));
        }
    }
}

KERNEL(sample, SampleArgs, 256) {
    const u64 k = thread_index();
    if (k < a.n_sampled) a.sample[k] = a.position[k * a.n / a.n_sampled];
}

// Puts particle `order[k]` at place k.
KERNEL(permute, PermuteArgs, 256) {
    const u32 k = thread_index();
    if (k >= a.from.n) return;
    const u32 i = a.order[k];
    copy_particle(a.from, i, a.to, k, a.place);
    if (a.force[0]) a.force[1][k] = a.force[0][i];
}

// Order-independent sums as numbers.
KERNEL(finish_exact, FinishExactArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const i64* sum = a.results.exact + i;
    const u64 n = a.n;
    a.results.force[i] = make_float4((float)from_quanta(sum[0], a.force_quanta, a.capped),
                                     (float)from_quanta(sum[n], a.force_quanta, a.capped),
                                     (float)from_quanta(sum[2 * n], a.force_quanta, a.capped), 0.0f);
    if (a.energy) {
        a.results.energy[i] = from_quanta(sum[3 * n], a.energy_quanta, a.capped);
        a.results.virial[i] = from_quanta(sum[4 * n], a.energy_quanta, a.capped);
    }
}
