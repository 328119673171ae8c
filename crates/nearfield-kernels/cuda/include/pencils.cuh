// The search of a warp: from the box around its particles to the rows of cells near it, to the particles in these.
//
// Bounds are computed in the predicate's own form, (edge - x) + shift, and rounding is monotonic, so they lose no
// neighbour; only the edges of cells are rounded differently from what is in them, for which there is `slack`.

#pragma once

#include "grid.cuh"

#define WARPS_PER_BLOCK 4

// Rows that a warp has found but not looked through; more than are found at a time, so that few chunks are partial.
#define ROWS 96

// Candidates that wait for a full chunk.
#define QUEUE (2 * WARP)

// Relative margin of half-lengths: roundings of a few ulp of the squared range.
#define RANGE_MARGIN 1.000002f

// Clusters whose surroundings are this many times those of one particle are searched one particle at a time: those
// with a stray particle, which would meet all particles between.
#define SPREAD_LIMIT 64.0f

// What a warp keeps in shared memory.
struct Scratch {
    u32 end[ROWS];    // candidates in this row and those before
    u32 offset[ROWS]; // from number of candidate to slot
    u32 image[ROWS];
    u32 queue_slot[QUEUE], queue_image[QUEUE];
};

struct Bounds {
    float lo[3], hi[3];
};

__device__ inline Bounds point_bounds(const float4& p) {
    return {{p.x, p.y, p.z}, {p.x, p.y, p.z}};
}

// NaN is left out.
__device__ inline Bounds cluster_bounds(const float4 (&x)[CLUSTER]) {
    Bounds b = point_bounds(x[0]);
#pragma unroll
    for (u32 k = 1; k < CLUSTER; ++k) {
        b.lo[0] = fminf(b.lo[0], x[k].x), b.hi[0] = fmaxf(b.hi[0], x[k].x);
        b.lo[1] = fminf(b.lo[1], x[k].y), b.hi[1] = fmaxf(b.hi[1], x[k].y);
        b.lo[2] = fminf(b.lo[2], x[k].z), b.hi[2] = fmaxf(b.hi[2], x[k].z);
    }
    return b;
}

// Distance along an axis from a box to an interval that is shifted.
__device__ inline float gap(const Bounds& box, int axis, float lo, float hi, float shift) {
    return fmaxf(fmaxf((lo - box.hi[axis]) + shift, (box.lo[axis] - hi) - shift), 0.0f);
}

// A bit for each lane before this one.
__device__ inline u32 lanes_below() {
#ifdef __CUDA_ARCH__
    u32 mask;
    asm("mov.u32 %0, %%lanemask_lt;" : "=r"(mask));
    return mask;
#else
    return (1u << (threadIdx.x % WARP)) - 1;
#endif
}

// Square root to one ulp.
__device__ inline float approximate_root(float x) {
#ifdef __CUDA_ARCH__
    float y;
    asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
    return y;
#else
    return sqrtf(x);
#endif
}

// Bit `c` for each periodic image c that may hold neighbours: home, and images of which a face is within range.
// Coordinates along periodic axes are within the box.
__device__ inline u32 reachable_images(const Box3& space, const Bounds& box, float range) {
    u32 codes[3];
    for (int axis = 0; axis < 3; ++axis) {
        codes[axis] = 2;
        if (space.boundary[axis] == 0) {
            if (box.lo[axis] - space.lo[axis] < range) codes[axis] |= 1;
            if (space.hi[axis] - box.hi[axis] < range) codes[axis] |= 4;
        }
    }
    // Nearly always.
    if ((codes[0] | codes[1] | codes[2]) == 2) return 1u << HOME_IMAGE;
    u32 reach = 1;
    for (int axis = 2; axis >= 0; --axis) {
        // One more digit in base 3 below those so far: each image becomes three.
        u32 longer = 0;
        for (u32 c = 0; c < 9; ++c) longer |= (reach >> c & 1) * codes[axis] << 3 * c;
        reach = longer;
    }
    return reach;
}

// The rows of one class that may hold neighbours, 32 at a time.
struct RowSearch {
    const CellClass& cells;
    const u32* cell_start;
    const Box3& space;
    const Bounds& box;
    float range, slack;
    u32 least; // slots before are left out

    // Of the image that is being searched.
    u32 image, first_y, first_z, n_y, next, count;
    u32 y, z; // this lane's next row, from the first
    Shift shift;

    __device__ void start_image(u32 code) {
        image = code;
        shift = shift_of(space, code);
        const float reach = range + slack;
        first_y = cell_coordinate(cells, 1, box.lo[1] - reach - shift.y);
        first_z = cell_coordinate(cells, 2, box.lo[2] - reach - shift.z);
        n_y = cell_coordinate(cells, 1, box.hi[1] + reach - shift.y) + 1 - first_y;
        count = n_y * (cell_coordinate(cells, 2, box.hi[2] + reach - shift.z) + 1 - first_z);
        next = 0;
        y = threadIdx.x % WARP;
        z = 0;
        carry(y, z);
    }

    // Takes whole planes out of `y`, up to 32, rather than by a division: halves between quotients absorb rounding.
    __device__ void carry(u32& y, u32& z) const {
        const u32 planes = (u32)(((float)y + 0.5f) * reciprocal((float)n_y));
        y -= planes * n_y;
        z += planes;
    }

    // Distance along y or z from the box to row or plane `k`.
    __device__ float gap_to(int axis, u32 k, float s) const {
        const float lo = k == 0 ? -infinity() : cells.lo[axis] + (float)k * cells.width[axis] - slack;
        const float hi =
            k + 1 == cells.n[axis] ? infinity() : cells.lo[axis] + (float)(k + 1) * cells.width[axis] + slack;
        return gap(box, axis, lo, hi, s);
    }

    // This lane's row: slots from `start` to `end`.
    __device__ void next_row(u32& start, u32& end) {
        const bool beyond = next + threadIdx.x % WARP >= count;
        const u32 row_y = first_y + y, row_z = first_z + z;
        next += WARP;
        if (next < count) {
            u32 step_y = WARP, step_z = 0;
            carry(step_y, step_z);
            y += step_y;
            z += step_z;
            if (y >= n_y) y -= n_y, ++z;
        }
        start = end = 0;
        if (beyond) return;
        const float dy = gap_to(1, row_y, shift.y), dz = gap_to(2, row_z, shift.z);
        const float rest = range * range * RANGE_MARGIN - (dy * dy + dz * dz);
        if (!(rest >= 0.0f)) return;
        const float half = approximate_root(rest) * RANGE_MARGIN + slack;
        const u32 x0 = cell_coordinate(cells, 0, box.lo[0] - half - shift.x);
        const u32 x1 = cell_coordinate(cells, 0, box.hi[0] + half - shift.x);
        const u32 first = first_of_cells(cells, row_number(cells, row_y, row_z), x0, x1);
        start = larger(cell_start[first], least);
        end = larger(cell_start[first + (x1 - x0) + 1], start);
    }
};

// What waits in shared memory: rows, the candidates in them, and candidates in the queue.
struct Pending {
    u32 rows, candidates, queued;
};

// Appends the lanes' rows to those that wait.
__device__ inline void append_rows(Scratch& scratch, Pending& pending, u32 start, u32 end, u32 image) {
    const u32 length = end - start, used = __ballot_sync(ALL_LANES, length != 0);
    u32 sum = length;
    for (u32 step = 1; step < WARP; step *= 2) {
        const u32 before = __shfl_up_sync(ALL_LANES, sum, step);
        if (threadIdx.x % WARP >= step) sum += before;
    }
    if (length != 0) {
        const u32 row = pending.rows + __popc(used & lanes_below());
        scratch.end[row] = pending.candidates + sum;
        scratch.offset[row] = start - (pending.candidates + sum - length);
        scratch.image[row] = image;
    }
    pending.rows += __popc(used);
    pending.candidates += __shfl_sync(ALL_LANES, sum, WARP - 1);
}

// What a lane meets.
struct Candidate {
    u32 slot, image;
    bool valid;
    float4 x;
};

// Candidate `t` of `total`, the last instead of those after, whose row is found from that of an earlier one on.
template <class V>
__device__ inline Candidate candidate(const Scratch& scratch, u32 t, u32 total, u32& row, const V& v) {
    const u32 at = smaller(t, total - 1);
    while (scratch.end[row] <= at) ++row;
    const u32 slot = at + scratch.offset[row];
    return {slot, scratch.image[row], t < total, v.slots[slot]};
}

// Takes the candidates of the waiting rows 32 at a time to `v.meet(candidate)`. To load the next ahead gained nothing.
template <class V> __device__ inline void walk_rows(const Scratch& scratch, u32 total, V& v) {
    u32 row = 0;
    for (u32 base = 0; base < total; base += WARP) v.meet(candidate(scratch, base + threadIdx.x % WARP, total, row, v));
}

// The same, but only those within their own radius or `v.radius` of the box are met. Those that do not fill a chunk
// wait in the queue until `finish`.
template <class V>
__device__ inline void walk_rows_within(Scratch& scratch, Pending& pending, bool finish, const Box3& space,
                                        const Bounds& box, V& v) {
    const u32 lane = threadIdx.x % WARP, total = pending.candidates;
    u32 row = 0, queued = pending.queued;
    for (u32 base = 0; base < total || (finish && queued > 0); base += WARP) {
        if (base < total) {
            const Candidate found = candidate(scratch, base + lane, total, row, v);
            const float4 p = found.x;
            Shift s = {0.0f, 0.0f, 0.0f};
            if (found.image != HOME_IMAGE) s = shift_of(space, found.image);
            const float range = fmaxf(v.radius, v.radius_of(p));
            const float r2 =
                squared_length(gap(box, 0, p.x, p.x, s.x), gap(box, 1, p.y, p.y, s.y), gap(box, 2, p.z, p.z, s.z));
            const bool near = found.valid && r2 < range * range;
            const u32 votes = __ballot_sync(ALL_LANES, near);
            if (near) {
                const u32 place = queued + __popc(votes & lanes_below());
                scratch.queue_slot[place] = found.slot;
                scratch.queue_image[place] = found.image;
            }
            queued += __popc(votes);
            __syncwarp();
        }
        if (queued >= WARP || (finish && base >= total)) {
            const u32 taken = smaller(queued, (u32)WARP);
            queued -= taken;
            const u32 place = queued + smaller(lane, taken - 1);
            const u32 slot = scratch.queue_slot[place];
            v.meet({slot, scratch.queue_image[place], lane < taken, v.slots[slot]});
            __syncwarp();
        }
    }
    pending.queued = queued;
}

// Candidates of one class for the particles in a box. Some may wait for those of other classes until `finish`.
template <bool WITHIN, class V>
__device__ inline void search_class(RowSearch search, Scratch& scratch, Pending& pending, bool finish, V& v) {
    u32 images = reachable_images(search.space, search.box, search.range + search.slack);
    search.next = search.count = 0;
    // There is one call to walk rows, because its code is long: when enough rows wait or nothing is left to search.
    for (bool last = false; !last;) {
        if (search.next >= search.count && images != 0) {
            search.start_image(__ffs(images) - 1);
            images &= images - 1;
        }
        if (search.next < search.count) {
            u32 start, end;
            search.next_row(start, end);
            append_rows(scratch, pending, start, end, search.image);
        }
        last = search.next >= search.count && images == 0;
        if ((last && finish) || pending.rows > ROWS - WARP) {
            __syncwarp();
            if (WITHIN) {
                walk_rows_within(scratch, pending, last && finish, search.space, search.box, v);
            } else {
                walk_rows(scratch, pending.candidates, v);
            }
            __syncwarp();
            pending.rows = pending.candidates = 0;
        }
    }
}

// Whether the surroundings of a box are much larger than those of one particle.
__device__ inline bool is_spread(const Bounds& box, const CellClass& cells, float range) {
    float surroundings = 1.0f;
    for (int axis = 0; axis < 3; ++axis) {
        const float around = 2.0f * range + cells.width[axis];
        surroundings *= 1.0f + (box.hi[axis] - box.lo[axis]) * reciprocal(around);
    }
    return surroundings > SPREAD_LIMIT;
}

// Candidates for the particles of a cluster: of its own class, and of those of larger radii, so that pairs of two
// classes are met once, from the smaller. Slots before `v.least` are left out. Tells `v` which of its particles are
// searched for and whether pairs are met once. Without WITHIN, there is one class.
template <bool WITHIN, class V>
__device__ inline void search_cells(const Grid& grid, const Box3& space, float slack, const ClusterPlace& cluster,
                                    const Bounds& box, Scratch& scratch, V& v) {
    Pending pending = {0, 0, 0};
    bool apart = false;
    const u32 own = WITHIN ? cluster.of_class : 0, n_classes = WITHIN ? grid.n_classes : 1;
    for (u32 k = own; k < n_classes; ++k) {
        const CellClass& cells = grid.classes[k];
        v.once = k > own;
        // The ranges of all larger classes are at least that of the next.
        if (k <= own + 1) apart = is_spread(box, cells, cells.largest);
        const bool finish = apart || !v.once || k + 1 == n_classes;
        for (u32 part = 0; part < (apart ? cluster.count : 1); ++part) {
            v.active = apart ? 1u << part : (1u << cluster.count) - 1;
            const Bounds part_box = apart ? point_bounds(grid.slot[cluster.first + part]) : box;
            const RowSearch search = {cells, grid.cell_start, space, part_box, cells.largest, slack, v.least};
            search_class<WITHIN>(search, scratch, pending, finish, v);
        }
    }
}

// The cluster of a warp, of any class or, without WITHIN, of the only one.
template <bool WITHIN> __device__ inline ClusterPlace own_cluster(const Grid& grid, u32 n) {
    const u32 number = thread_index() / WARP;
    return WITHIN ? find_cluster(grid, n, number) : consecutive_cluster(n, number);
}

// Takes all particles 32 at a time to `v.meet`.
template <class V> __device__ inline void meet_all(u32 n, V& v) {
    for (u32 base = 0; base < n; base += WARP) {
        const u32 slot = base + threadIdx.x % WARP;
        const bool valid = slot < n;
        v.meet({valid ? slot : 0, HOME_IMAGE, valid, v.slots[valid ? slot : 0]});
    }
}
