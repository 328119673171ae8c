// Neighbour lists of short rows in one search: rows are kept in shared memory, written wherever there is room, and copied
// to their places once these are known. To search twice, first counting, takes longer.

#include "lists.cuh"

#define STAGED_ROW 80u

// Threads that copy a row.
#define ROW_LANES 8u

// Entries that each of them has in registers.
#define COPIED 5u

struct ListStage : CellLister<ListStage> {
    static const bool FILLS = true;

    u32 (&rows)[CLUSTER][STAGED_ROW];
    u32 count[CLUSTER];

    __device__ ListStage(const ListArgs& arguments, const ClusterPlace& place, u32 (&room)[CLUSTER][STAGED_ROW])
        : CellLister<ListStage>(arguments, place), rows(room) {
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) count[k] = 0;
    }

    __device__ void mine(u32 k, bool in, u32 id_j, u32) {
        const u32 votes = __ballot_sync(ALL_LANES, in), at = count[k] + __popc(votes & lanes_below());
        if (in && at < STAGED_ROW) rows[k][at] = id_j;
        count[k] += __popc(votes);
    }

    // There is one class only.
    __device__ void theirs(u32, u32, u32) {}

    __device__ void store(const StageArgs& stage, const ClusterPlace& place) {
        const u32 lane = threadIdx.x % WARP;
        u32 total = 0, longest = 0, own = 0, before = 0;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            if (lane == k) own = count[k], before = total;
            total += count[k];
            longest = larger(longest, count[k]);
        }
        u64 begin = 0;
        if (lane == 0) begin = atomicAdd(&stage.control->entries, (u64)total);
        begin = __shfl_sync(ALL_LANES, begin, 0);
        if (lane < place.count) {
            a.count[id] = own;
            stage.start[id] = begin + before;
        }
        if (longest > STAGED_ROW || begin + total > stage.capacity) {
            if (lane == 0) stage.control->overflow = 1;
            return;
        }
        __syncwarp();
        u32* to = stage.staged + begin;
#pragma unroll
        for (u32 k = 0; k < CLUSTER; ++k) {
            for (u32 e = lane; e < count[k]; e += WARP) to[e] = rows[k][e];
            to += count[k];
        }
    }
};

KERNEL_MIN_BLOCKS(cell_list_stage, StageArgs, WARPS_PER_BLOCK* WARP, 6) {
    __shared__ Scratch scratch[WARPS_PER_BLOCK];
    __shared__ u32 rows[WARPS_PER_BLOCK][CLUSTER][STAGED_ROW];
    const ListArgs& list = a.list;
    const u32 warp = threadIdx.x / WARP;
    const ClusterPlace cluster = own_cluster<false>(list.grid, list.n);
    if (cluster.count == 0) return;
    ListStage lister(list, cluster, rows[warp]);
    search_cells<false>(list.grid, list.space, list.slack, cluster, cluster_bounds(lister.x), scratch[warp], lister);
    lister.store(a, cluster);
}

KERNEL(copy_rows, CopyRowsArgs, 256) {
    const u32 row = thread_index() / ROW_LANES;
    if (row >= a.n || a.control->overflow || a.control->entries > a.room) return;
    const u64 begin = a.offset[row];
    const u32 count = (u32)(a.offset[row + 1] - begin);
    const u32* from = a.staged + a.start[row];
    u32* to = a.index + begin;
    // Several loads are on their way at a time.
    for (u32 e = threadIdx.x % ROW_LANES; e < count; e += COPIED * ROW_LANES) {
        u32 part[COPIED];
#pragma unroll
        for (u32 q = 0; q < COPIED; ++q) part[q] = e + q * ROW_LANES < count ? from[e + q * ROW_LANES] : 0;
#pragma unroll
        for (u32 q = 0; q < COPIED; ++q) {
            if (e + q * ROW_LANES < count) to[e + q * ROW_LANES] = part[q];
        }
    }
}
