// Mirror particles (tutorial C): particles whose box pokes over a periodic face appear once more on the other side.

#include "boxes.cuh"

// Notes the faces for which each particle has ghosts, and counts these.
KERNEL(count_ghosts, BoxesArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n) return;
    const u32 faces = faces_with_ghosts(a, a.position[i]);
    a.faces[i] = (u8)faces;
    if (faces == 0) return;
    u32 count = 0;
    for (u32 image = 0; image < 27; ++image) count += has_ghost(faces, image) ? 1 : 0;
    atomicAdd(a.counter, count);
}

KERNEL(make_ghosts, BoxesArgs, 256) {
    const u32 i = thread_index();
    if (i >= a.n || a.faces[i] == 0) return;
    for (u32 image = 0; image < 27; ++image) {
        if (has_ghost(a.faces[i], image)) a.ghost[atomicAdd(a.counter, 1u)] = {i, image};
    }
}
