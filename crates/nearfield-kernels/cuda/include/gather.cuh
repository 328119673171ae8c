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
    DIRECTED,    // all in its own class, and those of larger classes
    ONCE,        // those from its own first slot on, so that each pair is met once but within a cluster
    NO_IMAGE,    // all, without knowing their images
    LISTED_ONCE, // as ONCE, without knowing their images
};

template <class L, bool EXACT, bool ENERGY, Meetings MEETINGS> struct Gather : Cluster {
    static const bool ALL_ONCE = MEETINGS == ONCE || MEETINGS == LISTED_ONCE;
    static const bool LISTED = MEETINGS == NO_IMAGE || MEETINGS == LISTED_ONCE;

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
        return __float_as_uint(a.velocity[place_of_slot(slot)].w);
    }

    // Particles that are listed are in the order of the cells.
    __device__ u32 place_of_slot(u32 slot) const {
        return LISTED ? slot : place_of(a.grid, slot);
    }

    // One candidate in each lane. Chunks that need no care are most of them.
    __device__ void meet(const Candidate& c) {
        if (MEETINGS == NO_IMAGE) {
            pairs<NEAREST, true>(c.slot, c.x, c.valid);
            return;
        }
        const bool home = c.image == HOME_IMAGE;
        Shift shift = {0.0f, 0.0f, 0.0f};
        if (!home) shift = shift_of(a.space, c.image);
        if (Traits<L>::COSTLY || is_partial() || __any_sync(ALL_LANES, c.valid && c.slot - first < CLUSTER)) {
            pairs<SHIFTED, true>(c.slot, c.x, c.valid, shift, home);
        } else if (__any_sync(ALL_LANES, c.valid && !home)) {
            pairs<SHIFTED, false>(c.slot, c.x, c.valid, shift, home);
        } else {
            pairs<HOME, false>(c.slot, c.x, c.valid);
        }
    }

    // Candidates of a list whose images are not known, but the same for all particles of the cluster.
    __device__ void care(u32 slot, const float4& xj, bool valid) {
        if (Traits<L>::COSTLY) {
            pairs<NEAREST, true>(slot, xj, valid);
        } else {
            const Shift d = {xj.x - x[0].x, xj.y - x[0].y, xj.z - x[0].z};
            const Shift shift = {to_nearest(a.space, 0, d.x), to_nearest(a.space, 1, d.y), to_nearest(a.space, 2, d.z)};
            pairs<SHIFTED, true>(slot, xj, valid, shift);
        }
    }

    // CARE: some particles may not be active, and candidates at `home` may be the particles themselves.
    template <Images IMAGES, bool CARE>
    __device__ void pairs(u32 slot, const float4& xj, bool valid, const Shift& shift = {0.0f, 0.0f, 0.0f},
                          bool home = true) {
        const u32 kind_j = kind_of(slot);
        const u32 own = home ? slot - first : (u32)CLUSTER;
        const u32 allowed = own < CLUSTER ? active & ~(1u << own) : active;
        // Pairs within a cluster are met from both sides, at whichever image.
        const bool both = ALL_ONCE ? !CARE || slot - first >= count : !Traits<L>::ONE_RANGE && once;
        Sums<EXACT, ENERGY> other = zero_sums<Sums<EXACT, ENERGY>>();
        bool any = false;
#pragma unroll(Traits<L>::COSTLY ? 1 : CLUSTER)
        for (u32 k = 0; k < CLUSTER; ++k) {
            if (CARE && !LISTED && !(active >> k & 1)) continue;
            const Shift d = separation<IMAGES>(a.space, x[k], xj, shift);
            const float r2 = squared_length(d.x, d.y, d.z);
            const float range = Traits<L>::ONE_RANGE ? a.law.cutoff : fmaxf(radius_of(x[k]), radius_of(xj));
            bool in = valid && r2 < range * range;
            if (CARE) in = in && (allowed >> k & 1);
            if (Traits<L>::COSTLY && !in) continue;
            const PairForce pair = L::template evaluate<ENERGY>(a.law, r2, range, kind[k], kind_j);
            const float f = in ? pair.f_over_r : 0.0f;
            sums[k].add(a.law, d.x, d.y, d.z, f, pair.energy, r2);
            if (ALL_ONCE || both) {
                other.add(a.law, -d.x, -d.y, -d.z, f, pair.energy, r2);
                any = any || in;
            }
        }
        // Cheaper than to keep account of pairs in range.
        if (ALL_ONCE && !ENERGY) any = other.x != 0 || other.y != 0 || other.z != 0;
        if (both && any) scatter_sums(a.results, a.law, a.n, place_of_slot(slot), other);
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
        const u32 place = place_of_slot(first + k);
        if (ALL_ONCE || (MEETINGS == DIRECTED && a.grid.n_classes > 1)) {
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
template <class L, bool EXACT, bool ENERGY, Meetings MEETINGS>
__device__ inline void forces_by_cells(const GatherArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const bool WITHIN = !Traits<L>::ONE_RANGE;
    const ClusterPlace cluster = own_cluster<WITHIN>(a.grid, a.n);
    if (cluster.count == 0) return;
    Gather<L, EXACT, ENERGY, MEETINGS> gather(a, cluster);
    search_cells<WITHIN>(a.grid, a.space, a.slack, cluster, cluster_bounds(gather.x),
                                        scratch[threadIdx.x / WARP], gather);
    gather.store();
}
