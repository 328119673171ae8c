"""Neighbour lists of uniform periodic points with other programs: the workload of `cargo bench --bench lists`.

Prints the median time in milliseconds, index and output of the pairs included. Threads by OMP_NUM_THREADS.
"""

import os
import statistics
import sys
import time

import freud
import matscipy.neighbours
import numpy as np
import scipy.spatial
import vesin

THREADS = int(os.environ.get("OMP_NUM_THREADS", "1"))
freud.parallel.set_num_threads(THREADS)


def median(work, budget=20.0):
    """Median of up to five calls after a first one that warms buffers, within a time budget in seconds."""
    begin = time.perf_counter()
    work()
    first = time.perf_counter() - begin
    times = []
    while len(times) < 5 and (not times or time.perf_counter() - begin + first < budget):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e3 * statistics.median(times)


def main():
    sizes = [int(word) for word in sys.argv[1:]] or [100_000, 1_000_000]
    print("n,k,tool,threads,milliseconds,entries")
    for n in sizes:
        rng = np.random.default_rng(1)
        length = n ** (1 / 3)
        points = rng.random((n, 3)) * length
        for k in (8, 32, 100):
            r = (k / (4 / 3 * np.pi)) ** (1 / 3)
            entries = {}

            def vesin_half():
                calculator = vesin.NeighborList(cutoff=r, full_list=False)
                i, j = calculator.compute(points=points, box=np.eye(3) * length, periodic=True, quantities="ij")
                entries["vesin half"] = len(i)

            def scipy_half():
                tree = scipy.spatial.cKDTree(points, boxsize=length)
                entries["scipy half"] = len(tree.query_pairs(r, output_type="ndarray"))

            def freud_full():
                query = freud.locality.AABBQuery(freud.box.Box.cube(length), points - length / 2)
                pairs = query.query(points - length / 2, {"r_max": r, "exclude_ii": True}).toNeighborList()
                entries["freud full"] = len(pairs)

            def matscipy_full():
                i, j = matscipy.neighbours.neighbour_list(
                    "ij", positions=points, cell=np.eye(3) * length, pbc=[True] * 3, cutoff=r
                )
                entries["matscipy full"] = len(i)

            tools = {
                "vesin half": (vesin_half, THREADS),
                "scipy half": (scipy_half, 1),
                "freud full": (freud_full, THREADS),
                "matscipy full": (matscipy_full, 1),
            }
            for name, (work, threads) in tools.items():
                print(f"{n},{k},{name},{threads},{median(work):.1f},{entries[name]}", flush=True)


if __name__ == "__main__":
    main()
