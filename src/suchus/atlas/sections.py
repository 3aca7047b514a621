"""Drag and added mass of elliptic sections that move to and fro in water at rest: what a section of a body feels.

No published row hangs on these flows but that of the round section (``in_line`` is the same flow on a finer grid);
``tools/sections.py`` computes them, and ``water.sections`` reads the table that it leaves.
"""

from functools import partial

import numpy as np

from suchus import flow
from suchus.atlas.case import Case, Curves, RunEffort, grids
from suchus.atlas.marching import march, middles
from suchus.core.progress import Progress

STOKES = 20.0
"""Number beta of Stokes, frequency times height squared over viscosity: the Reynolds number over that of Keulegan [-].

That of Dütsch et al. 1998, with whom the round section is compared; a larger one asks for finer cells.
"""
ASPECTS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Height across the motion over thickness along it, of the nodes of the table [-]."""
KEULEGANS = (1.0, 2.2, 5.0, 10.0, 20.0)
"""Numbers of Keulegan and Carpenter, largest speed over frequency and height, of the nodes of the table [-]."""
HELD_OUT = ((0.35, 3.3), (0.7, 1.5), (0.7, 7.0), (1.4, 3.3), (1.4, 14.0), (2.8, 1.5), (2.8, 7.0), (0.35, 7.0))
"""Aspects and Keulegan numbers that are between the nodes and not in the table [-]."""
FINER = ((1.0, 5.0), (4.0, 5.0))
"""Points that are computed on a finer grid too."""
_CELLS, _FINE, _MARGIN, _PERIODS = 16, 24, 3.0, 3.0
_CODE = ("sections.py", "marching.py")


def name_of(aspect: float, keulegan: float, cells: int = _CELLS) -> str:
    """Return the name of the flow of a section."""
    return f"section_{aspect:g}_{keulegan:g}" + (f"_on_{cells}" if cells != _CELLS else "")


def _moved(effort: RunEffort, progress: Progress, *, aspect: float, keulegan: float) -> Curves:
    """Compute a section of height 1 that moves with ``-keulegan cos(2 pi t)``; read every period but the first."""
    swing, thickness = keulegan / (2 * np.pi), 1 / aspect
    shape = flow.Cylinder(diameter=1.0) if aspect == 1.0 else flow.Ellipse(length=thickness, width=1.0)
    along, across = swing + thickness / 2 + _MARGIN, 0.5 + _MARGIN
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid.covering((-along, along), (-across, across), cell=1 / effort.cells), viscosity=1 / STOKES,
            bodies=(flow.Body(shape=shape, motion=flow.Oscillation(frequency=1.0, heave=(-swing, 0.0))),), coarse=True,
        )
    )  # fmt: skip
    record = march(sim, effort.until, progress)
    time, force = middles(record), record.force()[:, 0]
    rows = []
    for period in range(1, round(effort.until)):
        k = (time > period) & (time <= period + 1)
        drag, added = flow.morison(time[k], force[k], frequency=1.0, speed=keulegan, diameter=1.0, density=1.0)
        u, du = -keulegan * np.cos(2 * np.pi * time[k]), 2 * np.pi * keulegan * np.sin(2 * np.pi * time[k])
        left = force[k] + 0.5 * drag * np.abs(u) * u + 0.25 * np.pi * added * du
        rows.append((period + 0.5, drag, added, float(np.sqrt(np.mean(left**2) / np.mean(force[k] ** 2)))))
    middle, drag, added, left = np.array(rows).T
    return {"drag": np.stack([middle, drag]), "added": np.stack([middle, added]), "left": np.stack([middle, left])}


def _case(aspect: float, keulegan: float, cells: int = _CELLS) -> Case:
    return Case(
        name=name_of(aspect, keulegan, cells), run=partial(_moved, aspect=aspect, keulegan=keulegan),
        grids=grids((cells,), _PERIODS), quick=RunEffort(cells=8, until=2.0), code=_CODE,
        setup=f"A section {aspect:g} times as high as thick that oscillates across its height in water at rest, KC "
        f"{keulegan:g}, beta {STOKES:g}; {_MARGIN:g} heights of water around its path in an unbounded domain, "
        "{cells} cells a height; three periods from rest.",
    )  # fmt: skip


def cases() -> tuple[Case, ...]:
    """Return the flows of nodes, held-out points and finer grids, the shortest first."""
    nodes = [_case(aspect, keulegan) for keulegan in KEULEGANS for aspect in ASPECTS]
    between = [_case(*point) for point in HELD_OUT]
    finer = [_case(*point, cells=_FINE) for point in FINER]
    return (*nodes[:15], *finer, *between, *nodes[15:])
