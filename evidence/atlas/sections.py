"""Drag and added mass of elliptic sections that move to and fro in water at rest: what a section of a body feels.

No published row hangs on these flows but that of the round section (``in_line`` is the same flow on a finer grid);
``tools/sections.py`` computes them, and ``water.sections`` reads the table that it leaves.
"""

import csv
from collections.abc import Mapping
from functools import partial
from io import StringIO
from pathlib import Path

import numpy as np

from evidence.atlas.case import Case, Curves, RunEffort, grids, published
from evidence.atlas.marching import march, middles
from evidence.atlas.outcome import FlowOutcome
from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.core.files import write
from suchus.core.progress import Progress
from suchus.flow import morison
from suchus.swimming.water.sections import ASPECTS, COLUMNS, HELD_OUT, KEULEGANS, STOKES, TABLE, held_out_errors

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
        grids=grids((cells,), _PERIODS), quick_effort=RunEffort(cells=8, until=2.0), code=_CODE,
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


def points() -> dict[str, tuple[float, float, int]]:
    """Return aspect, Keulegan number and cells a height of every flow of the table by its name, nodes first."""
    cells = {case.name: case.full.cells for case in cases()}
    nodes = [(aspect, keulegan) for aspect in ASPECTS for keulegan in KEULEGANS]
    found = {name_of(*point): point for point in (*nodes, *HELD_OUT)}
    finer = {name: point for point in FINER for name in cells if name.startswith(f"{name_of(*point)}_")}
    return {name: (*point, cells[name]) for name, point in (found | finer).items()}


def measured(instants: int = 200) -> tuple[float, float]:
    """Return Cd and Ca of a round section at KC 5, Re 100, fitted to the published force over a period [-].

    Args:
        instants: at which the published curve is read, linear in between.

    Source: Dütsch, Durst, Becker and Lienhart 1998, J. Fluid Mech. 360, 249-271, fig. 10, as ``atlas`` ships it.
    """
    curve, keulegan, time = published("duetsch1998_force"), 5.0, np.arange(instants) / instants
    force = np.interp(time, curve.values("t_over_period"), curve.values("force"), period=1.0)
    return morison(time, keulegan**2 * force, frequency=1.0, speed=keulegan, diameter=1.0, density=1.0)


def write_table(outcomes: Mapping[str, FlowOutcome], path: Path = TABLE) -> str:
    """Write the table of finished flows, and return what it says of itself.

    Args:
        outcomes: of ``cases``, by name.
        path: of the table.

    Raises:
        InvalidDesign: a flow failed or is missing.
        Unwritable: the place cannot be written to.
    """
    out = StringIO()
    print(
        f"# Oscillating ellipses in water at rest, beta {STOKES:g}; made by tools/sections.py from "
        "evidence.atlas.sections. Points between the nodes are held out.",
        file=out,
    )
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for name, (aspect, keulegan, cells) in points().items():
        if name not in outcomes or outcomes[name].failed:
            why = outcomes[name].failed if name in outcomes else "it was not computed"
            raise InvalidDesign(f"the table of sections lacks the flow {name}: {why}; compute it first.")
        found = outcomes[name].curves
        before, last = ([float(found[part][1][i]) for part in ("drag", "added", "left")] for i in (-2, -1))
        numbers = (*last[:2], *before[:2], last[2])
        writer.writerow([aspect, keulegan, cells, *(f"{value:.5g}" for value in numbers), outcomes[name].digest])
    write(path, out.getvalue())
    errors = held_out_errors(path)
    return f"{len(points())} flows; held-out points are off by {errors.max():.1%} at most"
