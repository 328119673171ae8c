// Forces on the particles of a warp, and on its candidates where a pair is met only from one side.

#pragma once

#include "cluster.cuh"
#include "law.cuh"
#include "sums.cuh"

// How a law is evaluated.
template <class L> struct Traits {
    static const bool ONE_RANGE = false; // one cutoff for all pairs
    static const bool COSTLY = false;    // too long to be written out for each particle of a cluster
};

template <> struct Traits<UniformLennardJones> {
    static const bool ONE_RANGE = true;
    static const bool COSTLY = false;
};

template <> struct Traits<AnyLaw> {
    static const bool ONE_RANGE = false;
    static const bool COSTLY = true;
};

// Which candidates a cluster meets, and at which image.
enum Meetings {
    DIRECTED, // all in its own class, and those of larger classes
    ONCE,     // those from its own first slot on, so that each pair is met once but within a cluster
    NO_IMAGE, // all, without knowing their images
};

template <class L, bool EXACT, bool ENERGY, Meetings MEETINGS> struct Gather : Cluster {
    const GatherArgs& a;
    u32 count;
    u32 kind[CLUSTER];
    Sums<EXACT, ENERGY> sums[CLUSTER];

    __device__ Gather(const GatherArgs& arguments, const ClusterPlace& place) : a(arguments) {
        load(a.law, a.grid.slot, place);
        count = place.count;
        if (MEETINGS == ONCE) least = first;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            kind[k] = kind_of(first + smaller(k, place.count - 1));
            sums[k] = zero_sums<Sums<EXACT, ENERGY>>();
        }
    }

    __device__ u32 kind_of(u32 slot) const {
        if (!L::TYPED || a.law.n_types == 1) return 0;
        return __float_as_uint(a.velocity[place_of(a.grid, slot)].w);
    }

    // One candidate in each lane. Chunks that need no care are most of them.
    __device__ void meet(u32 slot, bool valid, u32 image) {
        const float4 xj = slots[slot];
        if (MEETINGS == NO_IMAGE) {
            pairs<NEAREST, true>(slot, xj, valid, image);
        } else if (Traits<L>::COSTLY) {
            pairs<SHIFTED, true>(slot, xj, valid, image);
        } else if (is_partial() || __any_sync(ALL_LANES, valid && slot - first < CLUSTER)) {
            pairs<SHIFTED, true>(slot, xj, valid, image);
        } else if (__any_sync(ALL_LANES, valid && image != HOME_IMAGE)) {
            pairs<SHIFTED, false>(slot, xj, valid, image);
        } else {
            pairs<HOME, false>(slot, xj, valid, image);
        }
    }

    // CARE: some particles may not be active, and candidates may be the particles themselves.
    template <Images IMAGES, bool CARE>
    __device__ void pairs(u32 slot, const float4& xj, bool valid, u32 image) {
        const u32 kind_j = kind_of(slot);
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (IMAGES == SHIFTED && image != HOME_IMAGE) shift = shift_of(a.space, image);
        const u32 own = IMAGES == SHIFTED && image != HOME_IMAGE ? (u32)CLUSTER : slot - first;
        // Pairs within a cluster are met from both sides, at whichever image.
        const bool both = MEETINGS == ONCE ? !CARE || slot - first >= count : !Traits<L>::ONE_RANGE && once;
        Sums<EXACT, ENERGY> other = zero_sums<Sums<EXACT, ENERGY>>();
        bool any = false;
#pragma unroll(Traits<L>::COSTLY ? 1 : CLUSTER)
        for (u32 k = 0; k < CLUSTER; ++k) {
            if (CARE && !(active >> k & 1)) continue;
            const Shift d = separation<IMAGES>(a.space, x[k], xj, shift, image);
            const float r2 = squared_length(d.x, d.y, d.z);
            const float range = Traits<L>::ONE_RANGE ? a.law.cutoff : fmaxf(radius_of(x[k]), radius_of(xj));
            bool in = valid && r2 < range * range;
            if (CARE) in = in && own != k;
            if (Traits<L>::COSTLY && !in) continue;
            const PairForce pair = L::template evaluate<ENERGY>(a.law, r2, range, kind[k], kind_j);
            const float f = in ? pair.f_over_r : 0.0f;
            sums[k].add(a.law, d.x, d.y, d.z, f, pair.energy, r2);
            if (MEETINGS == ONCE || both) {
                other.add(a.law, -d.x, -d.y, -d.z, f, pair.energy, r2);
                any = any || in;
            }
        }
        // Cheaper than to keep account of pairs in range.
        if (MEETINGS == ONCE && !ENERGY) any = other.x != 0 || other.y != 0 || other.z != 0;
        if (both && any) scatter_sums(a.results, a.law, a.n, place_of(a.grid, slot), other);
    }

    __device__ void store() {
        Sums<EXACT, ENERGY> total = zero_sums<Sums<EXACT, ENERGY>>();
        total.x = sum(&Sums<EXACT, ENERGY>::x);
        total.y = sum(&Sums<EXACT, ENERGY>::y);
        total.z = sum(&Sums<EXACT, ENERGY>::z);
        if (ENERGY) {
            total.energy = sum(&Sums<EXACT, ENERGY>::energy);
            total.virial = sum(&Sums<EXACT, ENERGY>::virial);
            total.neighbors = sum(&Sums<EXACT, ENERGY>::neighbors);
        }
        const u32 lane = threadIdx.x % WARP, k = lane / 4;
        if (lane % 4 != 0 || k >= count) return;
        const u32 place = place_of(a.grid, first + k);
        if (MEETINGS == ONCE || (MEETINGS == DIRECTED && a.grid.n_classes > 1)) {
            scatter_sums(a.results, a.law, a.n, place, total);
        } else {
            store_sums(a.results, a.law, a.n, place, total);
        }
    }

    template <class T> __device__ T sum(T Sums<EXACT, ENERGY>::*member) {
        T v[CLUSTER];
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) v[k] = sums[k].*member;
        return sum_transposed(v);
    }
};

// Forces on the particles of a warp from candidates in cells.
template <class L, bool EXACT, bool ENERGY, Meetings MEETINGS> __device__ inline void forces_by_cells(const GatherArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = find_cluster(a.grid, a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    Gather<L, EXACT, ENERGY, MEETINGS> gather(a, cluster);
    search_cells<!Traits<L>::ONE_RANGE>(a.grid, a.space, a.slack, cluster, cluster_bounds(gather.x),
                                        scratch[threadIdx.x / WARP], gather);
    gather.store();
}
