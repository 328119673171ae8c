// What raytracing.cuh provides on a device: programs that list themselves, and rays as calls for each primitive that
// they meet.

#pragma once

#include "machine.hpp"
#include "registry.hpp"

#define EMULATOR_PROGRAM(kind, prefix, name)                                                                           \
    static void prefix##name();                                                                                        \
    static void prefix##name##_run(const void*) { prefix##name(); }                                                    \
    static emulator::Entry prefix##name##_entry = {                                                                    \
        emulator::Entry::kind, #name, 0, 0, prefix##name##_run, nullptr, nullptr};                                     \
    static const emulator::Registration prefix##name##_registration(this_module, prefix##name##_entry);                \
    static void prefix##name()

#define RAYGEN(name) EMULATOR_PROGRAM(RAYGEN, raygen_, name)
#define INTERSECTION(name) EMULATOR_PROGRAM(INTERSECTION, intersection_, name)
#define ANYHIT(name) EMULATOR_PROGRAM(ANYHIT, anyhit_, name)
#define MISS(name) static void miss_##name()

#define PARAMETERS(Args)                                                                                               \
    static thread_local Args params;                                                                                   \
    static void* params_address() { return &params; }                                                                  \
    static emulator::Entry params_entry = {                                                                            \
        emulator::Entry::PARAMETERS, "params", sizeof(Args), 0, nullptr, params_address, nullptr};                     \
    static const emulator::Registration params_registration(this_module, params_entry);

namespace emulator {

// From the origin along the direction, which has length 1, to a distance.
struct Segment {
    float origin[3], direction[3], length;
};

typedef void (*Visit)(unsigned primitive, unsigned instance, float distance);

// Calls `visit` for each primitive of the structure behind `handle` that the segment meets; why not, where it fails.
typedef const char* (*Traverse)(const void* scene, unsigned long long handle, const Segment* segment, Visit visit);

// The launch and the ray that this thread of the operating system is at.
struct Ray {
    Traverse traverse;
    const void* scene;
    void (*hit)(const void*);
    unsigned count;
    unsigned* payload;
    unsigned primitive, instance;
    float distance;
};
extern __thread Ray ray;

} // namespace emulator

namespace rt {

const int PAYLOAD_WORDS = 16;

inline unsigned ray_index() { return blockIdx.x * blockDim.x + threadIdx.x; }
inline unsigned primitive_index() { return emulator::ray.primitive; }
inline unsigned instance_index() { return emulator::ray.instance; }
inline float hit_distance() { return emulator::ray.distance; }
// Rays always go on.
inline void ignore_hit() {}
template <unsigned I> unsigned payload() {
    static_assert(I < PAYLOAD_WORDS, "words are numbered below their count");
    return emulator::ray.payload[I];
}
template <unsigned I> void set_payload(unsigned value) {
    static_assert(I < PAYLOAD_WORDS, "words are numbered below their count");
    emulator::ray.payload[I] = value;
}

template <int WORDS>
void trace(unsigned long long handle, float x, float y, float z, float dx, float dy, float dz, float tmax,
           unsigned (&p)[WORDS]) {
    static_assert(WORDS <= PAYLOAD_WORDS, "pipelines are made for so many");
    unsigned words[PAYLOAD_WORDS] = {};
    memcpy(words, p, sizeof(p));
    emulator::ray.payload = words;
    const emulator::Segment segment = {{x, y, z}, {dx, dy, dz}, tmax};
    const char* error = emulator::ray.traverse(
        emulator::ray.scene, handle, &segment, [](unsigned primitive, unsigned instance, float distance) {
            emulator::ray.primitive = primitive;
            emulator::ray.instance = instance;
            emulator::ray.distance = distance;
            emulator::ray.hit(nullptr);
        });
    if (error) emulator::machine().fail("ray %u: %s", ray_index(), error);
    memcpy(p, words, sizeof(p));
}

template <int WORDS> void trace_point(unsigned long long handle, float x, float y, float z, unsigned (&p)[WORDS]) {
    trace(handle, x, y, z, 1.0f, 0.0f, 0.0f, 1e-16f, p);
}

} // namespace rt
