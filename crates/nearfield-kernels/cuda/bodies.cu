// Spheres and squares around particles and ghosts, for acceleration structures.

#include "boxes.cuh"
#include "geometry.cuh"

namespace {

// Where the body of particle or ghost k is. Notes when a particle needs a ghost that it lacks.
__device__ float4 center_of(const BodiesArgs& a, u32 k) {
    const Ghost self = k < a.boxes.n ? Ghost{k, HOME_IMAGE} : a.boxes.ghost[k - a.boxes.n];
    const float4 x = a.boxes.position[self.particle];
    note_missing_ghosts(a.boxes, k, x);
    const float4 p = place(a.geometry, x);
    const Shift s = shift_of(a.boxes.space, self.image);
    return make_float4(p.x + s.x, p.y + s.y, p.z + s.z, 0.0f);
}

__device__ void put_vertex(float* vertex, float x, float y, float z) {
    vertex[0] = x;
    vertex[1] = y;
    vertex[2] = z;
}

} // namespace

// The centre of each sphere.
KERNEL(fit_spheres, BodiesArgs, 256) {
    const u32 k = thread_index();
    if (k < a.boxes.n + a.boxes.n_ghosts) a.centers[k] = center_of(a, k);
}

// The triangles of each pair of squares: of each square first that with the corner of greatest y and least z, then that
// with the opposite corner. Both reach beyond the diagonal between.
KERNEL(fit_squares, BodiesArgs, 256) {
    const u32 k = thread_index();
    if (k >= a.boxes.n + a.boxes.n_ghosts) return;
    const float4 c = center_of(a, k);
    const float near = a.geometry.body, far = near + a.geometry.overlap;
    for (u32 square = 0; square < 2; ++square) {
        const float x = c.x + (square ? a.geometry.offset : -a.geometry.offset);
        float* vertex = a.vertices + 36 * (u64)k + 18 * square;
        put_vertex(vertex, x, c.y + near, c.z - near);
        put_vertex(vertex + 3, x, c.y + near, c.z + far);
        put_vertex(vertex + 6, x, c.y - far, c.z - near);
        put_vertex(vertex + 9, x, c.y - near, c.z + near);
        put_vertex(vertex + 12, x, c.y - near, c.z - far);
        put_vertex(vertex + 15, x, c.y + far, c.z + near);
    }
}
