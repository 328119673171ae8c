// The kernels and programs of each source file, listed before main and only read afterwards.

#pragma once

#include <cstddef>

namespace emulator {

struct Entry {
    enum Kind { KERNEL, RAYGEN, INTERSECTION, ANYHIT, PARAMETERS };
    Kind kind;
    const char* name;
    // Of its arguments.
    size_t size;
    // Most threads to a block.
    unsigned threads;
    // Runs one thread; of parameters nothing.
    void (*run)(const void* arguments);
    // Of parameters: where they are kept for this thread of the operating system.
    void* (*address)();
    const Entry* next;
};

struct Module {
    const char* name;
    const Entry* entries = nullptr;

    explicit Module(const char* name) : name(name) {}
};

// Lists an entry in its module.
struct Registration {
    Registration(Module& module, Entry& entry) {
        entry.next = module.entries;
        module.entries = &entry;
    }
};

// All modules, ending with null; generated when building.
extern const Module* (*const MODULES[])();

} // namespace emulator
