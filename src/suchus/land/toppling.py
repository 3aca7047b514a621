"""The smallest push that topples: a scan of forces, then a finer one below the first that does."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.errors import InvalidDesign
from suchus.land.push import Push
from suchus.land.run import Run
from suchus.land.simulation import simulate


def smallest_pushes(
    runs: Sequence[Run],
    directions: Sequence[tuple[float, float, float]],
    *,
    at: float,
    levels: Sequence[float],
    fell: Callable[[xr.Dataset], xr.DataArray],
    finer: int = 4,
    lasting: float = 0.2,
    body: str = "thorax",
    wait: float = 3.0,
    timestep: float = 0.005,
    progress: Callable[[float], None] = lambda _: None,
) -> Float[np.ndarray, "run direction"]:
    """Return the smallest push that topples each run in each direction [N].

    All levels of all runs and directions go into one batch; then ``finer`` forces between the last level that was
    survived and the first that was not go into another. A robot that falls at one force and not at a greater one
    counts as falling. Where no level topples, the answer is infinite.

    Args:
        runs: without pushes of their own.
        directions: unit vectors in the world: forward, left, up.
        at: when the push begins [s].
        levels: forces to try, increasing [N].
        fell: tells from a record which runs fell, along the dimension ``run``; its last sample is ``wait`` after the
            push.
        finer: number of forces of the second batch; the answer is off by at most the gap between two of them.
        lasting: how long the push lasts [s].
        body: what is pushed.
        wait: how long is waited for the fall [s].
        timestep: of the physics [s].
        progress: called with the share that is done.

    Raises:
        InvalidDesign: the levels do not increase from above zero.
    """
    scan = np.array([0.0, *levels])
    if len(scan) < 2 or np.any(np.diff(scan) <= 0):
        raise InvalidDesign(f"levels are {tuple(levels)}; increasing forces above 0 N are needed.")

    def topples(forces: np.ndarray, report: Callable[[float], None]) -> np.ndarray:
        """Tell which of the forces, shape (run, direction, force) [N], topple."""
        batch = [
            replace(run, pushes=(Push(force=_along(way, force), at=at, duration=lasting, body=body),))
            for run, ways in zip(runs, forces, strict=True)
            for way, some in zip(directions, ways, strict=True)
            for force in some
        ]
        record = simulate(batch, duration=at + lasting + wait, timestep=timestep, every=10, progress=report)
        return np.asarray(fell(record).values, dtype=bool).reshape(forces.shape)

    shape = len(runs), len(directions)
    coarse = topples(np.broadcast_to(scan[1:], (*shape, len(levels))), lambda share: progress(0.6 * share))
    first = np.where(coarse.any(axis=-1), coarse.argmax(axis=-1), len(levels))
    low, high = scan[first], np.append(scan[1:], np.inf)[first]
    steps = np.arange(1, finer + 1) / (finer + 1)
    between = low[..., None] + steps * (np.where(np.isfinite(high), high, low + 1.0) - low)[..., None]
    within = high
    if finer:
        fine = topples(between, lambda share: progress(0.6 + 0.4 * share))
        found = np.take_along_axis(between, fine.argmax(axis=-1)[..., None], axis=-1)[..., 0]
        within = np.where(fine.any(axis=-1), found, high)
    progress(1.0)
    return np.where(np.isfinite(high), within, np.inf)


def _along(direction: tuple[float, float, float], force: float) -> tuple[float, float, float]:
    x, y, z = direction
    return float(x * force), float(y * force), float(z * force)
