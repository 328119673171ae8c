// Sums over particles: energies, momentum, largest force; motion since a remembered time; velocity rescaling.

#include "integrate.cuh"
#include "sums.cuh"

namespace {

const u32 THREADS = 256;

__device__ TotalSums add(const TotalSums& a, const TotalSums& b) {
    return {a.kinetic + b.kinetic,
            {a.momentum[0] + b.momentum[0], a.momentum[1] + b.momentum[1], a.momentum[2] + b.momentum[2]},
            larger(a.max_force2, b.max_force2),
            a.potential + b.potential,
            a.virial + b.virial,
            a.neighbors + b.neighbors};
}

__device__ TotalSums shuffled(const TotalSums& s, int step) {
    TotalSums out;
    out.kinetic = __shfl_down_sync(ALL_LANES, s.kinetic, step);
    for (int axis = 0; axis < 3; ++axis) out.momentum[axis] = __shfl_down_sync(ALL_LANES, s.momentum[axis], step);
    out.max_force2 = __shfl_down_sync(ALL_LANES, s.max_force2, step);
    out.potential = __shfl_down_sync(ALL_LANES, s.potential, step);
    out.virial = __shfl_down_sync(ALL_LANES, s.virial, step);
    out.neighbors = __shfl_down_sync(ALL_LANES, s.neighbors, step);
    return out;
}

// The sum over a block, in a fixed order, in thread 0.
__device__ TotalSums block_sum(TotalSums s) {
    __shared__ TotalSums of_warp[THREADS / WARP];
    for (int step = WARP / 2; step > 0; step /= 2) s = add(s, shuffled(s, step));
    if (threadIdx.x % WARP == 0) of_warp[threadIdx.x / WARP] = s;
    __syncthreads();
    if (threadIdx.x == 0) {
        for (u32 warp = 1; warp < THREADS / WARP; ++warp) s = add(s, of_warp[warp]);
    }
    return s;
}

__device__ TotalSums zero() {
    return {0.0, {0.0, 0.0, 0.0}, 0.0, 0.0, 0.0, 0};
}

} // namespace

// The sums of each block. Particles are taken in input order, so that sums do not depend on memory order.
KERNEL(totals, TotalsArgs, 256) {
    TotalSums sum = zero();
    for (u64 id = thread_index(); id < a.particles.n; id += (u64)gridDim.x * THREADS) {
        const u32 i = a.place[id];
        const float4 velocity = a.particles.velocity[i];
        const double mass = a.mass[__float_as_uint(velocity.w)];
        const double v[3] = {velocity.x, velocity.y, velocity.z};
        TotalSums one = zero();
        one.kinetic = 0.5 * mass * ((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
        for (int axis = 0; axis < 3; ++axis) one.momentum[axis] = mass * v[axis];
        if (a.results.force) {
            const float4 force = a.results.force[i];
            if (!all_finite(force)) atomicMin(&a.status->force, failure(a.step, (u32)id));
            const double f[3] = {force.x, force.y, force.z};
            one.max_force2 = (f[0] * f[0] + f[1] * f[1]) + f[2] * f[2];
        }
        if (a.results.energy) {
            one.potential = a.results.energy[i];
            one.virial = a.results.virial[i];
            one.neighbors = a.results.neighbors[i];
        }
        sum = add(sum, one);
    }
    sum = block_sum(sum);
    if (threadIdx.x == 0) a.sums[blockIdx.x] = sum;
}

// The sum of `a.particles.n` blocks' sums, put behind them.
KERNEL(totals_of_blocks, TotalsArgs, 256) {
    TotalSums sum = zero();
    for (u32 block = threadIdx.x; block < a.particles.n; block += THREADS) sum = add(sum, a.sums[block]);
    sum = block_sum(sum);
    if (threadIdx.x == 0) a.sums[a.particles.n] = sum;
}

// Velocity rescaling (Bussi, Donadio and Parrinello, J. Chem. Phys. 126, 014101 (2007), eq. A7).
KERNEL(rescale, RescaleArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.particles.n || !(a.sums->kinetic > 0.0)) return;
    const double normal = a.normal[a.index], target = 0.5 * a.temperature / a.sums->kinetic;
    const double c = a.decay;
    const double square = c + (1.0 - c) * target * (normal * normal + a.chi_squared[a.index]) +
                          2.0 * normal * sqrt(c * (1.0 - c) * target);
    const float factor = (float)sqrt(larger(square, 0.0));
    float4 v = a.particles.velocity[i];
    v.x *= factor;
    v.y *= factor;
    v.z *= factor;
    a.particles.velocity[i] = v;
}

// Largest squared distance moved since the remembered positions, and the sum of distances over radii.
KERNEL(motion, MotionArgs, 256) {
    const u32 i = thread_index();
    double largest = 0.0;
    u64 sum = 0;
    if (i < a.particles.n) {
        const float4 now = a.particles.position[i], then = a.position[i];
        const float to[3] = {now.x, now.y, now.z}, from[3] = {then.x, then.y, then.z};
        for (int axis = 0; axis < 3; ++axis) {
            const int crossings = a.particles.image[3 * (u64)i + axis] - a.image[3 * (u64)i + axis];
            const double d = ((double)to[axis] - (double)from[axis]) + (double)crossings * (double)a.length[axis];
            largest += d * d;
        }
        const double radius = a.cutoff > 0.0f ? a.cutoff : now.w;
        sum = (u64)(smaller(sqrt(largest) / radius, 1e4) * 1048576.0);
    }
    for (int step = WARP / 2; step > 0; step /= 2) largest = larger(largest, __shfl_xor_sync(ALL_LANES, largest, step));
    sum = (u64)lane_sum((i64)sum);
    if (threadIdx.x % WARP == 0) {
        // Rounded up, so that the distance is never understated; bits of positive floats are ordered as the floats.
        atomicMax(&a.moved[0], (u64)__float_as_uint((float)(largest * 1.0000002)));
        atomicAdd(&a.moved[1], sum);
    }
}
