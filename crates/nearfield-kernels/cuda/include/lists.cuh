// Neighbour lists: rows by input index, first counted, then filled.

#pragma once

#include "cluster.cuh"

// What counting and filling share. A pair of one class is met from both sides and each side writes its own row; a pair
// of two classes is met once, from the smaller, which writes both.
template <class D, bool BRUTE> struct Lister : Cluster {
    const ListArgs& a;
    u32 id[CLUSTER];

    __device__ Lister(const ListArgs& arguments, const ClusterPlace& place) : a(arguments) {
        load(a.law, a.grid.slot, place);
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) id[k] = a.id[place_of(a.grid, first + smaller(k, place.count - 1))];
    }

    // Whether rows are written by one warp only.
    __device__ bool owns_rows() const {
        return BRUTE || a.grid.n_classes == 1;
    }

    __device__ void meet(u32 slot, bool valid, u32 image) {
        if (BRUTE) {
            pairs<NEAREST>(slot, valid, image);
        } else if (__any_sync(ALL_LANES, image != HOME_IMAGE)) {
            pairs<SHIFTED>(slot, valid, image);
        } else {
            pairs<HOME>(slot, valid, image);
        }
    }

    template <Images IMAGES> __device__ void pairs(u32 slot, bool valid, u32 image) {
        const float4 xj = slots[slot];
        const u32 id_j = a.id[place_of(a.grid, slot)];
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && image != HOME_IMAGE) shift = shift_of(a.space, image);
        const u32 own = IMAGES == SHIFTED && image != HOME_IMAGE ? (u32)CLUSTER : slot - first;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            const Shift d = separation<IMAGES>(a.space, x[k], xj, shift, image);
            const float range = fmaxf(radius_of(x[k]), radius_of(xj));
            const bool in = valid && squared_length(d.x, d.y, d.z) < range * range && own != k && (active >> k & 1);
            static_cast<D*>(this)->mine(k, in && (!a.half || id[k] < id_j), id_j, image);
            const bool listed_there = in && once && (!a.half || id_j < id[k]);
            if (listed_there) static_cast<D*>(this)->theirs(id_j, id[k], 2 * HOME_IMAGE - image);
        }
    }
};

template <bool BRUTE> struct ListCount : Lister<ListCount<BRUTE>, BRUTE> {
    u32 count[CLUSTER];

    __device__ ListCount(const ListArgs& arguments, const ClusterPlace& place)
        : Lister<ListCount<BRUTE>, BRUTE>(arguments, place) {
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
        const u32 total = sum_transposed(count), lane = threadIdx.x % WARP, k = lane / 4;
        if (lane % 4 != 0 || k >= place.count) return;
        u32* row = this->a.count + this->a.id[place_of(this->a.grid, this->first + k)];
        if (this->owns_rows()) {
            *row = total;
        } else {
            atomicAdd(row, total);
        }
    }
};

template <bool BRUTE> struct ListFill : Lister<ListFill<BRUTE>, BRUTE> {
    u64 next[CLUSTER]; // where the row goes on, if this warp owns it

    __device__ ListFill(const ListArgs& arguments, const ClusterPlace& place)
        : Lister<ListFill<BRUTE>, BRUTE>(arguments, place) {
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) next[k] = this->a.offset[this->id[k]];
    }

    __device__ void mine(u32 k, bool in, u32 id_j, u32 image) {
        const u32 votes = __ballot_sync(ALL_LANES, in);
        if (votes == 0) return;
        const u32 rank = __popc(votes & lanes_below());
        u64 start = next[k];
        if (this->owns_rows()) {
            next[k] += __popc(votes);
        } else {
            start += reserve(this->id[k], votes);
        }
        if (in) put(start + rank, id_j, image);
    }

    __device__ void theirs(u32 id_j, u32 id_i, u32 image) {
        put(this->a.offset[id_j] + (atomicSub(this->a.count + id_j, 1u) - 1), id_i, image);
    }

    // Rows are complete already.
    __device__ void store(const ClusterPlace&) {}

    // Rows that several warps write are filled from their ends.
    __device__ u32 reserve(u32 row, u32 votes) {
        const u32 n = __popc(votes);
        u32 left = 0;
        if (threadIdx.x % WARP == 0) left = atomicSub(this->a.count + row, n);
        return __shfl_sync(ALL_LANES, left, 0) - n;
    }

    __device__ void put(u64 entry, u32 id, u32 image) {
        this->a.index[entry] = id;
        if (this->a.image) this->a.image[entry] = (u8)image;
    }
};
