// Rays, for tests of the emulator.

#include "raytracing.cuh"

struct RaysArgs {
    float4* points;
    u32* counts;
    u64* sums;
    u64 handle;
};

PARAMETERS(RaysArgs)

RAYGEN(points) {
    const u32 i = rt::ray_index();
    const float4 x = params.points[i];
    u32 p[rt::PAYLOAD_WORDS] = {};
    rt::trace_point(params.handle, x.x, x.y, x.z, p);
    params.counts[i] = p[0];
    params.sums[i] = (u64)p[2] << 32 | p[1];
}

// Counts boxes and sums their numbers and those of their instances.
INTERSECTION(boxes) {
    rt::set_payload<0>(rt::payload<0>() + 1);
    rt::set_payload<1>(rt::payload<1>() + rt::primitive_index());
    rt::set_payload<2>(rt::payload<2>() + rt::instance_index());
}

// Along x, as long as the points' fourth number says.
RAYGEN(segments) {
    const u32 i = rt::ray_index();
    const float4 x = params.points[i];
    u32 p[2] = {};
    rt::trace(params.handle, x.x, x.y, x.z, 1.0f, 0.0f, 0.0f, x.w, p);
    params.counts[i] = p[0];
    params.sums[i] = p[1];
}

// Counts crossings and keeps the distance of the last.
ANYHIT(crossings) {
    rt::set_payload<0>(rt::payload<0>() + 1);
    rt::set_payload<1>(__float_as_uint(rt::hit_distance()));
    rt::ignore_hit();
}

RAYGEN(cooperating) {
    params.counts[rt::ray_index()] = __ballot_sync(ALL_LANES, 1);
}

MISS(nothing) {}
