"""What the flows of the atlas share: marching with progress, a finer grid, mean values over periods, a nudge."""

from collections.abc import Callable, Hashable, Sequence
from typing import Any, TypedDict, TypeVar

import numpy as np
from scipy.ndimage import map_coordinates

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.core.progress import Progress
from suchus.flow.compiled import PAD
from suchus.flow.signals import last_periods
from suchus.flow.simulation import Watcher
from suchus.flow.water import Fluid

_REPORTS = 200  # times per run that the progress is reported


def march(
    sim: flow.Simulation, until: float, progress: Progress, *, end: float | None = None, watch: Sequence[Watcher] = (),
    every: float | None = None,
) -> flow.Record:  # fmt: skip
    """Advance to a time, tell the share of the whole run that is done, and return the record.

    Args:
        sim: the simulation.
        until: time to reach [s].
        progress: told the share.
        end: when the whole run ends; None is ``until`` [s].
        watch: called ``every`` seconds.
        every: interval of ``watch`` [s]; None is a two-hundredth of the whole run.
    """
    whole = until if end is None else end
    watchers: Sequence[Watcher] = (*watch, lambda now: progress("computing", now.time / whole))
    return sim.run(until, watch=watchers, watch_interval=whole / _REPORTS if every is None else every, progress=False)


def middles(record: flow.Record) -> np.ndarray:
    """Return the times that the forces of a record belong to: they are means over the steps, shape (step,) [s]."""
    return record.time - record.step / 2


def nudged(time: float) -> tuple[float, float]:
    """Return a stream of 1 along x with a short gust across it, which starts the shedding of vortices [m/s].

    The gust lasts from 0.5 to 2.5 s, reaches 0.3 and is gone without a kink.
    """
    gust = 0.3 * np.sin(np.pi * (time - 0.5) / 2) ** 2 if 0.5 < time < 2.5 else 0.0
    return 1.0, float(gust)


def shedding(record: flow.Record, count: int) -> dict[str, np.ndarray]:
    """Return mean drag, mean lift, amplitude of the lift and Strouhal number over the last ``count`` periods.

    The coefficients are those of a body of size 1 in a stream of 1 with density 1.

    Raises:
        NotConverged: there are fewer periods.
    """
    drag, lift = 2 * record.force().T
    late = last_periods(record.time, lift, count)
    time, weights = record.time[late], record.step[late]
    mean_drag, mean_lift = (np.average(series[late], weights=weights) for series in (drag, lift))
    swing = np.sqrt(2 * np.average((lift[late] - mean_lift) ** 2, weights=weights))
    return {
        "mean drag": np.array(mean_drag), "mean lift": np.array(mean_lift), "lift amplitude": np.array(swing),
        "Strouhal": np.array(count / (time[-1] - time[0])), "largest drag": np.array(drag[late].max()),
        "largest lift": np.array(lift[late].max()),
    }  # fmt: skip


Span = tuple[float, float]
"""First and last place along an axis [m]."""


class Grids(TypedDict):
    """What a set-up says of its grids."""

    grid: flow.Grid
    """That of the bodies."""
    coarse_grid: flow.Grid | None
    """Coarser cells in all of the domain; None where the others fill it."""


def even(domain: tuple[Span, Span], *, cells: int) -> Grids:
    """Return the grids of a set-up with as many cells along a length of 1 m in all of a domain."""
    return Grids(grid=flow.Grid.covering(*domain, cell=1 / cells), coarse_grid=None)


def nested(
    domain: tuple[Span, ...], near: tuple[Span, ...], *, cells: int, ratio: int, sides: flow.Sides | None = None
) -> Grids:
    """Return the grids of a set-up with fine cells near a body and coarser ones in all of a domain.

    Args:
        domain: its ends along x and y (and z).
        near: those of the patch of fine cells.
        cells: fine cells along a length of 1 m.
        ratio: fine cells along a coarse one.
        sides: of the domain, where there are mirrors among them.
    """
    whole = flow.Grid.covering(*domain, cell=ratio / cells, sides=sides)
    return Grids(grid=whole.patch(*near, ratio=ratio), coarse_grid=whole)


_FORMED: dict[Hashable, Any] = {}
Formed = TypeVar("Formed")


def formed(key: Hashable, form: Callable[[], Formed]) -> Formed:
    """Return the flow, or flows, in which a wake has formed, from which each grid of a case goes on; the last are kept.

    So that the three grids of a case, which begin from one state, compute it once in a process. It is read only.

    Args:
        key: all that decides it.
        form: computes it.
    """
    if key not in _FORMED:
        made = form()
        _FORMED.clear()
        _FORMED[key] = made
    found: Formed = _FORMED[key]
    return found


def refined(coarse: flow.Simulation, setup: flow.Setup) -> flow.Simulation:
    """Return a simulation that begins at time 0 with the velocity and pressure of another one, linear in between.

    Bodies begin where ``setup`` has them at time 0, so a periodic motion goes on if the other run ended with a whole
    period. Only for grids that rest. A patch begins with what the other's patch holds, as far as that reaches.

    Raises:
        InvalidDesign: the two domains do not begin and end at the same places.
    """
    ours, theirs = ((now.coarse_grid or now.grid) for now in (setup, coarse.setup))
    here, there = (np.array([grid.origin, np.add(grid.origin, grid.size)]) for grid in (ours, theirs))
    if np.abs(here - there).max() > 1e-6 * theirs.cell:
        raise InvalidDesign(
            f"a grid from {ours.origin} m of size {ours.size} m cannot go on from one from {theirs.origin} m of size "
            f"{theirs.size} m; give both the same corners."
        )
    fine = flow.Simulation(setup)
    whole, *finer = reversed(coarse.water.layers)
    for layer in fine.water.layers:
        _take_over(layer, whole, everywhere=True)
        for known in finer:
            _take_over(layer, known, everywhere=False)
    return fine


def _take_over(layer: Fluid, known: Fluid, *, everywhere: bool) -> None:
    """Write velocity and pressure of other water to a layer, where that reaches or, beyond it, as at its ends."""
    ratio = layer.grid.cell / known.grid.cell
    shift = [(a - b) / known.grid.cell for a, b in zip(layer.grid.origin, known.grid.origin, strict=True)][::-1]
    for name, offsets in (("u", (0.5, 0.0)), ("v", (0.0, 0.5)), ("p", (0.5, 0.5))):
        field, old = getattr(layer, name), getattr(known, name)
        at = [
            (np.arange(n) - PAD + o) * ratio + s + PAD - o
            for n, o, s in zip(field.shape, offsets, shift, strict=True)
        ]  # fmt: skip
        spans = [
            slice(*np.searchsorted(a, (PAD, n - PAD - 1), "left")) for a, n in zip(at, old.shape, strict=True)
        ] if not everywhere else [slice(None)] * field.ndim  # fmt: skip
        places = np.meshgrid(*(a[span] for a, span in zip(at, spans, strict=True)), indexing="ij")
        if places[0].size:
            field[tuple(spans)] = map_coordinates(np.asarray(old, float), places, order=1, mode="nearest")
