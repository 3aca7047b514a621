"""Two pieces of a step in space on a card of NVIDIA, beside the same pieces on the processor in the same run.

The face values are those of the flow solver: ``on_card`` hands the plain functions behind its parts to ``numba.cuda``.
What each piece gives is compared with what the processor gives, to ``CLOSE`` of its largest value. The domain is a
periodic box without a body. ``--out FILE`` writes what was found, ``--keep FILE`` states what such a file holds on the
page on GPUs. Without a card the program says so and ends; ``NUMBA_ENABLE_CUDASIM=1`` in the environment tries the
arithmetic, on ``--cells 8``.
"""

import argparse
import json
import sys
from math import prod
from pathlib import Path
from time import perf_counter

import numba
import numpy as np
from numba import cuda

from form import in_form
from suchus.flow import multigrid
from suchus.flow.advect import advance
from suchus.flow.compiled import PAD, KernelPart, compiled, replace_kernel_parts
from suchus.flow.multigrid import B
from suchus.flow.poisson import levels, make_store
from suchus.flow.scheme import limited_quick
from suchus.flow.slab import inner_strides
from suchus.flow.stencil import WEIGHTS

CLOSE = 1e-5
"""Largest difference between card and processor over the largest value: both round to single precision [-]."""

THREADS = 256
"""Threads of a block of the cycle [-]."""

SHAPE = 32, 4, 2
"""Threads of a block that advances the velocity, along x, y and z [-]."""

NU, DT, KEEP = np.float32(0.02), np.float32(0.1), np.float32(0.5)
"""Viscosity [cells x m/s], step [cells per (m/s)] and share of the last stage's velocity that stays [-]."""

TWO, ONE = (np.float32(weight) for weight in WEIGHTS[1])
SHARE = np.float32(1 / 6)
ONCE = SHARE * TWO
OWN, NEAR = ONCE + ONE * SHARE - ONE * ONCE, ONE * SHARE * ONCE


def on_card(part):
    """Return a part of the flow solver, with the parts that it calls, as a function for kernels of a card."""
    called = part.py_func.__globals__
    parts = {
        name: on_card(called[name])
        for name in part.py_func.__code__.co_names
        if isinstance(called.get(name), KernelPart)
    }
    return cuda.jit(device=True)(replace_kernel_parts(part, **parts).py_func)


face = on_card(limited_quick)


@cuda.jit(device=True)
def flux(u, w, k, along, own):
    """Return the flux of ``u`` through the face before node ``k``: ``along`` and ``own`` are strides, ``w`` carries."""
    before, here = u[k - along], u[k]
    behind, ahead = u[k - along - along], u[k + along]
    speed = np.float32(0.5) * (w[k - own] + w[k])
    forth = speed > 0
    value = face(behind if forth else ahead, before if forth else here, here if forth else before)
    return speed * value - NU * (here - before)


@cuda.jit
def advance_on_card(out, blend, base, rate, p, nx, ny, nz, wide, deep):
    """Advance all components of the velocity: one thread for each cell, both fluxes of each direction."""
    i, j, n = cuda.grid(3)
    if i < nx and j < ny and n < nz:
        k = (n + PAD) * deep + (j + PAD) * wide + i + PAD
        for c in range(3):
            own = 1 if c == 0 else (wide if c == 1 else deep)
            net = np.float32(0)
            for d in range(3):
                s = 1 if d == 0 else (wide if d == 1 else deep)
                net += flux(rate[c], rate[d], k, s, own) - flux(rate[c], rate[d], k + s, s, own)
            change = net - (p[k] - p[k - own])
            out[c, k] = KEEP * blend[c, k] + (np.float32(1) - KEEP) * (base[c, k] + DT * change)


@cuda.jit(device=True)
def around(a, i, j, n, nx, ny, nz):
    """Return the sum over the six neighbours of a cell of a periodic box."""
    left, right = (i - 1 if i else nx - 1), (i + 1 if i + 1 < nx else 0)
    front, back = (j - 1 if j else ny - 1), (j + 1 if j + 1 < ny else 0)
    low, high = (n - 1 if n else nz - 1), (n + 1 if n + 1 < nz else 0)
    row, slab = nx * (j + ny * n), nx * ny
    beside = a[row + left] + a[row + right]
    across = a[i + nx * (front + ny * n)] + a[i + nx * (back + ny * n)]
    return beside + across + (a[i + nx * j + slab * low] + a[i + nx * j + slab * high])


@cuda.jit
def first_on_card(out, b, nx, ny, nz):
    """Write two smoothing steps that start from nothing."""
    k = cuda.grid(1)
    if k < nx * ny * nz:
        i, j, n = k % nx, k // nx % ny, k // (nx * ny)
        out[k] = OWN * b[k] + NEAR * around(b, i, j, n, nx, ny, nz)


@cuda.jit
def rest_on_card(coarse, x, b, nx, ny, nz):
    """Write half the summed residual of eight cells to each coarse cell; the sizes are those of the fine level."""
    k, mx, my = cuda.grid(1), nx // 2, ny // 2
    if k < mx * my * (nz // 2):
        i, j, n = 2 * (k % mx), 2 * (k // mx % my), 2 * (k // (mx * my))
        total = np.float32(0)
        for c in range(2):
            for d in range(2):
                for e in range(2):
                    m = i + c + nx * (j + d + ny * (n + e))
                    total += b[m] - np.float32(6) * x[m] + around(x, i + c, j + d, n + e, nx, ny, nz)
        coarse[k] = np.float32(0.5) * total


@cuda.jit
def rise_on_card(x, coarse, nx, ny, nz):
    """Add the coarse cells to the fine ones, linear between them along each axis."""
    k = cuda.grid(1)
    if k < nx * ny * nz:
        i, j, n = k % nx, k // nx % ny, k // (nx * ny)
        mx, my, mz = nx // 2, ny // 2, nz // 2
        total = np.float32(0)
        for c in range(2):
            n2 = n // 2 if c == 0 else (n // 2 + (1 if n % 2 else mz - 1)) % mz
            for d in range(2):
                j2 = j // 2 if d == 0 else (j // 2 + (1 if j % 2 else my - 1)) % my
                for e in range(2):
                    i2 = i // 2 if e == 0 else (i // 2 + (1 if i % 2 else mx - 1)) % mx
                    share = np.float32(0.75) if c == 0 else np.float32(0.25)
                    share *= np.float32(0.75) if d == 0 else np.float32(0.25)
                    share *= np.float32(0.75) if e == 0 else np.float32(0.25)
                    total += share * coarse[i2 + mx * (j2 + my * n2)]
        x[k] += total


@cuda.jit
def relax_on_card(out, x, b, weight, nx, ny, nz):
    """Write one Jacobi step."""
    k = cuda.grid(1)
    if k < nx * ny * nz:
        i, j, n = k % nx, k // nx % ny, k // (nx * ny)
        out[k] = weight * SHARE * (around(x, i, j, n, nx, ny, nz) + b[k]) + (np.float32(1) - weight) * x[k]


@cuda.jit
def reach_on_card(y, x, b, weight, far, nx, ny, nz):
    """Go on from ``y`` towards what a Jacobi step from ``x`` comes to, and beyond it."""
    k = cuda.grid(1)
    if k < nx * ny * nz:
        i, j, n = k % nx, k // nx % ny, k // (nx * ny)
        step = weight * SHARE * (around(x, i, j, n, nx, ny, nz) + b[k]) + (np.float32(1) - weight) * x[k]
        y[k] += far * (step - y[k])


class Cycle:
    """One V-cycle on a card, with a launch for each sweep."""

    def __init__(self, cells, b):
        self.sizes = [tuple(int(n) for n in row[3:0:-1]) for row in levels(cells)]
        self.b = [cuda.to_device(b)] + [cuda.device_array(prod(n), np.float32) for n in self.sizes[1:]]
        self.x, self.y = ([cuda.device_array(prod(n), np.float32) for n in self.sizes] for _ in range(2))

    def __call__(self):
        """Start from nothing; ``x[0]`` is what comes out."""
        self.launches = 5 * (len(self.sizes) - 1)
        last = len(self.sizes) - 1
        for k in range(last):
            size, blocks = self.sizes[k], -(-prod(self.sizes[k]) // THREADS)
            first_on_card[blocks, THREADS](self.x[k], self.b[k], *size)
            rest_on_card[-(-blocks // 8), THREADS](self.b[k + 1], self.x[k], self.b[k], *size)
        self.solve_coarsest(last)
        for k in range(last - 1, -1, -1):
            size, blocks = self.sizes[k], -(-prod(self.sizes[k]) // THREADS)
            rise_on_card[blocks, THREADS](self.x[k], self.x[k + 1], *size)
            relax_on_card[blocks, THREADS](self.y[k], self.x[k], self.b[k], ONE, *size)
            relax_on_card[blocks, THREADS](self.x[k], self.y[k], self.b[k], TWO, *size)

    def solve_coarsest(self, k):
        """Solve the last level from nothing, with the steps of the processor."""
        size, blocks = self.sizes[k], -(-prod(self.sizes[k]) // THREADS)
        x, y = self.x[k], self.y[k]
        reaches, weight = multigrid._relaxation_factors.py_func(max(size), 3)
        x[:] = y[:] = np.float32(0)
        self.launches += 1 + reaches.size
        for far in reaches.astype(np.float32):
            reach_on_card[blocks, THREADS](y, x, self.b[k], np.float32(weight), far, *size)
            x, y = y, x
        self.x[k], self.y[k] = x, y


def padded(a, axes=3):
    """Return the last three axes of an array with the cells of its other end around them, slab by slab."""
    wide = np.pad(a, [(0, 0)] * (a.ndim - axes) + [(PAD, PAD)] * axes, mode="wrap")
    return np.ascontiguousarray(wide.reshape(*wide.shape[: a.ndim - 2], -1))


def fastest(function, finish, times):
    """Return the shortest time of some calls [s]; ``finish`` waits until the work is done."""
    function()
    finish()
    spent = []
    for _ in range(times):
        start = perf_counter()
        function()
        finish()
        spent.append(perf_counter() - start)
    return min(spent)


def far(found, ours):
    """Return the largest difference over the largest value [-]."""
    return float(np.abs(found - ours).max() / np.abs(ours).max())


def tell_advance(cells, times, threads):
    """Compare and time what advances the velocity."""
    nx, ny, nz = cells
    rng = np.random.default_rng(3)
    base = padded(rng.normal(size=(3, nz, ny, nx)).astype(np.float32))
    p, out = padded(rng.normal(size=(nz, ny, nx)).astype(np.float32)), np.zeros_like(base)
    place, inner = levels(cells)[0], inner_strides(cells)
    raw, nothing = np.zeros((3, 1, 1), np.float32), np.zeros(3, np.float32)

    def ours():
        advance(out, base, base, base, p, raw, place, place, inner, (True,) * 3, DT, NU, nothing, KEEP)

    flat = [cuda.to_device(a.reshape(3, -1)) for a in (out, base)]
    pressure, wide = cuda.to_device(p.ravel()), nx + 2 * PAD
    blocks = tuple(-(-n // m) for n, m in zip(cells, SHAPE, strict=True))

    def theirs():
        sizes = nx, ny, nz, wide, wide * (ny + 2 * PAD)
        advance_on_card[blocks, SHAPE](flat[0], flat[1], flat[1], flat[1], pressure, *sizes)

    spent = {count: timed(ours, count) for count in threads}
    card = fastest(theirs, cuda.synchronize, times)
    inside = (slice(None), *(slice(PAD, -PAD),) * 3)
    shape = 3, *(n + 2 * PAD for n in cells[::-1])
    apart = far(flat[0].copy_to_host().reshape(shape)[inside], out.reshape(shape)[inside])
    return spent, card, apart, 1


def tell_cycle(cells, times, threads):
    """Compare and time one V-cycle."""
    nx, ny, nz = cells
    b = np.random.default_rng(4).normal(size=(nz, ny, nx)).astype(np.float32)
    b -= b.mean()
    layout, inner, repeats = levels(cells), inner_strides(cells), (True,) * 3
    store = make_store(layout, np.float32)
    right = finest(store, layout, B)
    right[:] = padded(b)
    x = np.zeros_like(right)
    room, rects = np.zeros((7, 1), np.float32), np.zeros((len(layout), 8), np.int64)
    cycle, card = compiled(multigrid.cycle.py_func), Cycle(cells, b.ravel())

    def ours():
        cycle(x, store, layout, room, rects, inner, repeats)

    spent = {count: timed(ours, count) for count in threads}
    taken = fastest(card, cuda.synchronize, times)
    found = card.x[0].copy_to_host().reshape(nz, ny, nx)
    x = x.reshape(tuple(n + 2 * PAD for n in (nz, ny, nx)))[(slice(PAD, -PAD),) * 3]
    return spent, taken, far(found, x), card.launches


def finest(store, layout, kind):
    """Return the array of one kind on the finest level."""
    high, length = int(layout[0, 1]) + 2 * PAD, int((layout[0, 2] + 2 * PAD) * (layout[0, 3] + 2 * PAD))
    return store[kind * high * length : (kind + 1) * high * length].reshape(high, length)


def timed(function, threads, times=4):
    """Return the shortest time of some calls on so many threads of the processor [s]."""
    numba.set_num_threads(threads)
    return fastest(function, lambda: None, times)


def copied(size=2**28):
    """Return how fast the card copies its own memory, bytes read and written [GB/s]."""
    a, b = (cuda.device_array(size // 4, np.float32) for _ in range(2))
    return 2 * size / fastest(lambda: b.copy_to_device(a), cuda.synchronize, 10) / 1e9


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument(
        "--cells", type=int, nargs="+", default=in_form([64, 128, 256], [8]), help="along y and z; twice along x"
    )
    options.add_argument("--times", type=int, default=in_form(20, 1), help="calls of which the fastest counts")
    options.add_argument("--out", type=Path, help="write what was found to this file")
    options.add_argument("--keep", type=Path, help="state what such a file holds on the page on GPUs")
    chosen = options.parse_args()
    if chosen.keep:
        sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
        from pages import stated  # noqa: PLC0415

        stated.keep("bench_gpu", json.loads(chosen.keep.read_text(encoding="utf-8")))
        stated.main()
        return
    if not cuda.is_available():
        print("There is no card of NVIDIA that numba can use; NUMBA_ENABLE_CUDASIM=1 tries the arithmetic without one.")
        return
    found = {"card": "simulated", "copied": 0.0}
    if not numba.config.ENABLE_CUDASIM:
        name = cuda.get_current_device().name
        found = {"card": name.decode() if isinstance(name, bytes) else str(name), "copied": copied()}
    print(f"{found['card']}: copies its memory at {found['copied']:.0f} GB/s", flush=True)
    threads = sorted({1, min(2, numba.config.NUMBA_NUM_THREADS)})
    for n in chosen.cells:
        cells = 2 * n, n, n
        for piece, tell in (("advance", tell_advance), ("cycle", tell_cycle)):
            spent, card, apart, launches = tell(cells, chosen.times, threads)
            per_cell = 1e9 / prod(cells)
            found |= {f"{piece}_{n}_card": per_cell * card, f"{piece}_{n}_apart": apart}
            found[f"{piece}_{n}_launch"] = 1e6 * card / launches
            found |= {f"{piece}_{n}_{count}": per_cell * time for count, time in spent.items()}
            beside = (
                f"{per_cell * time:.2f} on {count} thread(s): {time / card:.0f} times" for count, time in spent.items()
            )
            size = " x ".join(map(str, cells))
            print(
                f"{size}, {piece}: the card {per_cell * card:.3f} ns a cell, {', '.join(beside)}; {apart:.1e} apart",
                flush=True,
            )
            if not apart < CLOSE:
                raise SystemExit(
                    f"{piece}: the card's result is {apart:.2g} of the largest value away; {CLOSE:g} is allowed."
                )
    if chosen.out:
        chosen.out.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
