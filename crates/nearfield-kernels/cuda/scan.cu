// Exclusive prefix sums in one pass (Merrill and Garland, "Single-pass parallel prefix scan with decoupled look-back",
// 2016). Tiles are numbered by a ticket in the order in which blocks start, so a block only ever waits for blocks that
// run already.

#include "layouts.cuh"

#define SCAN_THREADS 256
#define SCAN_ITEMS 8
#define SCAN_TILE (SCAN_THREADS * SCAN_ITEMS)

// A tile's state: what `value` says in the upper two bits, `value` below.
#define TILE_SUM (1ull << 62)   // of the tile alone
#define TILE_TOTAL (2ull << 62) // of the tile and all before it
#define TILE_VALUE (TILE_SUM - 1)

__device__ inline u64 read_state(const u64* tile) {
    return *(const volatile u64*)tile;
}

__device__ inline void write_state(u64* tile, u64 state) {
    *(volatile u64*)tile = state;
}

// Inclusive sums over the lanes of a warp.
__device__ inline u64 scan_lanes(u64 value) {
    const u32 lane = threadIdx.x % WARP;
    for (u32 step = 1; step < WARP; step *= 2) {
        const u64 before = __shfl_up_sync(ALL_LANES, value, step);
        if (lane >= step) value += before;
    }
    return value;
}

// Sum of all tiles before this one, found by one warp: back to the nearest tile that knows its total.
__device__ inline u64 sum_before(const u64* tiles, u32 tile) {
    u64 sum = 0;
    for (u32 end = tile; end > 0; end = end > WARP ? end - WARP : 0) {
        const u32 back = threadIdx.x % WARP + 1;
        u64 state = end >= back ? 0 : TILE_TOTAL;
        while (__any_sync(ALL_LANES, state == 0)) {
            if (state == 0) state = read_state(tiles + end - back);
        }
        const u32 totals = __ballot_sync(ALL_LANES, (state & TILE_TOTAL) != 0);
        const u32 nearest = totals == 0 ? WARP - 1 : __ffs(totals) - 1;
        const u64 value = threadIdx.x % WARP <= nearest ? state & TILE_VALUE : 0;
        sum += __shfl_sync(ALL_LANES, scan_lanes(value), WARP - 1);
        if (totals != 0) break;
    }
    return sum;
}

// The element after the last counts as zero, so that its sum is the total.
template <class T> __device__ inline void scan(const ScanArgs& a) {
    __shared__ u64 warp_sum[SCAN_THREADS / WARP];
    __shared__ u64 before_tile;
    __shared__ u32 ticket;
    const u32 n_tiles = a.n / SCAN_TILE + 1;
    if (threadIdx.x == 0) ticket = (u32)atomicAdd(a.tiles + n_tiles, 1ull);
    __syncthreads();
    const u32 tile = ticket;
    const u64 first = (u64)tile * SCAN_TILE + threadIdx.x * SCAN_ITEMS;

    T item[SCAN_ITEMS];
    T sum = 0;
    for (u32 k = 0; k < SCAN_ITEMS; ++k) {
        item[k] = sum;
        if (first + k < a.n) sum += a.input[first + k];
    }
    const u32 lane = threadIdx.x % WARP, warp = threadIdx.x / WARP;
    const u64 inclusive = scan_lanes(sum);
    if (lane == WARP - 1) warp_sum[warp] = inclusive;
    __syncthreads();
    u64 before = inclusive - sum, tile_sum = 0;
    for (u32 w = 0; w < SCAN_THREADS / WARP; ++w) {
        if (w < warp) before += warp_sum[w];
        tile_sum += warp_sum[w];
    }

    if (warp == 0) {
        if (lane == 0 && tile > 0) write_state(a.tiles + tile, TILE_SUM | tile_sum);
        const u64 all_before = sum_before(a.tiles, tile);
        if (lane == 0) {
            write_state(a.tiles + tile, TILE_TOTAL | (all_before + tile_sum));
            before_tile = all_before;
        }
    }
    __syncthreads();
    T* output = (T*)a.output;
    const T start = (T)(before_tile + before);
    for (u32 k = 0; k < SCAN_ITEMS; ++k) {
        if (first + k <= a.n) output[first + k] = start + item[k];
    }
}

// `output` may be `input`: a tile has read its own before it writes.
KERNEL(scan_u32, ScanArgs, SCAN_THREADS) {
    scan<u32>(a);
}

KERNEL(scan_u64, ScanArgs, SCAN_THREADS) {
    scan<u64>(a);
}
