#include "fiber.hpp"

#include <cstdint>
#include <cstring>

namespace emulator {

namespace {

// What a thread may use, and as much below, so that a kernel that needs more is found before it does harm.
const size_t STACK = 64 * 1024, RESERVE = 64 * 1024;
const size_t SPREAD = 192, SPREADS = 64;
const uint64_t STACK_END = 0x5afe57ac4e4d0f00ull;

} // namespace

Fiber::Fiber(unsigned number) : stack(new unsigned char[RESERVE + STACK + SPREAD * SPREADS]) {
    uintptr_t end = (uintptr_t)stack.get() + RESERVE + STACK + SPREAD * (number % SPREADS);
    top = (unsigned char*)(end & ~(uintptr_t)15);
    memcpy(stack.get() + RESERVE, &STACK_END, sizeof STACK_END);
}

bool Fiber::overflowed() const {
    return memcmp(stack.get() + RESERVE, &STACK_END, sizeof STACK_END) != 0;
}

#ifdef EMULATOR_UCONTEXT

void Fiber::start(void (*entry)()) {
    getcontext(&context);
    context.uc_stack.ss_sp = stack.get();
    context.uc_stack.ss_size = top - stack.get();
    context.uc_link = nullptr;
    makecontext(&context, entry, 0);
}

void Fiber::switch_to(Fiber& to) {
    swapcontext(&context, &to.context);
}

#else

// System V x86-64: pushes what a called function must preserve and exchanges stack pointers. The floating-point control
// words are left out, because kernels do not change them.
extern "C" void nearfield_emulator_switch(void** save, void* load) __asm__("nearfield_emulator_switch");
__asm__(".text\n"
        ".globl nearfield_emulator_switch\n"
        "nearfield_emulator_switch:\n"
        "    pushq %rbp\n"
        "    pushq %rbx\n"
        "    pushq %r12\n"
        "    pushq %r13\n"
        "    pushq %r14\n"
        "    pushq %r15\n"
        "    movq %rsp, (%rdi)\n"
        "    movq %rsi, %rsp\n"
        "    popq %r15\n"
        "    popq %r14\n"
        "    popq %r13\n"
        "    popq %r12\n"
        "    popq %rbx\n"
        "    popq %rbp\n"
        "    ret\n");

void Fiber::start(void (*entry)()) {
    // Six registers, the address that `ret` goes to, and the return address that `entry` believes to have.
    void** frame = (void**)top - 8;
    memset(frame, 0, 8 * sizeof(void*));
    frame[6] = (void*)entry;
    context = frame;
}

void Fiber::switch_to(Fiber& to) {
    nearfield_emulator_switch(&context, to.context);
}

#endif

} // namespace emulator
