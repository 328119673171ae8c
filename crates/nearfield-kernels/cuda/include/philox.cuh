// Random numbers as a function of (seed, step, particle): Philox4x32-10 (Salmon et al., SC 2011), as nearfield_core.

#pragma once

#include "base.cuh"

#define STREAM_LANGEVIN 1u

__device__ inline void philox(u32 (&c)[4], u32 k0, u32 k1) {
    for (int round = 0; round < 10; ++round) {
        const u64 a = (u64)0xD2511F53u * c[0], b = (u64)0xCD9E8D57u * c[2];
        const u32 c1 = c[1], c3 = c[3];
        c[0] = (u32)(b >> 32) ^ c1 ^ k0;
        c[1] = (u32)b;
        c[2] = (u32)(a >> 32) ^ c3 ^ k1;
        c[3] = (u32)a;
        k0 += 0x9E3779B9u;
        k1 += 0xBB67AE85u;
    }
}

__device__ inline double uniform(u32 bits) {
    return ((double)bits + 0.5) / 4294967296.0;
}

struct Normals {
    double x, y, z;
};

// Three standard normal numbers by the Box-Muller transform.
RARE Normals normals(u32 seed0, u32 seed1, u64 step, u32 index) {
    u32 c[4] = {index, (u32)step, (u32)(step >> 32), STREAM_LANGEVIN};
    philox(c, seed0, seed1);
    double s, t;
    sincos(6.283185307179586 * uniform(c[1]), &s, &t);
    const double r = sqrt(-2.0 * log(uniform(c[0])));
    return {r * t, r * s, sqrt(-2.0 * log(uniform(c[2]))) * cos(6.283185307179586 * uniform(c[3]))};
}
