// The particles of a warp, the same in all lanes, and their separation from the one candidate of each lane.

#pragma once

#include "pencils.cuh"

// Which periodic image of a candidate a pair is tested at.
enum Images {
    HOME,    // none but home
    SHIFTED, // that of the candidate
    NEAREST, // the nearest, which is the only one that can be in range, as ranges are at most half a period
};

struct Cluster {
    float4 x[CLUSTER];
    u32 first;
    u32 least;  // slots before are not searched for
    u32 active; // bit k: neighbours of particle k are searched for
    bool once;  // pairs are met only from this side

    const float4* slots;
    float radius; // the largest
    float cutoff; // of all; negative where radii are per particle

    __device__ void load(const Law& law, const float4* all, const ClusterPlace& place) {
        slots = all;
        first = place.first;
        cutoff = law.variable ? -1.0f : law.cutoff;
        radius = 0.0f;
        least = 0;
        active = (1u << place.count) - 1;
        once = false;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            // The last one again where there are fewer: it is never active.
            x[k] = slots[first + smaller(k, place.count - 1)];
            radius = fmaxf(radius, radius_of(x[k]));
        }
    }

    __device__ float radius_of(const float4& p) const {
        return cutoff < 0.0f ? p.w : cutoff;
    }

    __device__ bool is_partial() const {
        return active != (1u << CLUSTER) - 1;
    }
};

// What takes a distance along an axis to that of the nearest image: half a period away, both images are out of range.
__device__ inline float to_nearest(const Box3& space, int axis, float d) {
    const float length = space.length[axis], half = space.boundary[axis] == 0 ? 0.5f * length : infinity();
    return fabsf(d) > half ? -copysignf(length, d) : 0.0f;
}

template <Images IMAGES>
__device__ inline Shift separation(const Box3& space, const float4& xi, const float4& xj, const Shift& shift) {
    const Shift d = {xj.x - xi.x, xj.y - xi.y, xj.z - xi.z};
    if (IMAGES == HOME) return d;
    if (IMAGES == SHIFTED) return {d.x + shift.x, d.y + shift.y, d.z + shift.z};
    return {d.x + to_nearest(space, 0, d.x), d.y + to_nearest(space, 1, d.y), d.z + to_nearest(space, 2, d.z)};
}

__device__ inline u32 image_code(float shift) {
    return shift < 0.0f ? 0 : shift > 0.0f ? 2 : 1;
}

// Image at which a candidate is nearest.
__device__ inline u32 nearest_image(const Box3& space, const float4& xi, const float4& xj) {
    return image_code(to_nearest(space, 0, xj.x - xi.x)) + 3 * image_code(to_nearest(space, 1, xj.y - xi.y)) +
           9 * image_code(to_nearest(space, 2, xj.z - xi.z));
}

// Sums of `v[k]` over the lanes of a warp, in lane 4 k and the three after it: half the values are passed on at a time.
template <class T> __device__ inline T sum_transposed(T (&v)[CLUSTER]) {
    const u32 lane = threadIdx.x % WARP;
#pragma unroll
    for (u32 n = CLUSTER / 2; n > 0; n /= 2) {
        const bool upper = (lane & 4 * n) != 0;
#pragma unroll
        for (u32 k = 0; k < n; ++k) {
            const T kept = upper ? v[k + n] : v[k], passed = upper ? v[k] : v[k + n];
            v[k] = kept + __shfl_xor_sync(ALL_LANES, passed, 4 * n);
        }
    }
    T sum = v[0] + __shfl_xor_sync(ALL_LANES, v[0], 2);
    return sum + __shfl_xor_sync(ALL_LANES, sum, 1);
}
