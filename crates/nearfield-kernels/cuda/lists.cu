// Neighbour lists by cells and by testing all pairs, with one cutoff or a radius for each particle.

#include "lists.cuh"

template <class V, bool WITHIN> __device__ inline void list_by_cells(const ListArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = own_cluster<WITHIN>(a.grid, a.n);
    if (cluster.count == 0) return;
    V lister(a, cluster);
    search_cells<WITHIN>(a.grid, a.space, a.slack, cluster, cluster_bounds(lister.x), scratch[threadIdx.x / WARP],
                         lister);
    lister.store(cluster);
}

template <class V> __device__ inline void list_all(const ListArgs& a) {
    const ClusterPlace cluster = consecutive_cluster(a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    V lister(a, cluster);
    meet_all(a.n, lister);
    lister.store(cluster);
}

KERNEL_MIN_BLOCKS(cell_list_count, ListArgs, WARPS_PER_BLOCK* WARP, 7) {
    list_by_cells<ListCount<CellLister>, false>(a);
}

KERNEL_MIN_BLOCKS(cell_list_count_radii, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_by_cells<ListCount<CellListerOfRadii>, true>(a);
}

KERNEL_MIN_BLOCKS(cell_list_fill, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_by_cells<ListFill<CellLister>, false>(a);
}

KERNEL_MIN_BLOCKS(cell_list_fill_radii, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_by_cells<ListFill<CellListerOfRadii>, true>(a);
}

KERNEL_MIN_BLOCKS(brute_list_count, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_all<ListCount<BruteLister>>(a);
}

KERNEL_MIN_BLOCKS(brute_list_count_radii, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_all<ListCount<BruteListerOfRadii>>(a);
}

KERNEL_MIN_BLOCKS(brute_list_fill, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_all<ListFill<BruteLister>>(a);
}

KERNEL_MIN_BLOCKS(brute_list_fill_radii, ListArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_all<ListFill<BruteListerOfRadii>>(a);
}
