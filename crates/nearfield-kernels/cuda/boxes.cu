// Boxes around particles and ghosts, for acceleration structures.

#include "boxes.cuh"

namespace {

__device__ void fit_axis(float x, float half, float* lo, float* hi) {
    // What rounding may take from the sum.
    half += fabsf(x) * 2.384185791015625e-07f;
    *lo = x - half;
    *hi = x + half;
}

} // namespace

// The box of each particle and ghost. Notes when a particle needs a ghost that it lacks.
KERNEL(fit_boxes, BoxesArgs, 256) {
    const u32 k = thread_index();
    if (k >= a.n + a.n_ghosts) return;
    const Ghost self = k < a.n ? Ghost{k, HOME_IMAGE} : a.ghost[k - a.n];
    const float4 x = seen(a.space, a.position[self.particle]);
    const float half = half_width(a, x);
    const Shift s = shift_of(a.space, self.image);
    float* box = a.boxes + 6 * (u64)k;
    fit_axis(x.x + s.x, half, box, box + 3);
    fit_axis(x.y + s.y, half, box + 1, box + 4);
    fit_axis(x.z + s.z, half, box + 2, box + 5);
    note_missing_ghosts(a, k, x);
}
