// rt-spheres: the three axis rays of a particle sum the forces on it.

#include "axis_rays.cuh"
#include "ray_gather.cuh"

PARAMETERS(ForceRays)

GATHER(GATHER_ANYHIT, AxisRays)
