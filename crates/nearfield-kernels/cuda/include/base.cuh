// What every kernel needs. NVRTC has the CUDA built-ins without headers; a C++ compiler for the host gets them from
// the emulator, which is included before this file.

#pragma once

typedef unsigned char u8;
typedef int i32;
typedef unsigned int u32;
typedef long long i64;
typedef unsigned long long u64;

#define WARP 32
#define ALL_LANES 0xffffffffu

// A kernel with one argument, a structure of layouts.cuh. The emulator defines its own. `__grid_constant__` lets the
// argument be referred to, even with indices, without copies of it.
#ifndef KERNEL
#define KERNEL(name, Args, threads)                                                                                    \
    extern "C" __global__ void __launch_bounds__(threads) name(const __grid_constant__ Args a)
#define KERNEL_MIN_BLOCKS(name, Args, threads, blocks)                                                                 \
    extern "C" __global__ void __launch_bounds__(threads, blocks) name(const __grid_constant__ Args a)
#endif

// What few particles need stays out of line, so that the others have its registers. Such functions take and give values:
// arguments by reference would have to be kept in memory.
#define RARE __device__ __noinline__

__device__ inline u32 thread_index() {
    return blockIdx.x * blockDim.x + threadIdx.x;
}

__device__ inline float infinity() {
    return __int_as_float(0x7f800000);
}

// 1/x to one ulp, denormal x as zero.
__device__ inline float reciprocal(float x) {
#ifdef __CUDA_ARCH__
    float y;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
#else
    return 1.0f / x;
#endif
}

// Integers in the order of the floats.
__device__ inline u32 ordered_bits(float x) {
    const u32 bits = __float_as_uint(x);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

template <class T> __device__ inline T smaller(T a, T b) {
    return b < a ? b : a;
}

template <class T> __device__ inline T larger(T a, T b) {
    return a < b ? b : a;
}

template <class T> __device__ inline T clamped(T x, T lo, T hi) {
    return x < lo ? lo : hi < x ? hi : x;
}
