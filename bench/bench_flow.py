"""Speed of the flow solver, beside what this machine's memory gives in the same run. Ratios travel, times do not."""

import argparse
from time import perf_counter

import numba
import numpy as np

from suchus import flow


@numba.njit(fastmath=True)
def triad(a, b, c):
    for k in range(a.size):
        a[k] = b[k] + np.float32(2) * c[k]


@numba.njit(fastmath=True, parallel=True)
def triad_threads(a, b, c):
    for k in numba.prange(a.size):
        a[k] = b[k] + np.float32(2) * c[k]


def best(function, times=5):
    function()
    spent = []
    for _ in range(times):
        start = perf_counter()
        function()
        spent.append(perf_counter() - start)
    return min(spent)


def bandwidth(size, threads):
    """GB/s of a triad on arrays of ``size`` floats, write-allocation not counted."""
    a, b, c = (np.ones(size, np.float32) for _ in range(3))
    numba.set_num_threads(threads)
    run = triad if threads == 1 else triad_threads
    return 12 * size / best(lambda: run(a, b, c), 15) / 1e9


def eel(cells, threads):
    """A held eel in a stream, domain 4 x 2 lengths, default settings."""
    grid = flow.Grid(cells=(4 * cells, 2 * cells), cell=1 / cells, origin=(-1.0, -1.0))
    body = flow.Body(shape=flow.eel(1.0, stations=2 * cells + 1))
    setup = flow.Setup(grid=grid, viscosity=1.4e-4, density=1.0, stream=(0.4, 0.0), bodies=(body,))
    sim = flow.Simulation(setup, thread_count=threads)
    for _ in range(20):
        sim.advance()
    return sim


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--steps", type=int, default=30, help="steps per batch; the fastest of 5 batches counts")
    steps = options.parse_args().steps
    many = min(2, numba.config.NUMBA_NUM_THREADS)
    for threads in sorted({1, many}):
        far, near = bandwidth(16_000_000, threads), bandwidth(500_000, threads)
        print(f"memory, {threads} thread(s): {far:.1f} GB/s far, {near:.1f} GB/s near")
    for cells in (128, 256):
        rates = {}
        for threads in sorted({1, many}):
            sim = eel(cells, threads)
            count = sim.setup.grid.cells[0] * sim.setup.grid.cells[1]

            def batch(sim=sim):
                for _ in range(steps):
                    sim.advance()

            spent = best(batch) / steps
            rates[threads] = count / spent / 1e6
            cycle = spent / sim.record.step[-steps:].mean()
            solves = sim.record.cycles[-steps:].mean()
            print(
                f"{4 * cells} x {2 * cells}, moving eel, single precision, tolerance {sim.setup.tolerance:g}, "
                f"{threads} thread(s): {rates[threads]:.1f} M cells/s, {1e3 * spent:.1f} ms a step, "
                f"{cycle:.2f} s a swim cycle, {solves:.1f} multigrid cycles a solve, {sim.water.arrays:.1f} arrays"
            )
        if many > 1:
            print(f"{4 * cells} x {2 * cells}: two threads over one {rates[many] / rates[1]:.2f}")


if __name__ == "__main__":
    main()
