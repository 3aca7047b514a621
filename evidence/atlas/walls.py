"""Flows between walls: the lid-driven cavity, a cylinder in a channel, one that settles in a channel."""

from functools import partial

import numpy as np

from evidence.atlas.case import LONG_STEP, Case, Curves, RunEffort, grids
from evidence.atlas.marching import Grids, formed, march, middles, refined
from suchus import flow
from suchus.core.progress import Progress, staged
from suchus.flow.signals import last_periods

_CODE = ("walls.py", "marching.py", "case.py")
_HEIGHT, _DIAMETER = 0.41, 0.1  # [m]; of the DFG channel and of its cylinder
_SHEDS = 0.5  # [m/s]; mean speed between those of the steady flow and of the one that sheds vortices
_STEADY = 0.25  # [s] at the end of the steady flow, over which is averaged
_FINER, _NEAR = 2, ((0.1, 0.6), (0.08, 0.33))
"""Times as many cells in a patch around the cylinder as in the rest of the channel where it sheds vortices [-], and
where the patch is [m].

The steady flow has the same cells everywhere: its lift, a five-hundredth of the drag, scatters with where the nodes lie
(docs/flow_limits.md), and with 47 cells a diameter near the cylinder and 12 elsewhere it was half as large.
"""
_SINKING = 2.1  # [m/s]; of the frame that a settling cylinder is seen from
_VISCOSITY = 0.008088  # [m^2/s]; of the water that it settles in


def _cavity(effort: RunEffort, progress: Progress, *, reynolds: float) -> Curves:
    n = effort.cells
    sides = flow.Sides(left=flow.Wall(), right=flow.Wall(), bottom=flow.Wall(), top=flow.Wall(speed=1.0))
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid(cells=(n, n), cell=1 / n), viscosity=1 / reynolds, sides=sides, coarse=True,
            courant=LONG_STEP,
        )
    )  # fmt: skip
    march(sim, effort.until, progress)
    mids = (np.arange(n) + 0.5) / n
    half = np.full(n, 0.5)
    up, across = sim.probe(np.stack([half, mids], axis=1)), sim.probe(np.stack([mids, half], axis=1))
    return {"u": np.stack([mids, up.velocity[:, 0]]), "v": np.stack([mids, across.velocity[:, 1]])}


def _channel(effort: RunEffort, progress: Progress, *, mean_speed: float) -> Curves:
    """Compute the DFG channel, 2.2 m long: from rest on the coarse grid, then on the finer one."""

    def form() -> flow.Simulation:
        before = flow.Simulation(_channel_setup(_even_channel(effort.coarse, effort.coarse), mean_speed))
        march(before, effort.initial_duration, staged(progress, "coarse grid", 0.0, 0.3))
        return before

    before = formed(("channel", mean_speed, effort.coarse, effort.initial_duration), form)
    steady = mean_speed < _SHEDS
    finer = _even_channel(effort.cells, effort.coarse) if steady else _fine_channel(effort.cells, effort.coarse)
    sim = refined(before, _channel_setup(finer, mean_speed))
    record = march(sim, effort.until, staged(progress, "fine grid", 0.3, 1.0))
    drag, lift = (record.force() * 2 / (mean_speed**2 * _DIAMETER)).T
    if steady:
        late = record.time > effort.until - _STEADY
        return {
            "drag": np.array(drag[late].mean()), "lift": np.array(lift[late].mean()),
            "pressure drop": np.array(_pressure_drop(sim)),
        }  # fmt: skip
    time = middles(record)
    kept = last_periods(time, lift, 5)
    return {
        "largest drag": np.array(drag[kept].max()), "least drag": np.array(drag[kept].min()),
        "largest lift": np.array(lift[kept].max()), "least lift": np.array(lift[kept].min()),
        "half the swing of the lift": np.array(0.5 * np.ptp(lift[kept])),
        "Strouhal": np.array(flow.frequency(time[kept], lift[kept]) * _DIAMETER / mean_speed),
        "lift": np.stack([time, lift]),
    }  # fmt: skip


def _even_channel(cells: int, coarse: int) -> Grids:
    """Return the grid of the DFG channel with so many cells a diameter and the same corners as on the coarse grid."""
    rows, first = _rows(cells), _rows(coarse)
    long = flow.Grid.covering((0.0, 2.2), (0.0, _HEIGHT), cell=_HEIGHT / first).cells[0]
    return Grids(grid=flow.Grid(cells=(long * rows // first, rows), cell=_HEIGHT / rows), coarse_grid=None)


def _fine_channel(cells: int, coarse: int) -> Grids:
    """Return the same with so many cells a diameter around the cylinder alone."""
    whole = _even_channel(cells // _FINER, coarse)["grid"]
    return Grids(grid=whole.patch(*_NEAR, ratio=_FINER), coarse_grid=whole)


def _channel_setup(grids: Grids, mean_speed: float) -> flow.Setup:
    """Return the DFG channel on some grids."""
    sides = flow.Sides(
        left=flow.Inflow(profile=lambda y: 6 * mean_speed * y * (_HEIGHT - y) / _HEIGHT**2), right=flow.Outflow(),
        bottom=flow.Wall(), top=flow.Wall(),
    )  # fmt: skip
    cylinder = flow.Body(shape=flow.Cylinder(diameter=_DIAMETER), motion=flow.Pose(position=(0.2, 0.2)))
    return flow.Setup(**grids, viscosity=1e-3, sides=sides, bodies=(cylinder,), coarse=True, courant=LONG_STEP)


def _rows(cells: int) -> int:
    """Return the cells across the channel with so many a diameter, a number that multigrid halves."""
    return round(_HEIGHT / _DIAMETER * cells / 16) * 16


def _pressure_drop(sim: flow.Simulation) -> float:
    """Return the pressure between the front and the rear of the cylinder in the DFG channel [Pa]."""
    surface = sim.surface()
    angle = np.arctan2(surface.markers.y - 0.2, surface.markers.x - 0.2)
    front, rear = np.interp([np.pi, 0.0], np.sort(angle), surface.pressure[np.argsort(angle)], period=2 * np.pi)
    return float(front - rear)


def _settling(effort: RunEffort, progress: Progress) -> Curves:
    """Compute a cylinder of relative density 1.5 that settles from (1, 40) in a channel of width 4; gravity is 10.

    In a frame that sinks with ``_SINKING`` the walls and the water go up, and 28 diameters of the channel are enough:
    ahead of the cylinder what it does to the water falls off with exp(-pi x / width), to 2e-3 at 8 diameters. In this
    frame it rises by three to five diameters, more on coarser cells, so that at least 15 are left for its wake.
    """
    width, low, high = 4 * effort.cells, 8.0, 20.0  # of the cylinder's start above the bottom and below the top
    grid = flow.Grid(
        cells=(width, round((low + high) * effort.cells)), cell=4.0 / width, origin=(0.0, 40.0 - low)
    )  # fmt: skip
    wall = flow.Wall(speed=_SINKING)
    sides = flow.Sides(
        left=wall, right=wall, bottom=flow.Inflow(profile=lambda x: np.full_like(x, _SINKING)), top=flow.Outflow()
    )
    body = flow.FreeBody(
        shape=flow.Cylinder(diameter=1.0), start=(1.0, 40.0), velocity=(0.0, _SINKING), density=1.5,
        gravity=(0.0, -10.0),
    )  # fmt: skip
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=_VISCOSITY, sides=sides, bodies=(body,), stream=(0.0, _SINKING), coarse=True,
            courant=LONG_STEP,
        )
    )  # fmt: skip
    record = march(sim, effort.until, progress)
    x, y, speed = (record.column(name) for name in ("x", "y", "velocity_y"))
    late = record.time > 0.6 * effort.until
    steady = _SINKING - float(np.average(speed[late], weights=record.step[late]))
    weight = (1.5 - 1.0) * 10.0 * np.pi / 4
    return {
        "path": np.stack([y - _SINKING * record.time, x - 2.0]), "Reynolds number": np.array(steady / _VISCOSITY),
        "drag": np.array(weight / (0.5 * steady**2)),
    }  # fmt: skip


CASES = (
    Case(
        name="cavity_re100", run=partial(_cavity, reynolds=100.0), grids=grids((96, 64, 48), 25.0),
        quick_effort=RunEffort(cells=16, until=3.0), code=_CODE,
        setup="A square box whose lid slides, from rest until it is steady; {cells} cells a side.",
    ),
    Case(
        name="cavity_re400", run=partial(_cavity, reynolds=400.0), grids=grids((96, 64, 48), 35.0),
        quick_effort=RunEffort(cells=16, until=3.0), code=_CODE,
        setup="A square box whose lid slides, from rest until it is steady; {cells} cells a side.",
    ),
    Case(
        name="cavity_re1000", run=partial(_cavity, reynolds=1000.0), grids=grids((128, 96, 64), 50.0),
        quick_effort=RunEffort(cells=16, until=3.0), code=_CODE,
        setup="A square box whose lid slides, from rest until it is steady; {cells} cells a side.",
    ),
    Case(
        name="dfg_2d1", run=partial(_channel, mean_speed=0.2), code=_CODE,
        grids=grids((62, 47, 31), 1.0, coarse=31, before=6.0),
        quick_effort=RunEffort(cells=16, until=0.3, coarse=8, initial_duration=0.7),
        setup="The DFG channel, 22 x 4.1 diameters: six seconds from rest with {coarse} cells a diameter and one with "
        f"{{cells}}, of which the last {_STEADY:g} s count.",
    ),
    Case(
        name="dfg_2d2", run=partial(_channel, mean_speed=1.0), code=_CODE,
        grids=grids((62, 47, 31), 2.7, coarse=16, before=6.0),
        quick_effort=RunEffort(cells=24, until=2.7, coarse=12, initial_duration=5.0),
        setup="The DFG channel, 22 x 4.1 diameters: six seconds from rest with {coarse} cells a diameter and 2.7 with "
        "{cells} in a patch of 5 x 2.5 diameters around the cylinder and where the vortices form, half of them "
        "elsewhere; the last five periods count.",
    ),
    Case(
        name="settling", run=_settling, code=_CODE, grids=grids((32, 24, 16), 46.0),
        quick_effort=RunEffort(cells=12, until=2.0),
        setup="A cylinder of relative density 1.5 that settles from rest, one diameter from a wall, in a channel 4 "
        "diameters wide, seen from a frame that sinks with 2.1 m/s: 34 diameters of the channel, {cells} cells a "
        "diameter. Means over the last two fifths of the time.",
    ),
)  # fmt: skip
"""The flows of this module."""
