// rt-list (RT-REF of paper A): rows of neighbours by point rays.

#include "point_rays.cuh"
#include "ray_list.cuh"

PARAMETERS(ListRays)

LIST(LIST_INTERSECTION, PointRays)
