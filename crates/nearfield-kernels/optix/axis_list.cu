// Rows of neighbours by axis rays through spheres.

#include "axis_rays.cuh"
#include "ray_list.cuh"

PARAMETERS(ListRays)

LIST(LIST_ANYHIT, AxisRays)
