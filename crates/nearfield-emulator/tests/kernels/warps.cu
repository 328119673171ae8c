// Warp operations, for tests of the emulator.

#include "base.cuh"

struct LanesArgs {
    u32* out;
    u32 mask;
    u32 argument;
    u32 width;
    u32 unused;
};

// Shuffles of lane numbers by the lanes of a mask, `[4][32]`.
KERNEL(shuffles, LanesArgs, 32) {
    const u32 lane = threadIdx.x;
    if (!(a.mask >> lane & 1)) return;
    a.out[lane] = __shfl_sync(a.mask, lane, a.argument, a.width);
    a.out[32 + lane] = __shfl_up_sync(a.mask, lane, a.argument, a.width);
    a.out[64 + lane] = __shfl_down_sync(a.mask, lane, a.argument, a.width);
    a.out[96 + lane] = __shfl_xor_sync(a.mask, lane, a.argument, a.width);
}

// Votes on multiples of the argument, and lanes equal modulo the argument, `[4][32]`.
KERNEL(votes, LanesArgs, 32) {
    const u32 lane = threadIdx.x;
    if (!(a.mask >> lane & 1)) return;
    a.out[lane] = __ballot_sync(a.mask, lane % a.argument == 0);
    a.out[32 + lane] = __any_sync(a.mask, lane % a.argument == 0);
    a.out[64 + lane] = __all_sync(a.mask, lane % a.argument == 0);
    a.out[96 + lane] = __match_any_sync(a.mask, lane % a.argument);
}

// Every type that shuffles move, rotated by one lane: 1 where it came back as it should, `[32]`.
KERNEL(types, LanesArgs, 32) {
    const u32 lane = threadIdx.x, from = (lane + 1) % 32;
    bool good = __shfl_sync(ALL_LANES, -(int)lane, from) == -(int)from;
    good &= __shfl_sync(ALL_LANES, 0.5f * (float)lane, from) == 0.5f * (float)from;
    good &= __shfl_sync(ALL_LANES, 0.1 * (double)lane, from) == 0.1 * (double)from;
    good &= __shfl_sync(ALL_LANES, -((i64)lane << 40), from) == -((i64)from << 40);
    good &= __shfl_sync(ALL_LANES, (u64)lane << 60, from) == (u64)from << 60;
    a.out[lane] = good;
}

// Lanes loop as often as their number says, then halves of the warp sum among themselves, then all of it, `[32]`.
KERNEL(divergent, LanesArgs, 64) {
    const u32 lane = threadIdx.x % WARP;
    u32 count = 0;
    for (u32 i = 0; i < lane; ++i) count += 1;
    const u32 half = lane < 16 ? 0x0000ffffu : 0xffff0000u;
    // The lower half has more rendezvous than the upper.
    for (u32 repeat = 0; repeat < (lane < 16 ? 3u : 1u); ++repeat) {
        u32 sum = count;
        for (int step = 8; step > 0; step /= 2) sum += __shfl_xor_sync(half, sum, step);
        if (repeat == 0) count = sum;
    }
    count += __shfl_xor_sync(ALL_LANES, count, 16);
    a.out[thread_index()] = count;
}

// The lane that the argument names ends before the others vote.
KERNEL(early_exit, LanesArgs, 32) {
    if (threadIdx.x == a.argument) return;
    a.out[threadIdx.x] = __ballot_sync(ALL_LANES, 1);
}

// Half of the warp waits for the other half, which waits at the barrier.
KERNEL(deadlock, LanesArgs, 32) {
    if (threadIdx.x < 16) __syncwarp(ALL_LANES);
    else __syncthreads();
    a.out[threadIdx.x] = 1;
}
