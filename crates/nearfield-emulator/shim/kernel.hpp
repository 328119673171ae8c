// Qualifiers of functions and variables, and kernels that list themselves in `this_module`.

#pragma once

#include "registry.hpp"

#define __global__
#define __device__
#define __host__
#define __constant__
#define __forceinline__ inline
#define __noinline__ __attribute__((noinline))
#define __launch_bounds__(...)
#define __align__(n) alignas(n)
// One block at a time on each thread of the operating system.
#define __shared__ static thread_local

#define EMULATOR_KERNEL(name, Args, threads)                                                                           \
    static void name(const Args& a);                                                                                   \
    static void name##_thread(const void* arguments) { name(*static_cast<const Args*>(arguments)); }                   \
    static emulator::Entry name##_entry = {                                                                            \
        emulator::Entry::KERNEL, #name, sizeof(Args), threads, name##_thread, nullptr, nullptr};                       \
    static const emulator::Registration name##_registration(this_module, name##_entry);                                \
    static void name(const Args& a)

// In two steps, so that macros among the arguments are expanded.
#define KERNEL(name, Args, threads) EMULATOR_KERNEL(name, Args, threads)
#define KERNEL_MIN_BLOCKS(name, Args, threads, blocks) EMULATOR_KERNEL(name, Args, threads)
