// Stacks that take turns on one thread of the operating system.

#pragma once

#include <cstddef>
#include <memory>

#if !defined(__x86_64__) || defined(_WIN32)
#define EMULATOR_UCONTEXT
#endif
#ifdef EMULATOR_UCONTEXT
#if defined(__APPLE__)
#define _XOPEN_SOURCE
#endif
#include <ucontext.h>
#endif

namespace emulator {

class Fiber {
public:
    // The stack that runs already.
    Fiber() = default;

    // A new stack; `number` spreads the stacks over cache sets.
    explicit Fiber(unsigned number);

    // The next switch to this fiber calls `entry`, which must not return.
    void start(void (*entry)());

    // Whether something was written beyond the stack.
    bool overflowed() const;

    // Goes on with `to`, until something switches back to this fiber, which must be the one that runs.
    void switch_to(Fiber& to);

private:
    std::unique_ptr<unsigned char[]> stack;
    unsigned char* top = nullptr;
#ifdef EMULATOR_UCONTEXT
    ucontext_t context;
#else
    void* context = nullptr;
#endif
};

} // namespace emulator
