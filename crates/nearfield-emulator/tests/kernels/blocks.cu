// Barriers, atomics and memory, for tests of the emulator.

#include "base.cuh"

struct BlocksArgs {
    u32* input;
    u32* output;
    u32* ticket;
    u32 n;
    u32 unused;
};

// Sum of each block's inputs.
KERNEL(block_sums, BlocksArgs, 256) {
    __shared__ u32 sums[256];
    const u32 t = threadIdx.x;
    sums[t] = thread_index() < a.n ? a.input[thread_index()] : 0;
    __syncthreads();
    for (u32 step = blockDim.x / 2; step > 0; step /= 2) {
        if (t < step) sums[t] += sums[t + step];
        __syncthreads();
    }
    if (t == 0) a.output[blockIdx.x] = sums[0];
}

// Sum, minimum, maximum, all bits, common bits, and how often an exchange with zero found one, `[6]`.
KERNEL(atomics, BlocksArgs, 256) {
    if (thread_index() >= a.n) return;
    const u32 value = a.input[thread_index()];
    atomicAdd(&a.output[0], value);
    atomicMin(&a.output[1], value);
    atomicMax(&a.output[2], value);
    atomicOr(&a.output[3], value);
    atomicAnd(&a.output[4], value);
    if (atomicCAS(a.ticket, 1u, 0u) == 1u) atomicAdd(&a.output[5], 1u);
}

struct FloatsArgs {
    float* single;
    double* twice;
    u64* whole;
    u32 n;
    u32 unused;
};

KERNEL(atomic_floats, FloatsArgs, 256) {
    if (thread_index() >= a.n) return;
    atomicAdd(a.single, 0.5f);
    atomicAdd(a.twice, 0.25);
    atomicAdd(a.whole, (u64)-1);
}

// Inclusive prefix sums over blocks in the order of their tickets: each waits for the sum of the one before, which is
// stored plus one.
KERNEL(look_back, BlocksArgs, 32) {
    u32 tile = 0;
    if (threadIdx.x == 0) tile = atomicAdd(a.ticket, 1u);
    tile = __shfl_sync(ALL_LANES, tile, 0);
    const u32 i = tile * WARP + threadIdx.x;
    u32 sum = i < a.n ? a.input[i] : 0;
    for (u32 step = 1; step < WARP; step *= 2) {
        const u32 other = __shfl_up_sync(ALL_LANES, sum, step);
        if (threadIdx.x >= step) sum += other;
    }
    u32 before = 0;
    if (threadIdx.x == 0 && tile > 0) {
        do before = ((volatile u32*)a.output)[tile - 1];
        while (before == 0);
        before -= 1;
    }
    before = __shfl_sync(ALL_LANES, before, 0);
    if (threadIdx.x == WARP - 1) {
        __threadfence();
        atomicExch(&a.output[tile], before + sum + 1);
    }
}

// Writes its thread numbers, one more than there is room for.
KERNEL(overrun, BlocksArgs, 32) {
    if (threadIdx.x <= a.n) a.output[threadIdx.x] = threadIdx.x;
}

// Threads end before the barrier of the others, which does not wait for them: how many came.
KERNEL(leavers, BlocksArgs, 128) {
    if (threadIdx.x >= a.n) return;
    a.output[threadIdx.x] = __syncthreads_count(1);
}

// Needs more stack than there is.
KERNEL(deep, BlocksArgs, 32) {
    volatile u32 large[1 << 14];
    for (u32 i = 0; i < 1 << 14; ++i) large[i] = i;
    a.output[threadIdx.x] = large[a.n];
}

// The turn of each thread in its block.
KERNEL(turns, BlocksArgs, 64) {
    a.output[thread_index()] = atomicAdd(&a.ticket[blockIdx.x], 1u);
}

// Reads an input at a place where there is none.
KERNEL(wild, BlocksArgs, 32) {
    a.output[threadIdx.x] = a.input[threadIdx.x];
}
