// What the crate calls: kernels and ray-tracing programs by name.

#include <cstdio>
#include <cstring>

#include "machine.hpp"
#include "raytracing.hpp"
#include "registry.hpp"

namespace emulator {

__thread Ray ray;

namespace {

// CUDA's limit of kernel arguments.
const size_t MAX_ARGUMENTS = 4096;
const unsigned RAYS_AT_ONCE = 64;

const Entry* find(const char* module, Entry::Kind kind, const char* name) {
    for (size_t i = 0; MODULES[i]; ++i) {
        const Module* candidate = MODULES[i]();
        if (strcmp(candidate->name, module) != 0) continue;
        for (const Entry* entry = candidate->entries; entry; entry = entry->next) {
            if (entry->kind == kind && strcmp(entry->name, name) == 0) return entry;
        }
    }
    return nullptr;
}

} // namespace

} // namespace emulator

using namespace emulator;

extern "C" bool nearfield_emulator_launch(const char* module, const char* name, unsigned blocks, unsigned threads,
                                          const void* arguments, size_t size, char* error, size_t capacity) {
    const Entry* kernel = find(module, Entry::KERNEL, name);
    if (!kernel) {
        snprintf(error, capacity, "there is no kernel %s in module %s", name, module);
        return false;
    }
    if (size != kernel->size || size > MAX_ARGUMENTS) {
        snprintf(error, capacity, "%s takes %zu bytes of arguments, not %zu", name, kernel->size, size);
        return false;
    }
    if (threads > kernel->threads) {
        snprintf(error, capacity, "%s is for at most %u threads to a block, not %u", name, kernel->threads, threads);
        return false;
    }
    alignas(64) unsigned char copy[MAX_ARGUMENTS];
    memcpy(copy, arguments, size);
    return Machine::launch_here({name, blocks, threads, true, kernel->run, copy}, error, capacity);
}

extern "C" bool nearfield_emulator_trace(const char* module, const char* raygen, const char* hit, bool anyhit,
                                         unsigned rays, const void* parameters, size_t size, Traverse traverse,
                                         const void* scene, char* error, size_t capacity) {
    const Entry* generation = find(module, Entry::RAYGEN, raygen);
    const Entry* program = find(module, anyhit ? Entry::ANYHIT : Entry::INTERSECTION, hit);
    const Entry* params = find(module, Entry::PARAMETERS, "params");
    if (!generation || !program || !params) {
        snprintf(error, capacity, "module %s lacks its parameters, ray generation %s or %s %s", module, raygen,
                 anyhit ? "any-hit" : "intersection", hit);
        return false;
    }
    if (size != params->size) {
        snprintf(error, capacity, "%s takes %zu bytes of parameters, not %zu", raygen, params->size, size);
        return false;
    }
    memcpy(params->address(), parameters, size);
    ray = {traverse, scene, program->run, rays, nullptr, 0, 0, 0.0f};
    const auto thread = [](const void* run) {
        if (rt::ray_index() < ray.count) (*static_cast<void (*const*)(const void*)>(run))(nullptr);
    };
    const unsigned blocks = rays / RAYS_AT_ONCE + (rays % RAYS_AT_ONCE != 0);
    return Machine::launch_here({raygen, blocks, RAYS_AT_ONCE, false, thread, &generation->run}, error, capacity);
}
