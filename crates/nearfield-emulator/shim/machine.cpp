#include "machine.hpp"
#include "fault.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>

__thread uint3 threadIdx, blockIdx, blockDim, gridDim;

namespace emulator {

namespace {

const unsigned WARP_SIZE = 32, MAX_THREADS = 1024;

// What lanes outside a mask seem to hold: CUDA leaves it undefined.
const unsigned long long UNDEFINED = 0xa5a5a5a5a5a5a5a5ull;

unsigned first_lane(unsigned lanes) {
    return __builtin_ctz(lanes);
}

} // namespace

__thread Machine* running;

bool Machine::launch_here(const Launch& what, char* error, size_t capacity) {
    static thread_local Machine machine;
    report_faults();
    running = &machine;
    const bool good = machine.run(what, error, capacity);
    running = nullptr;
    return good;
}

bool Machine::run(const Launch& what, char* text, size_t length) {
    launch = what;
    error = text;
    capacity = length;
    failed = false;
    fibers_used = 0;
    idle.clear();
    blockDim = {launch.threads, 1, 1};
    gridDim = {launch.blocks, 1, 1};
    threadIdx = blockIdx = {0, 0, 0};
    if (launch.blocks == 0 || launch.threads == 0 || launch.threads > MAX_THREADS) {
        snprintf(error, capacity, "%s: %u blocks of %u threads cannot be launched", launch.name, launch.blocks,
                 launch.threads);
        return false;
    }
    threads.resize(launch.threads);
    ready.resize(launch.threads);
    warps.resize((launch.threads + WARP_SIZE - 1) / WARP_SIZE);
    for (unsigned block = 0; block < launch.blocks && !failed; ++block) {
        blockIdx.x = block;
        begin_block();
        current = take_fiber();
        host.switch_to(*current);
        if (!failed && !block_ended()) report_deadlock();
    }
    for (unsigned i = 0; i < fibers_used; ++i) {
        if (!fibers[i]->overflowed()) continue;
        snprintf(error, capacity, "%s: a thread needs more stack than the emulator has", launch.name);
        fibers[i].reset(new Fiber(i));
        failed = true;
    }
    return !failed;
}

void Machine::begin_block() {
    next = 0;
    unended = launch.threads;
    at_barrier.clear();
    votes = 0;
    first_ready = n_ready = 0;
    for (Warp& warp : warps) warp = {0, 0};
    const unsigned in_last = launch.threads % WARP_SIZE;
    if (in_last != 0) warps.back().ended = ~0u << in_last;
}

Fiber* Machine::take_fiber() {
    if (!idle.empty()) {
        Fiber* fiber = idle.back();
        idle.pop_back();
        return fiber;
    }
    if (fibers_used == fibers.size()) fibers.emplace_back(new Fiber(fibers_used));
    Fiber* fiber = fibers[fibers_used++].get();
    fiber->start(fiber_main);
    return fiber;
}

// Runs threads on one stack while none of them waits: a kernel without rendezvous never switches stacks.
void Machine::fiber_main() {
    Machine& m = machine();
    for (;;) {
        // Threads that wait come first, so that a warp ends before the next one begins and few stacks are in use.
        while (m.n_ready == 0 && m.next < m.launch.threads) m.run_thread(m.next_thread());
        m.idle.push_back(m.current);
        m.leave();
    }
}

// Odd blocks run backwards: a kernel that lacks a barrier should not pass because of the order here.
unsigned Machine::next_thread() {
    const unsigned t = next++;
    return blockIdx.x % 2 == 0 ? t : launch.threads - 1 - t;
}

void Machine::run_thread(unsigned t) {
    threads[t].fiber = current;
    threadIdx.x = t;
    launch.thread(launch.arguments);
    end_thread(t);
}

void Machine::end_thread(unsigned t) {
    const unsigned lane = t % WARP_SIZE;
    Warp& warp = warps[t / WARP_SIZE];
    warp.ended |= 1u << lane;
    for (unsigned rest = warp.waiting; rest != 0; rest &= rest - 1) {
        const unsigned waiting = t - lane + first_lane(rest);
        if (threads[waiting].mask >> lane & 1)
            fail("lane exited before warp operation: thread %u ended while thread %u waits for it (mask %#x)", t,
                 waiting, threads[waiting].mask);
    }
    --unended;
    if (!at_barrier.empty() && at_barrier.size() == unended) open_barrier();
}

// Gives the stack of thread `t` up until it is ready.
void Machine::wait(unsigned t) {
    leave();
    threadIdx.x = t;
}

// Goes on with another fiber: of a thread that is ready, else for a new thread, else with the host.
void Machine::leave() {
    Fiber& from = *current;
    if (n_ready != 0) {
        current = threads[ready[first_ready]].fiber;
        first_ready = first_ready + 1 == ready.size() ? 0 : first_ready + 1;
        --n_ready;
    } else if (next < launch.threads) {
        current = take_fiber();
    } else {
        current = nullptr;
    }
    if (current != &from) from.switch_to(current ? *current : host);
}

void Machine::make_ready(unsigned t) {
    const size_t end = first_ready + n_ready;
    ready[end < ready.size() ? end : end - ready.size()] = t;
    ++n_ready;
}

unsigned long long Machine::meet(Operation operation, unsigned mask, unsigned long long value, unsigned source) {
    const unsigned t = threadIdx.x, lane = t % WARP_SIZE, w = t / WARP_SIZE;
    if (!launch.cooperative) fail("ray-tracing programs have no warp operations");
    if (!(mask >> lane & 1)) fail("thread %u is not in the mask %#x of its warp operation", t, mask);
    Warp& warp = warps[w];
    if (warp.ended & mask)
        fail("lane exited before warp operation: thread %u waits for thread %u (mask %#x)", t,
             t - lane + first_lane(warp.ended & mask), mask);
    Thread& me = threads[t];
    me.operation = operation;
    me.mask = mask;
    me.value = value;
    me.source = source;
    warp.waiting |= 1u << lane;
    if (!all_arrived(w, mask)) {
        wait(t);
        return me.result;
    }
    complete(w, mask);
    warp.waiting &= ~mask;
    for (unsigned rest = mask & ~(1u << lane); rest != 0; rest &= rest - 1) make_ready(t - lane + first_lane(rest));
    return me.result;
}

bool Machine::all_arrived(unsigned w, unsigned mask) const {
    if ((warps[w].waiting & mask) != mask) return false;
    // A lane may still be at a rendezvous with fewer lanes.
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        if (threads[w * WARP_SIZE + first_lane(rest)].mask != mask) return false;
    }
    return true;
}

// The last lane computes the results of all: a lane that goes on may overwrite its value before others have read it.
void Machine::complete(unsigned w, unsigned mask) {
    Thread* const lanes = &threads[w * WARP_SIZE];
    const Operation operation = lanes[first_lane(mask)].operation;
    unsigned ballot = 0;
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        const unsigned lane = first_lane(rest);
        if (lanes[lane].operation != operation)
            fail("threads %u and %u are at different warp operations with the same mask %#x",
                 w * WARP_SIZE + first_lane(mask), w * WARP_SIZE + lane, mask);
        if (lanes[lane].value != 0) ballot |= 1u << lane;
    }
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        Thread& me = lanes[first_lane(rest)];
        switch (operation) {
        case Operation::SHUFFLE: me.result = mask >> me.source & 1 ? lanes[me.source].value : UNDEFINED; break;
        case Operation::BALLOT: me.result = ballot; break;
        case Operation::MATCH:
            me.result = 0;
            for (unsigned others = mask; others != 0; others &= others - 1) {
                if (lanes[first_lane(others)].value == me.value) me.result |= 1u << first_lane(others);
            }
            break;
        case Operation::SYNC: break;
        }
    }
}

unsigned Machine::barrier(bool vote) {
    const unsigned t = threadIdx.x;
    if (!launch.cooperative) fail("ray-tracing programs have no barriers");
    at_barrier.push_back(t);
    votes += vote;
    if (at_barrier.size() == unended) {
        // This thread too: it lines up behind the others.
        open_barrier();
    }
    wait(t);
    return barrier_result;
}

void Machine::open_barrier() {
    for (unsigned t : at_barrier) make_ready(t);
    at_barrier.clear();
    barrier_result = votes;
    votes = 0;
}

void Machine::fail(const char* format, ...) {
    int length = snprintf(error, capacity, "%s, block %u: ", launch.name, blockIdx.x);
    va_list arguments;
    va_start(arguments, format);
    if (length > 0 && (size_t)length < capacity) vsnprintf(error + length, capacity - length, format, arguments);
    va_end(arguments);
    failed = true;
    // Nobody comes back to this stack.
    current->switch_to(host);
    abort();
}

void Machine::report_deadlock() {
    int length = snprintf(error, capacity, "%s, block %u: deadlock: %zu threads wait at a barrier", launch.name,
                          blockIdx.x, at_barrier.size());
    for (size_t w = 0; w < warps.size(); ++w) {
        if (warps[w].waiting == 0 || length < 0 || (size_t)length >= capacity) continue;
        const size_t t = w * WARP_SIZE + first_lane(warps[w].waiting);
        snprintf(error + length, capacity - length, ", thread %zu in a warp operation with mask %#x", t,
                 threads[t].mask);
        break;
    }
    failed = true;
}

} // namespace emulator
