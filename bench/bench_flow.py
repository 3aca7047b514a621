"""Speed of the flow solver, beside what this machine's memory and threads give in the same run.

Ratios travel, times do not. ``--pieces`` says where the time goes, piece by piece; ``--small`` times small flows in the
plane alone; ``--keep`` states what was found on the page on the limits of the flow solver.
"""

import argparse
import os
import sys
from collections import defaultdict
from functools import partial
from math import prod
from pathlib import Path
from time import perf_counter, process_time

import numba
import numpy as np

from form import SHORT, in_form
from suchus import flow
from suchus.experiments.catalog import EXPERIMENTS
from suchus.flow import border, farfield, log, midline, multigrid, patch, poisson, simulation, water
from suchus.flow.compiled import compiled, threaded
from suchus.flow.slab import inner_strides
from suchus.swimming.water import fit, printed_wave
from suchus.swimming.water.setting import SwimSetting
from suchus.swimming.water.swim_setup import ResolvedSwim

PIECES = (
    (
        water,
        "immerse add_immersion_impulse dilatation_work add_contents residual correct fastest fill fill_source",
    ),
    (water.Fluid, "step place _measure _clear _advance"),
    (poisson, "solve"),
    (multigrid, "coarsen copy_coefficients"),
    (midline, "paint section_motions"),
    (midline.Midline, "markers"),
    (farfield, "induce"),
    (border.Border, "prepare update_induced fill"),
    (log.Log, "reactions"),
    (simulation, "sample"),
    (simulation.Simulation, "advance _note"),
)
"""What ``--pieces`` tells apart: modules and classes, and names in them; a piece's time is without those inside it."""


@numba.njit(fastmath=True)
def triad(a, b, c):
    for k in range(a.size):
        a[k] = b[k] + np.float32(2) * c[k]


@numba.njit(fastmath=True, parallel=True)
def triad_threads(a, b, c):
    for k in numba.prange(a.size):
        a[k] = b[k] + np.float32(2) * c[k]


@numba.njit(fastmath=True)
def spin(x, rounds):
    """Arithmetic that needs no memory: 512 numbers in the nearest cache."""
    for _ in range(rounds):
        for k in range(x.size):
            y = x[k] * np.float32(0.999) + np.float32(0.001)
            y = y * y * np.float32(0.5) + np.float32(0.2)
            x[k] = y * y * np.float32(0.3) + np.float32(0.1)


@numba.njit(fastmath=True, parallel=True)
def spin_threads(x, rounds):
    for t in numba.prange(x.shape[0]):
        spin(x[t, 0], rounds)


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


def gain_of_two():
    """How much faster two threads are than one at arithmetic alone: what the machine's cores are worth."""
    x, rounds = (
        np.ones((2, 2, 512), np.float32),
        in_form(200_000, 2_000),
    )  # apart: neighbours share a line of the caches
    numba.set_num_threads(2)
    both = best(lambda: spin_threads(x, rounds))
    numba.set_num_threads(1)
    return 2 * best(lambda: spin(x[0, 0], rounds)) / both


def eel(cells, threads):
    """A held eel in a stream, domain 4 x 2 lengths, default settings."""
    grid = flow.Grid(cells=(4 * cells, 2 * cells), cell=1 / cells, origin=(-1.0, -1.0))
    body = flow.Body(shape=flow.eel(1.0, stations=2 * cells + 1))
    setup = flow.Setup(grid=grid, viscosity=1.4e-4, density=1.0, stream=(0.4, 0.0), bodies=(body,))
    sim = flow.Simulation(setup, thread_count=threads)
    for _ in range(20):
        sim.advance()
    return sim


def in_space(moving):
    """Return what makes a flow in space from cells along x and threads: around a body at rest or one that swings."""

    def make(cells, threads):
        size = cells, cells // 2, cells // 2
        grid = flow.Grid(cells=size, cell=4 / size[1], origin=(-2.0, -2.0, -2.0))
        body = flow.Body(shape=flow.Sphere(diameter=1.0))
        if moving:
            swing = flow.Oscillation(frequency=0.3, heave=(0.0, 0.1, 0.0), pitch=0.2)
            body = flow.Body(shape=flow.Ellipsoid(length=3.0, width=0.5, height=0.7), motion=swing)
        setup = flow.Setup(grid=grid, viscosity=0.005, stream=(1.0, 0.0, 0.0), bodies=(body,), coarse=True)
        sim = flow.Simulation(setup, thread_count=threads)
        for _ in range(12):
            sim.advance()
        return sim

    return make


def tell_outline(cells=96, corners=240, steps=12, rounds=6):
    """Print what a step takes around a moving ellipse, its outline and one that a map bends, on one thread [ms]."""
    ellipse = flow.Ellipse(length=1.0, width=0.3)
    shapes = {
        "ellipse": ellipse,
        "outline": flow.from_outline(np.stack(ellipse.outline(corners), axis=1)),
        "bent": flow.bend_shape(ellipse, lambda x, y, time: (x, y - 0.05 * (x + 0.5) * np.sin(6.0 * x - 3.0 * time))),
    }
    grid = flow.Grid(cells=(4 * cells, 8 * cells // 3), cell=1 / cells, origin=(-1.5, -4 / 3))
    swing, sims = flow.Oscillation(frequency=0.5, heave=(0.0, 0.1), pitch=0.3), {}
    for name, shape in shapes.items():
        body = flow.Body(shape=shape, motion=swing)
        setup = flow.Setup(grid=grid, viscosity=1e-3, stream=(1.0, 0.0), bodies=(body,))
        sims[name] = flow.Simulation(setup, thread_count=1)

    def spent(sim):
        start = perf_counter()
        for _ in range(steps):
            sim.advance()
        return 1e3 * (perf_counter() - start) / steps

    every = [{name: spent(sim) for name, sim in sims.items()} for _ in range(rounds)]
    ellipse, outline, bent = (min(one[name] for one in every[1:]) for name in shapes)
    print(
        f"{' x '.join(map(str, grid.cells))}, a moving ellipse {ellipse:.1f} ms a step, an outline of its {corners} "
        f"corners {outline:.1f} ms: {outline / ellipse:.2f} times (asked: 1.3), bent by a map {bent:.1f} ms: "
        f"{bent / ellipse:.2f} times"
    )
    return {"shape_ellipse": ellipse, "shape_outline": outline, "shape_bent": bent}


def tell_patch(steps=6, rounds=4, cells=64):
    """Print what a step takes on a patch of fine cells, over that on fine cells everywhere, on one thread [-]."""
    found = {}
    plane = flow.Grid.covering((-3.0, 5.0), (-2.0, 2.0), cell=1 / cells), ((-0.3, 1.5), (-0.4, 0.4)), 4
    space = (
        flow.Grid.covering((-2.0, 3.0), (-2.0, 2.0), (-2.0, 2.0), cell=1 / 8),
        ((-0.95, 1.2), *[(-0.95, 0.95)] * 2),
        4,
    )
    aerofoil, sphere = flow.foil(1.0, thickness=0.12), flow.Sphere(diameter=1.0)
    for (whole, box, ratio), shape in ((plane, aerofoil), (space, sphere))[: in_form(2, 1)]:
        fine = flow.Grid(cells=tuple(ratio * n for n in whole.cells), cell=whole.cell / ratio, origin=whole.origin)
        patch, key = whole.patch(*box, ratio=ratio), f"patch_{whole.ndim}"
        more = {
            "viscosity": 1e-2, "stream": (1.0, 0.0), "bodies": (flow.Body(shape=shape),), "coarse": True
        }  # fmt: skip
        sims = [
            flow.Simulation(flow.Setup(**grids, **more), thread_count=1)
            for grids in ({"grid": fine}, {"grid": patch, "coarse_grid": whole})
        ]
        every = []
        for _ in range(rounds):
            for sim in sims:
                start = perf_counter()
                for _ in range(steps):
                    sim.advance()
                every.append((perf_counter() - start) / steps)
        everywhere, alone = min(every[2::2]), min(every[3::2])
        share = (prod(patch.cells) + prod(whole.cells)) / prod(fine.cells)
        found[key], found[f"{key}_cells"] = alone / everywhere, share
        sizes = [" x ".join(map(str, grid.cells)) for grid in (patch, whole, fine)]
        print(
            f"{sizes[0]} fine cells in {sizes[1]} coarse ones: a step {1e3 * alone:.1f} ms, {alone / everywhere:.2f} "
            f"of {1e3 * everywhere:.1f} ms on {sizes[2]} (asked: {0.35 if whole.ndim == 2 else 0.2}), with "
            f"{share:.2f} of the cells"
        )
    return found


def tell_sizes(sizes=(64, 128, 256), steps=20, rounds=3):
    """Print the speed of the moving eel on one thread by the size of its grid, in processor time [M cells/s]."""
    found = {}
    for cells in sizes:
        sim, times = eel(cells, 1), []
        for _ in range(rounds):
            start = process_time()
            for _ in range(steps):
                sim.advance()
            times.append(process_time() - start)
        found[f"eel_{cells}"] = rate = steps * prod(sim.setup.grid.cells) / min(times) / 1e6
        print(f"{' x '.join(map(str, sim.setup.grid.cells))}, moving eel, one thread: {rate:.1f} M cells/s")
    ratio = found[f"eel_{sizes[-2]}"] / found[f"eel_{sizes[-1]}"]
    print(f"moving eel, one thread: half the cells a length have {ratio:.2f} of the rate (asked: 0.9)")
    return found


PAIRS = (6,), (4,), (3,), (2,)
"""Pairs of smoothing steps around a body that ``tell_pairs`` compares: on every level."""


def tell_pairs(steps=60, eel_cells=64, plate_cells=24):
    """Print what a pressure solve takes with fewer smoothing steps around the body, on one thread."""
    grid = flow.Grid.covering((-2.0, 2.0), (-2.0, 2.0), cell=1 / plate_cells)
    swing = flow.Oscillation(frequency=0.5, heave=(0.0, 0.15), pitch=0.2)
    plate = flow.Body(shape=flow.Plate(length=1.0, thick=1.2 / plate_cells), motion=swing)
    makers = {
        "eel": lambda: eel(eel_cells, 1),
        "plate": lambda: flow.Simulation(
            flow.Setup(grid=grid, viscosity=1 / 200, stream=(1.0, 0.0), bodies=(plate,), coarse=True), thread_count=1
        ),
    }
    found, solve, whole = {}, poisson.solve, patch.SMOOTHING_PAIRS
    for label, make in makers.items():
        for pairs in PAIRS:
            times, cycles = [], []

            def timed(*given, times=times, cycles=cycles):
                start = process_time()
                answer = solve(*given)
                times.append(process_time() - start)
                cycles.append(answer[0])
                return answer

            patch.SMOOTHING_PAIRS, poisson.solve = (pairs, whole[1]), timed
            try:
                sim = make()
                for _ in range(steps):
                    sim.advance()
            finally:
                patch.SMOOTHING_PAIRS, poisson.solve = whole, solve
            kept = len(times) // 3  # the start takes more cycles
            spent = np.array(times[kept:]) / np.array(cycles[kept:])
            key = f"{label}_pairs_{pairs[0]}"
            found[f"{key}_cycles"] = mean = float(np.mean(cycles[kept:]))
            found[f"{key}_time"] = 1e6 * float(np.quantile(spent, 0.2)) * mean
            print(
                f"{label}, {pairs[0]} pairs: {mean:.2f} cycles and {found[f'{key}_time']:.0f} us a solve, "
                f"{found[f'{key}_time'] / found[f'{label}_pairs_{PAIRS[0][0]}_time']:.2f} of that with {PAIRS[0][0]}"
            )
    return found


def tell_batch(count=64, cells=64, steps=20, rounds=3):
    """Print the speed of many small flows on one thread, one after the other and in lockstep [M cells/s].

    Both take the same steps of the same flows in the same run, in processor time.
    """
    grid, found = flow.Grid(cells=(2 * cells, cells), cell=4 / cells, origin=(-2.0, -2.0)), {}
    swing = flow.Oscillation(frequency=0.5, heave=(0.0, 0.1), pitch=0.3)
    bodies = {
        "cylinders at rest": flow.Body(shape=flow.Cylinder(diameter=1.0)),
        "ellipses that move": flow.Body(shape=flow.Ellipse(length=1.0, width=0.3), motion=swing),
    }
    for label, body in bodies.items():
        setup = flow.Setup(grid=grid, viscosity=0.01, stream=(1.0, 0.0), bodies=(body,), coarse=True)
        sims = flow.batch([setup] * count, 0.05, thread_count=1, progress=False)

        def one_by_one(sims=sims):
            for sim in sims:
                for _ in range(steps):
                    sim.advance()

        def in_lockstep(sims=sims):
            for _ in range(steps):
                for sim in sims:
                    sim.advance()

        rates = {}
        for name, advance in (("alone", one_by_one), ("lockstep", in_lockstep)):
            times = []
            for _ in range(rounds):
                start = process_time()
                advance()
                times.append(process_time() - start)
            rates[name] = count * steps * prod(grid.cells) / min(times) / 1e6
        key = f"batch_{label.split()[0]}"
        found[key], found[f"{key}_lockstep"] = rates["alone"], rates["lockstep"]
        print(
            f"{count} flows of {' x '.join(map(str, grid.cells))}, {label}, one thread: {rates['alone']:.1f} M cells/s "
            f"(asked: 12.8), {prod(grid.cells) / rates['alone'] / 1e3:.2f} ms a step; step by step in lockstep "
            f"{rates['lockstep'] / rates['alone']:.2f} times as fast"
        )
    return found


def tell_pieces(make, cells, threads, steps):
    """Print what each piece of a step takes, the faster half of its calls counting, and those of a pressure solve."""
    calls, inside, kept = defaultdict(list), [], []

    def watched(function, label):
        def call(*given, **named):
            inside.append(0.0)
            start = perf_counter()
            answer = function(*given, **named)
            spent = perf_counter() - start
            calls[label].append(spent - inside.pop())
            if inside:
                inside[-1] += spent
            return answer

        return call

    sim = make(cells, threads)
    for place, names in PIECES:
        for name in names.split():
            kept.append((place, name, getattr(place, name)))
            setattr(place, name, watched(getattr(place, name), f"{place.__name__.split('.')[-1]}.{name}"))
    try:
        for _ in range(steps):
            sim.advance()
    finally:
        for place, name, function in kept:
            setattr(place, name, function)
    size = sim.setup.grid.cells
    per_cell = 1e9 / prod(size)
    print(f"{' x '.join(map(str, size))}, {threads} thread(s), ns per cell and step; calls a step")
    for label, spent in sorted(calls.items(), key=lambda item: -sum(item[1])):
        half = np.mean(np.sort(spent)[: max(len(spent) // 2, 1)])
        print(f"  {per_cell * half * len(spent) / steps:7.2f}  {label} ({len(spent) / steps:.0f})")
    tell_solve(sim.water, per_cell)


def cells_of(w, level):
    """Return the cells of a level along x, y (and z)."""
    return tuple(int(n) for n in w._layout[level, w.ndim : 0 : -1])


def tell_solve(w, per_cell):
    """Print what the pieces of one iteration of the pressure solver take."""
    cycle, start, end = (compiled(part.py_func) for part in (multigrid.cycle, patch.start, patch.end))
    down, up, dots, first, second = (
        threaded(part.py_func)
        for part in (
            multigrid._descend_threaded, multigrid._ascend_threaded, poisson._write_slab_products,
            poisson._first_step,
            poisson._step
        )
    )  # fmt: skip
    store, layout, room, patches, inner, sides = w._store, w._layout, w._buffer, w._patches, w.inner, w.repeats
    print("one iteration of the pressure solver, ns per cell of the finest level; best of 20")

    def tell(label, function):
        print(f"  {per_cell * best(function, 20):7.2f}  {label}")

    for k in range(layout.shape[0]):
        x, size = multigrid.level(store, layout, inner, multigrid.X, k), cells_of(w, k)
        below, own = layout[k:].copy(), patches[k:].copy()
        tell(f"cycle from level {k}, {size}", lambda: cycle(x, store, below, room, own, inner, sides))  # noqa: B023
    x, b, dinv = (multigrid.level(store, layout, inner, kind, 0) for kind in (multigrid.X, multigrid.B, multigrid.DINV))
    faces = multigrid.faces_of(store, layout, inner, 0)
    coarse_b, coarse_x = (multigrid.level(store, layout, inner, kind, 1) for kind in (multigrid.B, multigrid.X))
    zero, rect, place, coarser = w.dtype(0), patches[0], layout[0], inner_strides(cells_of(w, 1))
    tell("down, finest level", lambda: down(coarse_b, b, faces, place, room, rect, inner, coarser, sides))
    tell("up, finest level", lambda: up(x, b, coarse_x, faces, dinv, place, room, rect, inner, coarser, sides))
    tell("patch, finest level, before", lambda: start(room, rect, b, inner))
    tell("patch, finest level, after", lambda: end(room, rect, x, inner))
    tell("dot products", lambda: dots(x, b, w._d, faces, place, inner, w._sums))
    tell("first step", lambda: first(b, x, faces, place, zero, inner, sides, w._sums))
    tell("second step", lambda: second(b, x, w._d, faces, place, zero, zero, inner, sides, w._sums))


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument(
        "--steps", type=int, default=in_form(30, 1), help="steps per batch; the fastest of 5 batches counts"
    )
    options.add_argument("--pieces", action="store_true", help="say where the time goes instead")
    options.add_argument("--small", action="store_true", help="time small flows in the plane alone, on one thread")
    options.add_argument("--keep", action="store_true", help="state what was found on the page on limits")
    chosen = options.parse_args()
    steps = chosen.steps
    if chosen.small:
        found = {"load": os.getloadavg()[0], "cores": os.cpu_count()}
        print(f"{found['load']:.1f} processes share {found['cores']} cores")
        found |= in_form(tell_batch, partial(tell_batch, 2, 32, 2, 1))()
        found |= in_form(tell_sizes, partial(tell_sizes, (64, 96), 1, 1))()
        found |= in_form(tell_pairs, partial(tell_pairs, 3, 64, 16))()
        if chosen.keep and not SHORT:
            store("bench_small_flows", found)
        return
    many = min(2, numba.config.NUMBA_NUM_THREADS)
    far, found = {}, {}
    for threads in sorted({1, many}):
        far[threads], near = bandwidth(in_form(16_000_000, 500_000), threads), bandwidth(500_000, threads)
        found[f"memory_{threads}"] = far[threads]
        print(f"memory, {threads} thread(s): {far[threads]:.1f} GB/s far, {near:.1f} GB/s near")
    if many > 1:
        found["arithmetic"] = gain_of_two()
        print(f"arithmetic alone: two threads over one {found['arithmetic']:.2f}")
    for label, make, sizes in FLOWS:
        for cells in sizes:
            if chosen.pieces:
                for threads in sorted({1, many}):
                    tell_pieces(make, cells, threads, steps)
            else:
                found |= tell_speed(label, make, cells, steps, far)
    if not chosen.pieces:
        found |= in_form(tell_outline, partial(tell_outline, 48, 60, 1, 2))()
        found |= in_form(tell_patch, partial(tell_patch, 1, 2, 32))()
        for cells in in_form((96, 128), ()):
            found |= tell_swim(cells, far)
    if chosen.keep and many > 1 and not chosen.pieces and not SHORT:
        store("bench_flow", found)


def store(name, found):
    """Keep what was measured, and state it on the pages."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
    from pages import stated  # noqa: PLC0415

    stated.keep(name, found)
    stated.main()


def tell_swim(cells, far):
    """Print what a cycle of the robot's free swim in space takes on each number of threads in ``far`` [s]."""
    question, found = EXPERIMENTS["swim_3d"], {}
    setting = SwimSetting(axes=3, cells=cells, viscosity=question.viscosity, cycles=2)
    wave = printed_wave(question.robot, question.reading, frequency=question.frequency, sign=-1)
    swim = ResolvedSwim(robot=question.robot, motion=fit(question.robot, wave).gait, setting=setting)
    for threads in far:
        sim = flow.Simulation(swim.setup, thread_count=threads)
        sim.run(0.2, progress=False)
        before, start = sim.record.time.size, perf_counter()
        sim.run(1.2, progress=False)
        found[f"swim_{cells}_{threads}"] = spent = perf_counter() - start
        found[f"swim_{cells}_steps"] = count = sim.record.time.size - before
        print(
            f"{' x '.join(map(str, sim.setup.grid.cells))}, the robot's swim at {cells} cells a length, {threads} "
            f"thread(s): {spent:.2f} s a cycle, {1e3 * spent / count:.1f} ms a step, {count} steps"
        )
    return found


def tell_speed(label, make, cells, steps, far):
    """Print cells a second on each number of threads in ``far``, the speed of the memory with so many [GB/s]."""
    rates, key = {}, f"{label.split()[-1]}_{cells}"
    for threads in far:
        sim = make(cells, threads)
        size, count = " x ".join(map(str, sim.setup.grid.cells)), prod(sim.setup.grid.cells)

        def batch(sim=sim):
            for _ in range(steps):
                sim.advance()

        spent = best(batch, 3 if sim.ndim == 3 else 5) / steps
        rates[threads] = count / spent / 1e6
        solves, memory = sim.record.cycles[-steps:].mean(), sim.water.arrays * sim.water.p.nbytes / count
        print(
            f"{size}, {label}, single precision, tolerance {sim.setup.tolerance:g}, {threads} thread(s): "
            f"{rates[threads]:.1f} M cells/s, {1e3 * spent:.1f} ms a step, what the memory gives for "
            f"{1e3 * far[threads] / rates[threads]:.0f} bytes; {1 / sim.record.step[-steps:].mean():.0f} steps a "
            f"second of flow, {solves:.1f} multigrid cycles a solve, {memory:.0f} bytes a cell"
        )
    if len(rates) > 1:
        print(f"{size}, {label}: two threads over one {rates[max(rates)] / rates[1]:.2f}")
    return {f"{key}_{threads}": rate for threads, rate in rates.items()} | {f"{key}_bytes": memory}


FLOWS = (
    ("moving eel", eel, in_form((128, 256), (64,))),
    ("sphere at rest", in_space(moving=False), in_form((128, 192), (32,))),
    ("moving ellipsoid", in_space(moving=True), in_form((128, 192), (96,))),
)
"""What is timed: what it is, how it is made from a number of cells and of threads, and for which numbers of cells."""


if __name__ == "__main__":
    main()
