// What raytracing.cuh provides on a device: programs that list themselves, and rays as calls for each box around a
// point.

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
#define MISS(name) static void miss_##name()

#define PARAMETERS(Args)                                                                                               \
    static thread_local Args params;                                                                                   \
    static void* params_address() { return &params; }                                                                  \
    static emulator::Entry params_entry = {                                                                            \
        emulator::Entry::PARAMETERS, "params", sizeof(Args), 0, nullptr, params_address, nullptr};                     \
    static const emulator::Registration params_registration(this_module, params_entry);

namespace emulator {

typedef void (*Visit)(unsigned primitive, unsigned instance);

// Calls `visit` for each box of the structure behind `handle` that holds the point; why not, where it fails.
typedef const char* (*Traverse)(const void* scene, unsigned long long handle, float x, float y, float z, Visit visit);

// The launch and the ray that this thread of the operating system is at.
struct Ray {
    Traverse traverse;
    const void* scene;
    void (*intersection)(const void*);
    unsigned count;
    unsigned* payload;
    unsigned primitive, instance;
};
extern __thread Ray ray;

} // namespace emulator

namespace rt {

const int PAYLOAD_WORDS = 16;

inline unsigned ray_index() { return blockIdx.x * blockDim.x + threadIdx.x; }
inline unsigned primitive_index() { return emulator::ray.primitive; }
inline unsigned instance_index() { return emulator::ray.instance; }
template <unsigned I> unsigned payload() {
    static_assert(I < PAYLOAD_WORDS, "words are numbered below their count");
    return emulator::ray.payload[I];
}
template <unsigned I> void set_payload(unsigned value) {
    static_assert(I < PAYLOAD_WORDS, "words are numbered below their count");
    emulator::ray.payload[I] = value;
}

template <int WORDS> void trace(unsigned long long handle, float x, float y, float z, unsigned (&p)[WORDS]) {
    static_assert(WORDS <= PAYLOAD_WORDS, "pipelines are made for so many");
    unsigned words[PAYLOAD_WORDS] = {};
    memcpy(words, p, sizeof(p));
    emulator::ray.payload = words;
    const char* error =
        emulator::ray.traverse(emulator::ray.scene, handle, x, y, z, [](unsigned primitive, unsigned instance) {
            emulator::ray.primitive = primitive;
            emulator::ray.instance = instance;
            emulator::ray.intersection(nullptr);
        });
    if (error) emulator::machine().fail("ray %u: %s", ray_index(), error);
    memcpy(p, words, sizeof(p));
}

} // namespace rt
