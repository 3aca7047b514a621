"""Flows around a cylinder that rests in a stream: diameter, speed and density are 1."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from evidence.atlas.case import LONG_STEP, Case, Curves, RunEffort, grids
from evidence.atlas.marching import (
    Grids,
    Span,
    even,
    formed,
    march,
    middles,
    nested,
    nudged,
    refined,
    shedding,
)
from evidence.atlas.skin import WallValues, read_skin
from suchus import flow
from suchus.core.progress import Progress, staged

_CODE = ("cylinders.py", "marching.py", "skin.py", "case.py")
_PERIODS = 5  # of shedding, over which the wake at Re 100 is averaged
_READINGS = 0.1  # [s] between two readings of the skin
_INSTANTS = ((0.5, "0p5"), (1.5, "1p5"))  # [s] at which the skin of the started cylinder at Re 1000 is read
_SETTLED = 8.0  # [s] on the finer grid until the wake is its own
_WIDE, _NEAR = ((-8.0, 16.0), (-8.0, 8.0)), ((-1.25, 4.75), (-1.5, 1.5))  # [m]; of a wake, and of its fine cells
_FINER = 2
"""Times as many cells around a cylinder and its wake's vortices where they form as in the rest of the domain [-]."""
_WIDEST, _NEAR_STEADY = ((-16.0, 32.0), (-16.0, 16.0)), ((-1.5, 5.0), (-1.75, 1.75))  # [m]
"""The same of a steady wake, which sheds nothing that would need cells as fine, but is long and wide.

In 24 x 16 m its drag is 1.2 % less (docs/flow_limits.md), the largest error of the row that is known.
"""
_FINER_STEADY = 4
"""Times as many cells around the cylinder and its recirculation, where the wake is steady [-]."""
_THIN, _NEAR_THIN = ((-2.5, 3.5), (-2.0, 2.0)), ((-0.8, 2.0), (-0.85, 0.85))  # [m]; of a start with a thin layer
_FINER_THIN = 4
"""Times as many cells around the started cylinder and the vortices that it sheds, whose layer is thin [-]."""

Stream = tuple[float, float] | Callable[[float], tuple[float, float]]


def _cylinder(grids: Grids, reynolds: float) -> flow.Setup:
    return flow.Setup(
        **grids, viscosity=1 / reynolds, stream=(1.0, 0.0), coarse=True, courant=LONG_STEP,
        bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0)),),
    )  # fmt: skip


def wake_length(sim: flow.Simulation) -> float:
    """Return the length of the recirculation behind a cylinder at the origin, from its rear; 0 if there is none [m]."""
    x = sim.setup.grid.x
    behind = x[(x > 0.5 + 1.5 * sim.setup.grid.cell) & (x < x[-2])]
    u = sim.probe(np.stack([behind, np.zeros_like(behind)], axis=1)).velocity[:, 0]
    back = np.flatnonzero(u < 0)
    if not back.size or back[-1] + 1 == behind.size:
        return 0.0
    k = back[-1]
    return float(behind[k] - u[k] * (behind[k + 1] - behind[k]) / (u[k + 1] - u[k]) - 0.5)


def _started(effort: RunEffort, progress: Progress, *, reynolds: float, domain: tuple[Span, Span]) -> Curves:
    return _from_start(flow.Simulation(_cylinder(even(domain, cells=effort.cells), reynolds)), effort, progress)


def _started_finely(effort: RunEffort, progress: Progress, *, reynolds: float) -> Curves:
    grids = nested(_THIN, _NEAR_THIN, cells=effort.cells, ratio=_FINER_THIN)
    return _from_start(flow.Simulation(_cylinder(grids, reynolds)), effort, progress)


def _from_start(sim: flow.Simulation, effort: RunEffort, progress: Progress) -> Curves:
    lengths: list[tuple[float, float]] = []

    def note(now: flow.Simulation) -> None:
        lengths.append((now.time, wake_length(now)))

    record = march(sim, effort.until, progress, watch=(note,), every=0.05)
    return {"drag": np.stack([middles(record), 2 * record.force()[:, 0]]), "length": np.array(lengths).T}


def _started_skin(effort: RunEffort, progress: Progress) -> Curves:
    """Compute the started cylinder at Re 1000 with its parts of the drag and the vorticity on it at two instants."""
    sim = flow.Simulation(_cylinder(nested(_THIN, _NEAR_THIN, cells=effort.cells, ratio=_FINER_THIN), 1000.0))
    parts: list[tuple[float, float]] = []

    def note(now: flow.Simulation) -> None:
        parts.append((now.time, read_skin(now).friction(now.setup.viscosity)))

    instants = {}
    for instant, name in _INSTANTS:
        if instant < effort.until:
            march(sim, instant, progress, end=effort.until, watch=(note,), every=_READINGS / 2)
            instants[f"vorticity {name}"] = read_skin(sim).curve("vorticity")
    record = march(sim, effort.until, progress, watch=(note,), every=_READINGS / 2)
    time, drag = middles(record), 2 * record.force()[:, 0]
    at, friction = np.array(parts).T
    return {
        **instants, "drag": np.stack([time, drag]), "friction": np.stack([at, friction]),
        "pressure part": np.stack([at, np.interp(at, time, drag) - friction]),
    }  # fmt: skip


def turning(time: float) -> flow.Pose:
    """Return the pose of a cylinder that turns in its place, its skin as fast as the stream."""
    return flow.Pose(angle=2.0 * time, spin=2.0)


def _turning(effort: RunEffort, progress: Progress) -> Curves:
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=turning)
    grids = even(((-4.0, 10.0), (-5.0, 5.0)), cells=effort.cells)
    sim = flow.Simulation(replace(_cylinder(grids, 200.0), bodies=(body,)))
    record = march(sim, effort.until, progress)
    return {"drag": np.stack([middles(record), 2 * record.force()[:, 0]])}


def _steady(effort: RunEffort, progress: Progress) -> Curves:
    fine = nested(_WIDEST, _NEAR_STEADY, cells=effort.cells, ratio=_FINER_STEADY)
    sim = _on_two_grids(effort, 40.0, (1.0, 0.0), progress, _WIDEST, fine)
    record = march(sim, effort.until, staged(progress, "fine grid", 0.5, 1.0))
    skin = read_skin(sim)
    return {
        "drag": np.array(2 * record.select_after(0.8 * effort.until).force()[:, 0].mean()),
        "wake length": np.array(wake_length(sim)), "pressure": skin.curve("pressure"),
    }  # fmt: skip


def _shedding(effort: RunEffort, progress: Progress) -> Curves:
    fine = nested(_WIDE, _NEAR, cells=effort.cells, ratio=_FINER)
    sim = _on_two_grids(effort, 100.0, nudged, progress, _WIDE, fine)
    skins: list[tuple[float, WallValues]] = []

    def note(now: flow.Simulation) -> None:
        skins.append((now.time, read_skin(now)))

    record = march(sim, effort.until, staged(progress, "fine grid", 0.5, 1.0), watch=(note,), every=_READINGS)
    numbers = shedding(record.select_after(_SETTLED), _PERIODS)
    since = effort.until - _PERIODS / float(numbers["Strouhal"])
    late = [skin for time, skin in skins if time > since]
    mean = np.mean([skin.pressure for skin in late], axis=0)
    both = WallValues(angle=late[0].angle, pressure=mean, vorticity=mean)
    return {**numbers, "pressure": both.curve("pressure")}


def _on_two_grids(
    effort: RunEffort, reynolds: float, stream: Stream, progress: Progress, domain: tuple[Span, Span], fine: Grids
) -> flow.Simulation:
    """Return a wake in a domain that has formed on the coarse grid, at the start of its time on the fine."""

    def form() -> flow.Simulation:
        wake = flow.Simulation(replace(_cylinder(even(domain, cells=effort.coarse), reynolds), stream=stream))
        march(wake, effort.initial_duration, staged(progress, "coarse grid", 0.0, 0.5))
        return wake

    wake = formed(("cylinder", reynolds, effort.coarse, effort.initial_duration), form)
    return refined(wake, _cylinder(fine, reynolds))


_PATCH = "a patch of 6 x 3 diameters around it, half of them elsewhere"
_PATCH_THIN = "a patch of 2.8 x 1.7 diameters around it and what it sheds, a quarter of them elsewhere"

CASES = (
    Case(
        name="started_re40", run=partial(_started, reynolds=40.0, domain=((-5.0, 7.0), (-5.0, 5.0))),
        grids=grids((48, 32, 24), 5.0), quick_effort=RunEffort(cells=12, until=1.0), code=_CODE,
        setup="A cylinder that starts at once in water at rest; {cells} cells a diameter, unbounded "
        "domain, of which 12 x 10 diameters are computed. The length of the recirculation ends where the velocity on "
        "the axis is zero.",
    ),
    Case(
        name="started_re550", run=partial(_started, reynolds=550.0, domain=((-2.5, 4.0), (-2.5, 2.5))),
        grids=grids((96, 64, 48), 3.5), quick_effort=RunEffort(cells=16, until=1.0), code=_CODE,
        setup="The same in 6.5 x 5 diameters, {cells} cells a diameter.",
    ),
    Case(
        name="started_re3000", run=partial(_started_finely, reynolds=3000.0),
        grids=grids((256, 192, 128), 3.0), quick_effort=RunEffort(cells=48, until=0.5), code=_CODE,
        setup=f"The same in 6 x 4 diameters, {{cells}} cells a diameter in {_PATCH_THIN}.",
    ),
    Case(
        name="started_re1000", run=_started_skin, grids=grids((192, 128, 96), 2.8),
        quick_effort=RunEffort(cells=48, until=1.6), code=_CODE,
        setup=f"The same in 6 x 4 diameters, {{cells}} cells a diameter in {_PATCH_THIN}. Friction is the integral of "
        "the vorticity at the wall, the pressure part the force exchanged less that.",
    ),
    Case(
        name="turning_re200", run=_turning, grids=grids((48, 32, 24), 12.0),
        quick_effort=RunEffort(cells=16, until=1.0), code=_CODE,
        setup="A cylinder that starts at once to move and to turn, in an unbounded domain, of which 14 x 10 diameters "
        "are computed; {cells} cells a diameter.",
    ),
    Case(
        name="steady_re40", run=_steady, code=_CODE, grids=grids((32, 24, 16), 20.0, coarse=8, before=80.0),
        quick_effort=RunEffort(cells=16, until=1.0, coarse=6, initial_duration=2.0),
        setup="A cylinder in a stream, in an unbounded domain, of which 48 x 32 diameters are computed; 80 diameters "
        "of travel with {coarse} cells a diameter and twenty with {cells} in a patch of 6.5 x 3.5 diameters around it, "
        "a quarter of them elsewhere.",
    ),
    Case(
        name="shedding_re100", run=_shedding, code=_CODE, grids=grids((32, 24, 16), 45.0, coarse=12, before=80.0),
        quick_effort=RunEffort(cells=16, until=45.0, coarse=8, initial_duration=50.0),
        setup="A cylinder in a stream with a short gust at the start, in an unbounded domain, of which 24 x 16 "
        f"diameters are computed; 80 diameters of travel with {{coarse}} cells a diameter and 45 with {{cells}} in "
        f"{_PATCH}; means over the last five periods of shedding.",
    ),
)  # fmt: skip
"""The flows of this module."""
