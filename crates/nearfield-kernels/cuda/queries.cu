// Neighbour lists of queries among points of another set, in cells.

#include "queries.cuh"

template <class V> __device__ inline void list_queries(const QueryArgs& a) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    const ClusterPlace cluster = consecutive_cluster(a.list.n, thread_index() / WARP);
    if (cluster.count == 0) return;
    V lister(a, cluster);
    search_points(a, cluster, scratch[threadIdx.x / WARP], lister);
    lister.store(cluster);
}

KERNEL_MIN_BLOCKS(query_count, QueryArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_queries<ListCount<QueryLister>>(a);
}

KERNEL_MIN_BLOCKS(query_fill, QueryArgs, WARPS_PER_BLOCK* WARP, 6) {
    list_queries<ListFill<QueryLister>>(a);
}
