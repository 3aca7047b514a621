"""What the flows of the atlas share: marching with progress, a finer grid, mean values over periods, a nudge."""

from collections.abc import Callable, Hashable, Sequence

import numpy as np
from scipy.ndimage import map_coordinates

from suchus import flow
from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.signals import last_periods
from suchus.flow.simulation import Watcher
from suchus.progress import Progress

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
    return sim.run(until, watch=watchers, every=whole / _REPORTS if every is None else every, progress=False)


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


_FORMED: dict[Hashable, flow.Simulation] = {}


def formed(key: Hashable, form: Callable[[], flow.Simulation]) -> flow.Simulation:
    """Return the flow in which a wake has formed, from which each grid of a case goes on; the last one is kept.

    So that the three grids of a case, which begin from one state, compute it once in a process. It is read only.

    Args:
        key: all that decides it.
        form: computes it.
    """
    if key not in _FORMED:
        made = form()
        _FORMED.clear()
        _FORMED[key] = made
    return _FORMED[key]


def refined(coarse: flow.Simulation, setup: flow.Setup) -> flow.Simulation:
    """Return a simulation that begins at time 0 with the velocity and pressure of another one, linear in between.

    Bodies begin where ``setup`` has them at time 0, so a periodic motion goes on if the other run ended with a whole
    period. Only for grids that rest.

    Raises:
        InvalidDesign: the two grids do not begin and end at the same places.
    """
    ours, theirs = setup.grid, coarse.setup.grid
    here, there = (np.array([grid.origin, np.add(grid.origin, grid.size)]) for grid in (ours, theirs))
    if np.abs(here - there).max() > 1e-6 * theirs.cell:
        raise InvalidDesign(
            f"a grid from {ours.origin} m of size {ours.size} m cannot go on from one from {theirs.origin} m of size "
            f"{theirs.size} m; give both the same corners."
        )
    fine = flow.Simulation(setup)
    ratio = ours.cell / theirs.cell
    for name, offsets in (("u", (0.5, 0.0)), ("v", (0.0, 0.5)), ("p", (0.5, 0.5))):
        field, old = getattr(fine.water, name), getattr(coarse.water, name)
        at = [(np.arange(n) - PAD + o) * ratio + PAD - o for n, o in zip(field.shape, offsets, strict=True)]
        field[:] = map_coordinates(
            np.asarray(old, float), np.meshgrid(*at, indexing="ij"), order=1, mode="nearest"
        )  # fmt: skip
    return fine
