// One step of velocity Verlet: the second half kick of a step, the first half kick and drift of the next.

#include "integrate.cuh"

KERNEL(integrate, IntegrateArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.particles.n) return;
    Moving p = load_moving(a.particles, i);
    const float4 force = a.force[i];
    // A particle that has failed is left where it was, so that coordinates stay finite until the run is stopped.
    if (!all_finite(force)) {
        atomicMin(&a.status->force, failure(a.step, a.particles.id[i]));
        return;
    }
    const float half_kick = half_kick_of(a.integrator, p);
    if (a.finish) finish_step(a.integrator, p, half_kick, force);
    if (a.start) {
        start_step<true>(a.integrator, p, half_kick, force, a.particles.id[i], a.step + 1);
        if (!all_finite(p.position)) {
            atomicMin(&a.status->position, failure(a.step + 1, a.particles.id[i]));
            return;
        }
    }
    store_moving(a.particles, i, p);
}
