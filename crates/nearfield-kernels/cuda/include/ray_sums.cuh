// Sums of a ray's particle, carried in words of the payload while the ray is traced.

#pragma once

#include "law.cuh"
#include "rays.cuh"
#include "sums.cuh"

template <bool EXACT, bool ENERGY> struct SumWords {
    static const int COUNT = (EXACT ? 6 : 3) + (ENERGY ? 5 : 0);
};

__device__ inline u64 join(const u32* words) {
    return words[0] | (u64)words[1] << 32;
}

__device__ inline void split(u64 value, u32* words) {
    words[0] = (u32)value;
    words[1] = (u32)(value >> 32);
}

template <bool ENERGY> __device__ inline void unpack(const u32* words, Sums<false, ENERGY>& s) {
    s.x = __uint_as_float(words[0]);
    s.y = __uint_as_float(words[1]);
    s.z = __uint_as_float(words[2]);
    if (ENERGY) {
        s.energy = __longlong_as_double((i64)join(words + 3));
        s.virial = __longlong_as_double((i64)join(words + 5));
        s.neighbors = words[7];
    }
}

template <bool ENERGY> __device__ inline void pack(const Sums<false, ENERGY>& s, u32* words) {
    words[0] = __float_as_uint(s.x);
    words[1] = __float_as_uint(s.y);
    words[2] = __float_as_uint(s.z);
    if (ENERGY) {
        split((u64)__double_as_longlong(s.energy), words + 3);
        split((u64)__double_as_longlong(s.virial), words + 5);
        words[7] = s.neighbors;
    }
}

template <bool ENERGY> __device__ inline void unpack(const u32* words, Sums<true, ENERGY>& s) {
    s.x = (i64)join(words);
    s.y = (i64)join(words + 2);
    s.z = (i64)join(words + 4);
    if (ENERGY) {
        s.energy = (i64)join(words + 6);
        s.virial = (i64)join(words + 8);
        s.neighbors = words[10];
    }
}

template <bool ENERGY> __device__ inline void pack(const Sums<true, ENERGY>& s, u32* words) {
    split((u64)s.x, words);
    split((u64)s.y, words + 2);
    split((u64)s.z, words + 4);
    if (ENERGY) {
        split((u64)s.energy, words + 6);
        split((u64)s.virial, words + 8);
        words[10] = s.neighbors;
    }
}

// The payload is addressed by constants only.
template <u32 FROM, int COUNT> __device__ inline void read_payload(u32* words) {
    if constexpr (COUNT > 0) {
        *words = rt::payload<FROM>();
        read_payload<FROM + 1, COUNT - 1>(words + 1);
    }
}

template <u32 FROM, int COUNT> __device__ inline void write_payload(const u32* words) {
    if constexpr (COUNT > 0) {
        rt::set_payload<FROM>(*words);
        write_payload<FROM + 1, COUNT - 1>(words + 1);
    }
}

// Sends the rays of a particle and gives the sums they come back with.
template <class Probe, bool EXACT, bool ENERGY>
__device__ inline Sums<EXACT, ENERGY> sum_rays(const Rays& rays, u32 i) {
    // Zero sums are zero words.
    u32 payload[PAYLOAD_CONSUMER + SumWords<EXACT, ENERGY>::COUNT] = {};
    send_rays<Probe>(rays, i, payload);
    Sums<EXACT, ENERGY> sums;
    unpack(payload + PAYLOAD_CONSUMER, sums);
    return sums;
}

// In an intersection: adds a pair to the sums of the ray's particle.
template <bool EXACT, bool ENERGY>
__device__ inline void add_to_ray(const Law& law, const Meeting& m, const PairForce& pair) {
    const int COUNT = SumWords<EXACT, ENERGY>::COUNT;
    u32 words[COUNT];
    read_payload<PAYLOAD_CONSUMER, COUNT>(words);
    Sums<EXACT, ENERGY> sums;
    unpack(words, sums);
    sums.add(law, m.d.x, m.d.y, m.d.z, pair.f_over_r, pair.energy, m.r2);
    pack(sums, words);
    write_payload<PAYLOAD_CONSUMER, COUNT>(words);
}

template <class L, bool ENERGY> __device__ inline PairForce force_between(const Rays& rays, const Meeting& m) {
    u32 kind_i = 0, kind_j = 0;
    if (L::TYPED && rays.law.n_types > 1) {
        kind_i = __float_as_uint(rays.particles.velocity[m.i].w);
        kind_j = __float_as_uint(rays.particles.velocity[m.j].w);
    }
    return L::template evaluate<ENERGY>(rays.law, m.r2, m.range, kind_i, kind_j);
}
