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
        id = a.id[first + smaller(threadIdx.x % WARP, place.count - 1)];
    }

    // Whether rows are written by one warp only.
    __device__ bool owns_rows() const {
        return BRUTE || !VARIABLE || a.grid.n_classes == 1;
    }

    // Chunks that need no care are most of them.
    __device__ void meet(const Candidate& c) {
        if (BRUTE) {
            pairs<NEAREST, true>(c);
        } else if (a.half || __any_sync(ALL_LANES, c.valid && (c.image != HOME_IMAGE || c.slot - first < CLUSTER)) ||
                   is_partial()) {
            pairs<SHIFTED, true>(c);
        } else {
            pairs<HOME, false>(c);
        }
    }

    // CARE: some particles may not be active, candidates may be the particles themselves, or lists are half.
    template <Images IMAGES, bool CARE> __device__ void pairs(const Candidate& c) {
        const bool half = CARE && a.half;
        const u32 id_j = D::FILLS || VARIABLE || half ? a.id[c.slot] : 0;
        u32 image = c.image;
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && image != HOME_IMAGE) shift = shift_of(a.space, image);
        const u32 own = IMAGES == SHIFTED && image != HOME_IMAGE ? (u32)CLUSTER : c.slot - first;
        const u32 allowed = own < CLUSTER ? active & ~(1u << own) : active;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            const Shift d = separation<IMAGES>(a.space, x[k], c.x, shift);
            if (IMAGES == NEAREST) image = nearest_image(a.space, x[k], c.x);
            const float range = VARIABLE ? fmaxf(x[k].w, c.x.w) : cutoff;
            // Without short circuits, which would be branches.
            bool in = c.valid & (squared_length(d.x, d.y, d.z) < range * range);
            if (CARE) in = in & ((allowed >> k & 1) != 0);
            bool here = in;
            if (half || (VARIABLE && once)) {
                const u32 id_i = __shfl_sync(ALL_LANES, id, k);
                here = in && (!half || id_i < id_j);
                if (VARIABLE && once && in && (!half || id_j < id_i)) {
                    static_cast<D*>(this)->theirs(id_j, id_i, 2 * HOME_IMAGE - image);
                }
            }
            static_cast<D*>(this)->mine(k, here, id_j, image);
        }
    }
};

template <class D> using CellLister = Lister<D, false, false>;
template <class D> using CellListerOfRadii = Lister<D, false, true>;
template <class D> using BruteLister = Lister<D, true, false>;
template <class D> using BruteListerOfRadii = Lister<D, true, true>;

template <template <class> class Base> struct ListCount : Base<ListCount<Base>> {
    static const bool FILLS = false;

    u32 count[CLUSTER];

    template <class A>
    __device__ ListCount(const A& arguments, const ClusterPlace& place) : Base<ListCount>(arguments, place) {
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) count[k] = 0;
    }

    __device__ void mine(u32 k, bool in, u32, u32) {
        if (in) ++count[k];
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

template <template <class> class Base> struct ListFill : Base<ListFill<Base>> {
    static const bool FILLS = true;

    u32* next[CLUSTER]; // where the row of particle k goes on

    template <class A>
    __device__ ListFill(const A& arguments, const ClusterPlace& place) : Base<ListFill>(arguments, place) {
        const u64 start = this->a.offset[this->id];
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) next[k] = this->a.index + __shfl_sync(ALL_LANES, start, k);
    }

    __device__ void mine(u32 k, bool in, u32 id_j, u32 image) {
        const u32 votes = __ballot_sync(ALL_LANES, in), n = __popc(votes), rank = __popc(votes & lanes_below());
        if (this->owns_rows()) {
            if (in) put(next[k] + rank, id_j, image);
            next[k] += n;
        } else if (votes != 0) {
            // Rows that several warps write are filled from their ends.
            u32 left = 0;
            if (threadIdx.x % WARP == k) left = atomicSub(this->a.count + this->id, n) - n;
            left = __shfl_sync(ALL_LANES, left, k);
            if (in) put(next[k] + left + rank, id_j, image);
        }
    }

    __device__ void theirs(u32 id_j, u32 id_i, u32 image) {
        put(this->a.index + this->a.offset[id_j] + (atomicSub(this->a.count + id_j, 1u) - 1), id_i, image);
    }

    __device__ void put(u32* entry, u32 neighbor, u32 image) {
        *entry = neighbor;
        if (this->a.image) this->a.image[entry - this->a.index] = (u8)image;
    }

    // Rows are complete already.
    __device__ void store(const ClusterPlace&) {}
};
