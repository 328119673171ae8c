// Rows of neighbours by edge rays through squares.

#include "edge_rays.cuh"
#include "ray_list.cuh"

PARAMETERS(ListRays)

LIST(LIST_ANYHIT, EdgeRays)
