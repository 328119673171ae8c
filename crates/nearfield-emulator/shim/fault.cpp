#include "fault.hpp"

#include <csignal>
#include <mutex>

#include "machine.hpp"

namespace emulator {

namespace {

struct sigaction before_segv, before_bus;

void on_fault(int signal, siginfo_t* info, void*) {
    // The fault is the kernel's own, at this instruction, so that its stack may simply be left.
    if (running)
        running->fail("thread %u accesses %p, where no memory is or which is not aligned", threadIdx.x, info->si_addr);
    // Not ours: the access happens again, with the action that was there before.
    sigaction(signal, signal == SIGBUS ? &before_bus : &before_segv, nullptr);
}

void install() {
    struct sigaction action = {};
    action.sa_sigaction = on_fault;
    // The handler does not return where it reports, so the signal must not stay blocked.
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    sigaction(SIGSEGV, &action, &before_segv);
    sigaction(SIGBUS, &action, &before_bus);
}

} // namespace

void report_faults() {
    static std::once_flag once;
    std::call_once(once, install);
}

} // namespace emulator
