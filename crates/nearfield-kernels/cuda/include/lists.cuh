// Neighbour lists: rows by input index, first counted, then filled.

#pragma once

#include "cluster.cuh"

// What counting and filling share. A pair of one class is met from both sides and each side writes its own row; a pair
// of two classes is met once, from the smaller, which writes both.
template <class D, bool BRUTE, bool VARIABLE> struct Lister : Cluster {
    const ListArgs& a;
    u32 id; // lane k: input index of particle k

    __device__ Lister(const ListArgs& arguments, const ClusterPlace& place) : a(arguments) {
        load(a.law, a.grid.slot, place);
        id = a.id[place_of(a.grid, first + smaller(threadIdx.x % WARP, place.count - 1))];
    }

    // Whether rows are written by one warp only.
    __device__ bool owns_rows() const {
        return BRUTE || !VARIABLE || a.grid.n_classes == 1;
    }

    __device__ void meet(u32 slot, bool valid, u32 image) {
        if (BRUTE) {
            pairs<NEAREST, true>(slot, valid, image);
        } else if (__any_sync(ALL_LANES, valid && (image != HOME_IMAGE || slot - first < CLUSTER)) || is_partial()) {
            pairs<SHIFTED, true>(slot, valid, image);
        } else {
            pairs<HOME, false>(slot, valid, image);
        }
    }

    // CARE: some particles may not be active, and candidates may be the particles themselves.
    template <Images IMAGES, bool CARE> __device__ void pairs(u32 slot, bool valid, u32 image) {
        const float4 xj = slots[slot];
        const u32 id_j = a.id[place_of(a.grid, slot)];
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && image != HOME_IMAGE) shift = shift_of(a.space, image);
        const u32 own = IMAGES == SHIFTED && image != HOME_IMAGE ? (u32)CLUSTER : slot - first;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            if (CARE && !(active >> k & 1)) continue;
            const Shift d = separation<IMAGES>(a.space, x[k], xj, shift, image);
            const float range = VARIABLE ? fmaxf(x[k].w, xj.w) : cutoff;
            bool in = valid && squared_length(d.x, d.y, d.z) < range * range;
            if (CARE) in = in && own != k;
            bool here = in;
            if (a.half || (VARIABLE && once)) {
                const u32 id_i = __shfl_sync(ALL_LANES, id, k);
                here = in && (!a.half || id_i < id_j);
                if (VARIABLE && once && in && (!a.half || id_j < id_i)) {
                    static_cast<D*>(this)->theirs(id_j, id_i, 2 * HOME_IMAGE - image);
                }
            }
            static_cast<D*>(this)->mine(k, here, id_j, image);
        }
    }
};

template <bool BRUTE, bool VARIABLE>
struct ListCount : Lister<ListCount<BRUTE, VARIABLE>, BRUTE, VARIABLE> {
    u32 count[CLUSTER];

    __device__ ListCount(const ListArgs& arguments, const ClusterPlace& place)
        : Lister<ListCount, BRUTE, VARIABLE>(arguments, place) {
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) count[k] = 0;
    }

    __device__ void mine(u32 k, bool in, u32, u32) {
        count[k] += in ? 1 : 0;
    }

    __device__ void theirs(u32 id_j, u32, u32) {
        atomicAdd(this->a.count + id_j, 1u);
    }

    __device__ void store(const ClusterPlace& place) {
        const u32 lane = threadIdx.x % WARP, k = lane / 4;
        const u32 total = sum_transposed(count), row = __shfl_sync(ALL_LANES, this->id, k);
        if (lane % 4 != 0 || k >= place.count) return;
        if (this->owns_rows()) {
            this->a.count[row] = total;
        } else {
            atomicAdd(this->a.count + row, total);
        }
    }
};

template <bool BRUTE, bool VARIABLE>
struct ListFill : Lister<ListFill<BRUTE, VARIABLE>, BRUTE, VARIABLE> {
    u64 next; // lane k: where the row of particle k goes on

    __device__ ListFill(const ListArgs& arguments, const ClusterPlace& place)
        : Lister<ListFill, BRUTE, VARIABLE>(arguments, place) {
        next = this->a.offset[this->id];
    }

    __device__ void mine(u32 k, bool in, u32 id_j, u32 image) {
        const u32 votes = __ballot_sync(ALL_LANES, in);
        if (votes == 0) return;
        const u32 lane = threadIdx.x % WARP, n = __popc(votes);
        u64 start = next;
        if (lane == k) {
            // Rows that several warps write are filled from their ends.
            if (this->owns_rows()) {
                next += n;
            } else {
                start += atomicSub(this->a.count + this->id, n) - n;
            }
        }
        start = __shfl_sync(ALL_LANES, start, k);
        if (in) put(start + __popc(votes & lanes_below()), id_j, image);
    }

    __device__ void theirs(u32 id_j, u32 id_i, u32 image) {
        put(this->a.offset[id_j] + (atomicSub(this->a.count + id_j, 1u) - 1), id_i, image);
    }

    __device__ void put(u64 entry, u32 neighbor, u32 image) {
        this->a.index[entry] = neighbor;
        if (this->a.image) this->a.image[entry] = (u8)image;
    }

    // Rows are complete already.
    __device__ void store(const ClusterPlace&) {}
};
