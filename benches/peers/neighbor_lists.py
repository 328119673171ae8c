"""Neighbour lists with other programs: uniform periodic points, points on a sphere and in a normal cluster, as in
`cargo bench --bench lists`.

Prints the median time in milliseconds, index and output of the pairs included. Threads by OMP_NUM_THREADS. Arguments:
numbers of points.
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


def clouds(n):
    """Name, points, length of a box around them, whether it is periodic, and cutoff."""
    rng = np.random.default_rng(1)
    length = n ** (1 / 3)
    uniform = rng.random((n, 3)) * length
    for k in (8, 32, 100):
        yield f"uniform k={k}", uniform, length, True, (k / (4 / 3 * np.pi)) ** (1 / 3)
    normal = rng.standard_normal((n, 3))
    sphere = normal / np.linalg.norm(normal, axis=1)[:, None] + 2.0
    for k in (9, 72):
        yield f"sphere k={k}", sphere, 4.0, False, 2 * (k / n) ** 0.5
    yield "cluster r=1", 25.0 * normal + 500.0, 1000.0, False, 1.0


def main():
    sizes = [int(word) for word in sys.argv[1:]] or [100_000, 1_000_000]
    print("n,points,tool,threads,milliseconds,entries")
    for n in sizes:
        for cloud, points, length, periodic, r in clouds(n):
            entries = {}

            def vesin_half():
                calculator = vesin.NeighborList(cutoff=r, full_list=False)
                i, j = calculator.compute(points=points, box=np.eye(3) * length, periodic=periodic, quantities="ij")
                entries["vesin half"] = len(i)

            def scipy_half():
                tree = scipy.spatial.cKDTree(points, boxsize=length if periodic else None)
                entries["scipy half"] = len(tree.query_pairs(r, output_type="ndarray"))

            def freud_full():
                # Always periodic, which it wants: what is not is far from the faces.
                query = freud.locality.AABBQuery(freud.box.Box.cube(length), points - length / 2)
                pairs = query.query(points - length / 2, {"r_max": r, "exclude_ii": True}).toNeighborList()
                entries["freud full"] = len(pairs)

            def matscipy_full():
                i, j = matscipy.neighbours.neighbour_list(
                    "ij", positions=points, cell=np.eye(3) * length, pbc=[periodic] * 3, cutoff=r
                )
                entries["matscipy full"] = len(i)

            tools = {
                "vesin half": (vesin_half, THREADS),
                "scipy half": (scipy_half, 1),
                "freud full": (freud_full, THREADS),
                "matscipy full": (matscipy_full, 1),
            }
            for name, (work, threads) in tools.items():
                try:
                    print(f"{n},{cloud},{name},{threads},{median(work):.1f},{entries[name]}", flush=True)
                except (MemoryError, RuntimeError, ValueError) as error:
                    print(f"{n},{cloud},{name},{threads},failed,{error}", flush=True)


if __name__ == "__main__":
    main()
