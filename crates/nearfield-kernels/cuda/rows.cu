// Forces from stored rows of neighbours. Each row has some lanes of a warp.

#include "law.cuh"
#include "sums.cuh"

#define LANES_PER_ROW 8

namespace {

// What takes a distance along an axis to that of the nearest image. Where ranges are at most half a box length, no
// other image can be within range: |d + s| is then at least that half, by rounding too, and the predicate is strict.
struct NearestImage {
    float half[3], length[3];

    __device__ explicit NearestImage(const Box3& space) {
        for (int axis = 0; axis < 3; ++axis) {
            length[axis] = space.length[axis];
            half[axis] = space.boundary[axis] == 0 ? 0.5f * length[axis] : infinity();
        }
    }

    __device__ float shift(int axis, float d) const {
        return d > half[axis] ? -length[axis] : d < -half[axis] ? length[axis] : 0.0f;
    }
};

template <class T> __device__ T row_sum(T v) {
    for (int step = LANES_PER_ROW / 2; step > 0; step /= 2) v += __shfl_xor_sync(ALL_LANES, v, step);
    return v;
}

template <bool EXACT, bool ENERGY> __device__ void sum_row_lanes(Sums<EXACT, ENERGY>& s) {
    s.x = row_sum(s.x);
    s.y = row_sum(s.y);
    s.z = row_sum(s.z);
    if (ENERGY) {
        s.energy = row_sum(s.energy);
        s.virial = row_sum(s.virial);
        s.neighbors = row_sum(s.neighbors);
    }
}

template <class L, bool EXACT, bool ENERGY> __device__ void gather_row(const RowsArgs& a) {
    const u32 row = thread_index() / LANES_PER_ROW, lane = threadIdx.x % LANES_PER_ROW, i = a.first + row;
    const bool typed = L::TYPED && a.law.n_types > 1;
    const NearestImage image(a.space);
    Sums<EXACT, ENERGY> sums = zero_sums<Sums<EXACT, ENERGY>>();
    if (row < a.n_rows) {
        const float4 xi = a.particles.position[i];
        const u32 kind_i = typed ? __float_as_uint(a.particles.velocity[i].w) : 0;
        const u64 end = a.offset[i + 1] - a.base;
        for (u64 k = a.offset[i] - a.base + lane; k < end; k += LANES_PER_ROW) {
            const u32 j = a.index[k];
            const float4 xj = a.particles.position[j];
            const Shift s = {image.shift(0, xj.x - xi.x), image.shift(1, xj.y - xi.y), image.shift(2, xj.z - xi.z)};
            const Shift d = displacement(xi, xj, s);
            const float r2 = squared_length(d.x, d.y, d.z);
            const float range = a.law.variable ? fmaxf(xi.w, xj.w) : a.law.cutoff;
            if (!(r2 < range * range)) continue;
            const u32 kind_j = typed ? __float_as_uint(a.particles.velocity[j].w) : 0;
            const PairForce pair = L::template evaluate<ENERGY>(a.law, r2, range, kind_i, kind_j);
            sums.add(a.law, d.x, d.y, d.z, pair.f_over_r, pair.energy, r2);
        }
    }
    sum_row_lanes(sums);
    if (row < a.n_rows && lane == 0) store_sums<ENERGY>(a.results, a.law, a.particles.n, i, sums);
}

} // namespace

KERNEL(rows, RowsArgs, 128) {
    gather_row<AnyLaw, false, false>(a);
}

KERNEL(rows_energy, RowsArgs, 128) {
    gather_row<AnyLaw, false, true>(a);
}

KERNEL(rows_exact, RowsArgs, 128) {
    gather_row<AnyLaw, true, false>(a);
}

KERNEL(rows_exact_energy, RowsArgs, 128) {
    gather_row<AnyLaw, true, true>(a);
}

KERNEL(rows_uniform_lj, RowsArgs, 128) {
    gather_row<UniformLennardJones, false, false>(a);
}

KERNEL(rows_scaled_lj, RowsArgs, 128) {
    gather_row<ScaledLennardJones, false, false>(a);
}
