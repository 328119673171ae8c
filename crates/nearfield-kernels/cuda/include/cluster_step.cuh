// Steps by lists of clusters.
//
// The host enqueues steps without knowing how long the list will serve, then the next list, and so on. A step that finds
// a particle too far from where it was when the list was made forbids the next, and steps that are forbidden do nothing.
// So no pair is missed, and the host need not wait. Which step a launch is follows from how many were done before, so
// that launches do not differ from one list to the next.

#pragma once

#include "integrate.cuh"
#include "listed.cuh"

// Whether the step is not forbidden; it is then noted as done.
__device__ inline bool begin_step(const ClusterStepArgs& a) {
    if (!serves(a.listed)) return false;
    if (thread_index() == 0) a.listed.control->next = step_of(a.listed) + 1;
    return true;
}

// The rest of a step of particle `i`, `p`, which was at `reference` when the list was made, and the beginning of the
// next.
template <bool NOISE>
__device__ inline void move_particle(const ClusterStepArgs& a, u32 i, Moving p, const float4& force,
                                     const float4& reference) {
    Particles to = a.particles;
    to.position = a.next;
    const u64 step = step_of(a.listed);
    const bool moves = advance<NOISE>(a.integrator, a.status, a.particles, i, step, p, force);
    store_moving(to, i, p);
    if (moves && has_moved(a.integrator.space, reference, p.position, a.limit2)) {
        atomicMin(&a.listed.control->rebuild_at, step + 1);
    }
}
