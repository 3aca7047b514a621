"""The cross-section of a flying snake in a stream: chord, speed and density are 1."""

from functools import partial

import numpy as np

from evidence.atlas.case import LONG_STEP, Case, Curves, RunEffort, grids, published
from evidence.atlas.marching import Grids, formed, march, middles, nested, refined
from suchus import flow
from suchus.core.progress import Progress, staged
from suchus.flow.signals import last_periods

# At a Reynolds number of 2000 these cells settle nothing: 256 a chord do, at 30 degrees; see docs/flow_limits.md. So no
# more are spent here than show the row.
_CODE = ("snake.py", "marching.py", "case.py")
_SETTLED = 8.0  # [s] on the finer grid until the wake is its own
PERIODS = 5
"""Periods, the last ones, of which the source has the Strouhal number [-]."""
_DOMAIN, _NEAR = ((-5.0, 13.0), (-6.0, 6.0)), ((-0.95, 2.25), (-0.9, 0.75))  # [m]
"""The computed part of the unbounded water, and the fine cells.

At Re 1000, on 32 cells a chord, drag, lift and Strouhal number are 4 to 5 % less than in 9 x 6 chords, at both angles;
twice the cells, in those, change them by 0.5 to 6 %. So the water far away counts for as much as the cells.
"""
_FINER = 2
"""Times as many cells around the body as in the domain [-]: the source's too are finest there and wider far away.

With four times as many the wake beyond has too few: at Re 2000 and 30 degrees on 48 cells a chord drag, lift and
Strouhal number were 9 to 12 % less than on the same cells everywhere.
"""


def _snake(effort: RunEffort, progress: Progress, *, reynolds: float, degrees: int) -> Curves:
    def near(cells: int) -> Grids:
        return nested(_DOMAIN, _NEAR, cells=cells, ratio=_FINER)

    def form() -> flow.Simulation:
        wake = flow.Simulation(_setup(near(effort.coarse), reynolds, degrees))
        march(wake, effort.initial_duration, staged(progress, "coarse grid", 0.0, 0.2))
        return wake

    wake = formed(("snake", reynolds, degrees, effort.coarse, effort.initial_duration), form)
    sim = refined(wake, _setup(near(effort.cells), reynolds, degrees))
    record = march(sim, effort.until, staged(progress, "fine grid", 0.2, 1.0))
    late = record.select_after(_SETTLED)
    drag, lift = 2 * np.average(late.force(), axis=0, weights=late.step)
    strouhal = last_strouhal(middles(late), late.force()[:, 1])
    return {"mean drag": np.array(drag), "mean lift": np.array(lift), "Strouhal": np.array(strouhal)}


def last_strouhal(time: np.ndarray, lift: np.ndarray) -> float:
    """Return the Strouhal number of the last ``PERIODS`` whole periods of a lift, as the source does [-]."""
    last = time[last_periods(time, lift, PERIODS)]
    return float(PERIODS / (last[-1] - last[0]))


def _setup(grids: Grids, reynolds: float, degrees: int) -> flow.Setup:
    table = published(f"snake_{degrees}_outline")
    outline = np.stack([table.values("x"), table.values("y")], axis=1)
    return flow.Setup(
        **grids, viscosity=1 / reynolds, coarse=True, courant=LONG_STEP,
        stream=(1.0, 0.0), bodies=(flow.Body(shape=flow.from_outline(outline)),),
    )  # fmt: skip


CASES = tuple(
    Case(
        name=f"snake_{degrees}_re{reynolds}",
        run=partial(_snake, reynolds=float(reynolds), degrees=degrees),
        grids=grids((48, 32, 24), 40.0, coarse=32, before=24.0),
        quick_effort=RunEffort(cells=32, until=26.0, coarse=24, initial_duration=6.0),
        code=_CODE,
        setup="The cross-section of a flying snake in a stream, in an unbounded domain, of which 18 x 12 chords are "
        f"computed; 24 chords of travel from rest with {{coarse}} cells a chord and 40 with {{cells}} in a patch of "
        f"{_NEAR[0][1] - _NEAR[0][0]:.1f} x {_NEAR[1][1] - _NEAR[1][0]:.2g} chords around it, half of them "
        "elsewhere; means over the last 32, the 32nd to the 64th, and the Strouhal number of the last five "
        "periods, as in the source.",
    )
    for reynolds in (1000, 2000)
    for degrees in (30, 35)
)
"""The flows of this module."""
