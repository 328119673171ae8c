// Warp intrinsics and barriers.

#pragma once

#define warpSize 32

namespace emulator {

template <class T> T shuffle(unsigned mask, T value, unsigned source) {
    static_assert(sizeof(T) <= sizeof(unsigned long long), "shuffles move at most eight bytes");
    unsigned long long bits = 0;
    memcpy(&bits, &value, sizeof(T));
    bits = machine().meet(Operation::SHUFFLE, mask, bits, source);
    memcpy(&value, &bits, sizeof(T));
    return value;
}

inline unsigned lane() {
    return threadIdx.x % warpSize;
}

} // namespace emulator

template <class T> T __shfl_sync(unsigned mask, T value, int source, int width = warpSize) {
    const unsigned begin = emulator::lane() & ~(width - 1u);
    return emulator::shuffle(mask, value, begin + ((unsigned)source & (width - 1u)));
}

template <class T> T __shfl_up_sync(unsigned mask, T value, unsigned delta, int width = warpSize) {
    const unsigned lane = emulator::lane(), begin = lane & ~(width - 1u);
    return emulator::shuffle(mask, value, lane >= begin + delta ? lane - delta : lane);
}

template <class T> T __shfl_down_sync(unsigned mask, T value, unsigned delta, int width = warpSize) {
    const unsigned lane = emulator::lane(), end = (lane & ~(width - 1u)) + width;
    return emulator::shuffle(mask, value, lane + delta < end ? lane + delta : lane);
}

template <class T> T __shfl_xor_sync(unsigned mask, T value, int lane_mask, int width = warpSize) {
    const unsigned lane = emulator::lane(), end = (lane & ~(width - 1u)) + width, source = lane ^ (unsigned)lane_mask;
    return emulator::shuffle(mask, value, source < end ? source : lane);
}

inline unsigned __ballot_sync(unsigned mask, int predicate) {
    return (unsigned)emulator::machine().meet(emulator::Operation::BALLOT, mask, predicate != 0, 0);
}

inline int __any_sync(unsigned mask, int predicate) {
    return __ballot_sync(mask, predicate) != 0;
}

inline int __all_sync(unsigned mask, int predicate) {
    return __ballot_sync(mask, predicate) == mask;
}

template <class T> unsigned __match_any_sync(unsigned mask, T value) {
    unsigned long long bits = 0;
    memcpy(&bits, &value, sizeof(T));
    return (unsigned)emulator::machine().meet(emulator::Operation::MATCH, mask, bits, 0);
}

inline void __syncwarp(unsigned mask = 0xffffffffu) {
    emulator::machine().meet(emulator::Operation::SYNC, mask, 0, 0);
}

inline void __syncthreads() {
    emulator::machine().barrier(false);
}

inline int __syncthreads_count(int predicate) {
    return (int)emulator::machine().barrier(predicate != 0);
}

inline int __syncthreads_or(int predicate) {
    return __syncthreads_count(predicate) != 0;
}

inline int __syncthreads_and(int predicate) {
    return __syncthreads_count(predicate == 0) == 0;
}

// Threads take turns only at a rendezvous, so that memory is always up to date.
inline void __threadfence() {}
inline void __threadfence_block() {}
inline void __threadfence_system() {}
inline void __nanosleep(unsigned) {}
