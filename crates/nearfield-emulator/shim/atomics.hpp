// Atomics: threads take turns only at a rendezvous, so that plain reads and writes are enough. Only the types that CUDA
// has, so that what compiles here compiles there.

#pragma once

#define EMULATOR_ATOMIC(name, T, changed)                                                                              \
    inline T name(T* address, T value) {                                                                               \
        const T old = *address;                                                                                        \
        *address = changed;                                                                                            \
        return old;                                                                                                    \
    }

#define EMULATOR_ATOMICS_ANY(T)                                                                                        \
    EMULATOR_ATOMIC(atomicAdd, T, old + value)                                                                         \
    EMULATOR_ATOMIC(atomicExch, T, value)

#define EMULATOR_ATOMICS_INTEGER(T)                                                                                    \
    EMULATOR_ATOMICS_ANY(T)                                                                                            \
    EMULATOR_ATOMIC(atomicMin, T, value < old ? value : old)                                                           \
    EMULATOR_ATOMIC(atomicMax, T, value > old ? value : old)                                                           \
    EMULATOR_ATOMIC(atomicAnd, T, old& value)                                                                          \
    EMULATOR_ATOMIC(atomicOr, T, old | value)                                                                          \
    EMULATOR_ATOMIC(atomicXor, T, old ^ value)                                                                         \
    inline T atomicCAS(T* address, T expected, T value) {                                                              \
        const T old = *address;                                                                                        \
        if (old == expected) *address = value;                                                                         \
        return old;                                                                                                    \
    }

EMULATOR_ATOMICS_INTEGER(int)
EMULATOR_ATOMICS_INTEGER(unsigned)
EMULATOR_ATOMICS_INTEGER(unsigned long long)
EMULATOR_ATOMICS_ANY(float)
inline double atomicAdd(double* address, double value) {
    const double old = *address;
    *address = old + value;
    return old;
}
EMULATOR_ATOMIC(atomicMin, long long, value < old ? value : old)
EMULATOR_ATOMIC(atomicMax, long long, value > old ? value : old)
EMULATOR_ATOMIC(atomicSub, int, old - value)
EMULATOR_ATOMIC(atomicSub, unsigned, old - value)

#undef EMULATOR_ATOMICS_INTEGER
#undef EMULATOR_ATOMICS_ANY
#undef EMULATOR_ATOMIC
