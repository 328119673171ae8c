// Runs the blocks of a launch one after another, and the threads of a block as fibers that meet where CUDA says so.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fiber.hpp"
#include "vectors.hpp"

// Per thread of the operating system, so that launches may run side by side.
extern __thread uint3 threadIdx, blockIdx, blockDim, gridDim;

namespace emulator {

enum class Operation : unsigned char { SHUFFLE, BALLOT, MATCH, SYNC };

struct Launch {
    const char* name;
    unsigned blocks, threads;
    // Whether threads may work together: ray-tracing programs may not.
    bool cooperative;
    void (*thread)(const void* arguments);
    const void* arguments;
};

class Machine {
public:
    // Runs all blocks on this thread of the operating system; on failure writes why.
    static bool launch_here(const Launch&, char* error, size_t capacity);

    // A rendezvous of the lanes in `mask`. Of a shuffle it gives the value of lane `source`, of a ballot the lanes
    // whose values are not zero, of a match those whose values are equal to this lane's.
    unsigned long long meet(Operation, unsigned mask, unsigned long long value, unsigned source);

    // A rendezvous of all threads that have not ended; gives the number of those with a vote.
    unsigned barrier(bool vote);

    // Ends the launch with an error.
    [[noreturn]] void fail(const char* format, ...) __attribute__((format(printf, 2, 3)));

private:
    struct Thread {
        Fiber* fiber;
        unsigned long long value, result;
        unsigned mask, source;
        Operation operation;
    };
    struct Warp {
        unsigned waiting, ended;
    };

    bool run(const Launch&, char* error, size_t capacity);
    static void fiber_main();
    void begin_block();
    unsigned next_thread();
    bool block_ended() const { return unended == 0; }
    void run_thread(unsigned);
    void end_thread(unsigned);
    void wait(unsigned);
    void leave();
    Fiber* take_fiber();
    bool all_arrived(unsigned warp, unsigned mask) const;
    void complete(unsigned warp, unsigned mask);
    void open_barrier();
    void make_ready(unsigned);
    void report_deadlock();

    Launch launch;
    char* error;
    size_t capacity;
    bool failed;

    unsigned next, unended;
    std::vector<Thread> threads;
    std::vector<Warp> warps;
    std::vector<unsigned> at_barrier;
    unsigned votes, barrier_result;

    // Threads that can go on, a ring as long as the block.
    std::vector<unsigned> ready;
    unsigned first_ready, n_ready;

    Fiber host;
    std::vector<std::unique_ptr<Fiber>> fibers;
    unsigned fibers_used;
    std::vector<Fiber*> idle;
    Fiber* current;
};

// That of the launch on this thread of the operating system; null while there is none.
extern __thread Machine* running;

inline Machine& machine() {
    return *running;
}

} // namespace emulator
