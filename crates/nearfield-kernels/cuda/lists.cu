// Neighbour lists by cells and by testing all pairs.

#include "lists.cuh"

template <class V> __device__ inline void list_by_cells(const ListArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = find_cluster(a.grid, a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    V lister(a, cluster);
    const Bounds box = cluster_bounds(lister.x);
    if (a.law.variable) {
        search_cells<true>(a.grid, a.space, a.slack, cluster, box, scratch[threadIdx.x / WARP], lister);
    } else {
        search_cells<false>(a.grid, a.space, a.slack, cluster, box, scratch[threadIdx.x / WARP], lister);
    }
    lister.store(cluster);
}

template <class V> __device__ inline void list_all(const ListArgs& a) {
    const ClusterPlace cluster = consecutive_cluster(a.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    V lister(a, cluster);
    meet_all(a.n, lister);
    lister.store(cluster);
}

KERNEL(cell_list_count, ListArgs, WARPS_PER_BLOCK* WARP) {
    list_by_cells<ListCount<false>>(a);
}

KERNEL(cell_list_fill, ListArgs, WARPS_PER_BLOCK* WARP) {
    list_by_cells<ListFill<false>>(a);
}

KERNEL(brute_list_count, ListArgs, WARPS_PER_BLOCK* WARP) {
    list_all<ListCount<true>>(a);
}

KERNEL(brute_list_fill, ListArgs, WARPS_PER_BLOCK* WARP) {
    list_all<ListFill<true>>(a);
}
