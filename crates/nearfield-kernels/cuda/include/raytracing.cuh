// OptiX device functions as inline PTX: what its driver expects of programs, without its headers. The emulator provides
// the same functions in C++ instead of this file.

#pragma once

#include "base.cuh"

#ifndef RAYGEN
#define RAYGEN(name) extern "C" __global__ void __raygen__##name()
#define INTERSECTION(name) extern "C" __global__ void __intersection__##name()
#define ANYHIT(name) extern "C" __global__ void __anyhit__##name()
// The launch parameters, called `params`.
#define PARAMETERS(Args)                                                                                               \
    extern "C" {                                                                                                       \
    __constant__ Args params;                                                                                          \
    }

namespace rt {

// Most words that a ray carries from its generation to its intersections and back.
const int PAYLOAD_WORDS = 16;

// Number of this ray.
__device__ inline u32 ray_index() {
    u32 x;
    asm("call (%0), _optix_get_launch_index_x, ();" : "=r"(x));
    return x;
}

// In an intersection or hit: number of the primitive.
__device__ inline u32 primitive_index() {
    u32 x;
    asm("call (%0), _optix_read_primitive_idx, ();" : "=r"(x));
    return x;
}

// In an intersection or hit: number of the instance, 0 where primitives are traced directly.
__device__ inline u32 instance_index() {
    u32 x;
    asm("call (%0), _optix_read_instance_idx, ();" : "=r"(x));
    return x;
}

// In a hit: how far along the ray.
__device__ inline float hit_distance() {
    float t;
    asm volatile("call (%0), _optix_get_ray_tmax, ();" : "=f"(t));
    return t;
}

// The last call of a hit: the ray goes on, and its end stays where it was.
__device__ inline void ignore_hit() {
    asm volatile("call _optix_ignore_intersection, ();");
}

// In an intersection or hit: word `I` of the ray's payload.
template <u32 I> __device__ inline u32 payload() {
    u32 x;
    asm volatile("call (%0), _optix_get_payload, (%1);" : "=r"(x) : "r"(I));
    return x;
}

template <u32 I> __device__ inline void set_payload(u32 value) {
    asm volatile("call _optix_set_payload, (%0, %1);" ::"r"(I), "r"(value));
}

// In a ray generation: calls the intersection or any-hit program for each primitive that the ray from `x, y, z` along
// the unit vector `dx, dy, dz` meets within `tmax`. It carries `p`: the fewer words, the less is kept meanwhile.
template <int WORDS>
__device__ inline void trace(u64 handle, float x, float y, float z, float dx, float dy, float dz, float tmax,
                             u32 (&p)[WORDS]) {
    static_assert(WORDS <= PAYLOAD_WORDS, "pipelines are made for so many");
    u32 w[PAYLOAD_WORDS] = {};
    for (int k = 0; k < WORDS; ++k) w[k] = p[k];
    [[maybe_unused]] u32 dummy[16];
    const float zero = 0.0f;
    const u32 none = 0, mask = 255, stride = 1, count = WORDS;
    // Terminating rays or calling closest-hit programs is never needed: intersections report nothing, hits are ignored.
    asm volatile("call (%0,%1,%2,%3,%4,%5,%6,%7,%8,%9,%10,%11,%12,%13,%14,%15,%16,%17,%18,%19,%20,%21,%22,%23,%24,%25,"
                 "%26,%27,%28,%29,%30,%31), _optix_trace_typed_32, (%32,%33,%34,%35,%36,%37,%38,%39,%40,%41,%42,%43,"
                 "%44,%45,%46,%47,%48,%49,%50,%51,%52,%53,%54,%55,%56,%57,%58,%59,%60,%61,%62,%63,%64,%65,%65,%65,%65,"
                 "%65,%65,%65,%65,%65,%65,%65,%65,%65,%65,%65,%65);"
                 : "=r"(w[0]), "=r"(w[1]), "=r"(w[2]), "=r"(w[3]), "=r"(w[4]), "=r"(w[5]), "=r"(w[6]), "=r"(w[7]),
                   "=r"(w[8]), "=r"(w[9]), "=r"(w[10]), "=r"(w[11]), "=r"(w[12]), "=r"(w[13]), "=r"(w[14]),
                   "=r"(w[15]), "=r"(dummy[0]), "=r"(dummy[1]), "=r"(dummy[2]), "=r"(dummy[3]), "=r"(dummy[4]),
                   "=r"(dummy[5]), "=r"(dummy[6]), "=r"(dummy[7]), "=r"(dummy[8]), "=r"(dummy[9]), "=r"(dummy[10]),
                   "=r"(dummy[11]), "=r"(dummy[12]), "=r"(dummy[13]), "=r"(dummy[14]), "=r"(dummy[15])
                 : "r"(none), "l"(handle), "f"(x), "f"(y), "f"(z), "f"(dx), "f"(dy), "f"(dz), "f"(zero),
                   "f"(tmax), "f"(zero), "r"(mask), "r"(none), "r"(none), "r"(stride), "r"(none), "r"(count),
                   "r"(w[0]), "r"(w[1]), "r"(w[2]), "r"(w[3]), "r"(w[4]), "r"(w[5]), "r"(w[6]), "r"(w[7]), "r"(w[8]),
                   "r"(w[9]), "r"(w[10]), "r"(w[11]), "r"(w[12]), "r"(w[13]), "r"(w[14]), "r"(w[15]), "r"(none)
                 : "memory");
    for (int k = 0; k < WORDS; ++k) p[k] = w[k];
}

// The same for each box that holds the point, by an infinitesimal ray.
template <int WORDS> __device__ inline void trace_point(u64 handle, float x, float y, float z, u32 (&p)[WORDS]) {
    trace(handle, x, y, z, 1.0f, 0.0f, 0.0f, 1e-16f, p);
}

} // namespace rt
#endif
