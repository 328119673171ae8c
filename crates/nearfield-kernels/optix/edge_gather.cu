// rt-squares: the four edge rays of a particle sum the forces on it.

#include "edge_rays.cuh"
#include "ray_gather.cuh"

PARAMETERS(ForceRays)

GATHER(GATHER_ANYHIT, EdgeRays)
