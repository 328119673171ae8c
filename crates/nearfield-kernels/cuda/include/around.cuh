// The search of a thread around one particle, in cells of one class that hold about one.

#pragma once

#include "pencils.cuh"

// Takes each slot in the cells within `reach` of a particle, and the image it is at, to `v`; that of the particle, too.
template <class V>
__device__ inline void search_around(const Grid& grid, const Box3& space, const float4& x, float reach, V& v) {
    const CellClass& cells = grid.classes[0];
    for (u32 images = reachable_images(space, point_bounds(x), reach); images != 0; images &= images - 1) {
        const u32 image = __ffs(images) - 1;
        Shift s = {0.0f, 0.0f, 0.0f};
        if (image != HOME_IMAGE) s = shift_of(space, image);
        const u32 x0 = cell_coordinate(cells, 0, x.x - reach - s.x), x1 = cell_coordinate(cells, 0, x.x + reach - s.x);
        const u32 y0 = cell_coordinate(cells, 1, x.y - reach - s.y), y1 = cell_coordinate(cells, 1, x.y + reach - s.y);
        const u32 z0 = cell_coordinate(cells, 2, x.z - reach - s.z), z1 = cell_coordinate(cells, 2, x.z + reach - s.z);
#pragma unroll 1
        for (u32 y = y0, z = z0; z <= z1; y < y1 ? ++y : (y = y0, ++z)) {
            const u32 first = first_of_cells(cells, row_number(cells, y, z), x0, x1);
            const u32 end = grid.cell_start[first + (x1 - x0) + 1];
#pragma unroll 1
            for (u32 j = grid.cell_start[first]; j < end; ++j) v.meet(j, image, s);
        }
    }
}
