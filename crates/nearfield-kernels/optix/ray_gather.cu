// rt-boxes: each ray sums the forces on its particle. Complete where all radii are equal.

#include "point_rays.cuh"
#include "ray_gather.cuh"

PARAMETERS(ForceRays)

GATHER(GATHER_INTERSECTION, PointRays)
