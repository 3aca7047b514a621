"""Spheres in space, in the quarter of a box between two planes of symmetry: diameter, speed and density are 1."""

import numpy as np

from evidence.atlas.case import Case, Curves, RunEffort, grids
from evidence.atlas.marching import march, middles, nested
from suchus import flow
from suchus.core.progress import Progress

_CODE = ("spheres.py", "marching.py")
_SIDES = flow.Sides(bottom=flow.Mirror(), low=flow.Mirror())
_AREA = np.pi / 4  # [m^2]; of the sphere, seen from the front
_RATE = 3.2  # [rad/s]; of the sphere that oscillates
_LATE = 2.0  # [s] at the end of the steady flow, over which is averaged


def swung(time: float) -> flow.Pose:
    """Return the pose of a sphere that moves with the velocity ``sin(3.2 t)`` along x."""
    turn = _RATE * time
    return flow.Pose(position=(-float(np.cos(turn)) / _RATE, 0.0, 0.0), velocity=(float(np.sin(turn)), 0.0, 0.0))


def _steady(effort: RunEffort, progress: Progress) -> Curves:
    grid = flow.Grid.covering((-2.0, 4.0), (0.0, 2.0), (0.0, 2.0), cell=1 / effort.cells, sides=_SIDES)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=1 / 150, stream=(1.0, 0.0, 0.0), sides=_SIDES, coarse=True,
            bodies=(flow.Body(shape=flow.Sphere(diameter=1.0)),),
        )
    )  # fmt: skip
    late = march(sim, effort.until, progress).select_after(effort.until - min(_LATE, 0.5 * effort.until))
    return {"drag": np.array(np.average(2 * late.force()[:, 0] / _AREA, weights=late.step))}


def _oscillating(effort: RunEffort, progress: Progress) -> Curves:
    grids = nested(
        ((-3.0, 3.0), (0.0, 3.0), (0.0, 3.0)), ((-1.5, 1.5), (0.0, 1.25), (0.0, 1.25)), cells=effort.cells, ratio=2,
        sides=_SIDES,
    )  # fmt: skip
    sim = flow.Simulation(
        flow.Setup(
            **grids, viscosity=1 / 40, sides=_SIDES, coarse=True, stream=(0.0, 0.0, 0.0),
            bodies=(flow.Body(shape=flow.Sphere(diameter=1.0), motion=swung),),
        )
    )  # fmt: skip
    period = 2 * np.pi / _RATE
    record = march(sim, effort.until * period, progress)
    cycles = middles(record) / period
    last = cycles > effort.until - 1
    return {"drag": np.stack([cycles[last] - effort.until + 1, 2 * record.force()[last, 0] / _AREA])}


CASES = (
    Case(
        name="sphere_re150", run=_steady, code=_CODE, grids=grids((24, 16, 12), 20.0),
        quick_effort=RunEffort(cells=8, until=1.0),
        setup="A sphere in a stream that starts at once, in an unbounded domain, of which 6 x 4 x 4 diameters are "
        "computed, a quarter of them beside two planes of symmetry; {cells} cells a diameter; mean of the last two of "
        "twenty diameters of travel, after which the drag is steady to 0.3 %.",
    ),
    Case(
        name="oscillating_sphere", run=_oscillating, code=_CODE, grids=grids((32, 24, 16), 2.0),
        quick_effort=RunEffort(cells=16, until=1.0),
        setup="A sphere that oscillates in water at rest, Re 40; unbounded domain, of which 6 x 6 x 6 diameters are "
        "computed, a quarter of them beside two planes of symmetry; {cells} cells a diameter in a patch of 3 x 2.5 x "
        "2.5 diameters around its path, half of them elsewhere; the second period, as in the source.",
    ),
)  # fmt: skip
"""The flows of this module."""
