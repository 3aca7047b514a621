"""Drag and added mass of elliptic sections: a table that was computed by the flow solver.

The sections oscillate in water at rest, see ``atlas.sections``. Between the nodes the logarithms are linear in those of
aspect and Keulegan-Carpenter number. The table has a Stokes number of 20, that is Reynolds numbers of 20 to 400. The
robot's Stokes number is 3600; docs/amphibious.md describes the consequences.
"""

import csv
from collections.abc import Mapping
from functools import lru_cache
from io import StringIO
from math import pi, sqrt
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.interpolate import RegularGridInterpolator

from suchus.atlas import sections
from suchus.atlas.case import published
from suchus.atlas.outcome import FlowOutcome
from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.core.files import write
from suchus.flow import morison
from suchus.robot.design.water import Water

TABLE = Path(__file__).parent / "data" / "sections.csv"
"""The table that is shipped."""
_COLUMNS = ("aspect", "keulegan", "cells", "drag", "added", "drag_before", "added_before", "left", "digest")


class SectionFlow(NamedTuple):
    """Coefficients of one section."""

    aspect: float
    """Height across the motion over thickness along it [-]."""
    keulegan: float
    """Largest speed over frequency and height, KC [-]."""
    cells: int
    """Cells a height of the flow [-]."""
    drag: float
    """Drag coefficient by height Cd of the last period [-]."""
    added: float
    """Added mass over that of the same section in ideal water, Ca [-]."""
    drag_before: float
    """Cd of the period before [-]."""
    added_before: float
    """Ca of the period before [-]."""
    left: float
    """Rms of the force that drag and added mass do not explain, over that of the force [-]."""
    digest: str
    """Of set-up and code of the flow."""


def points() -> dict[str, tuple[float, float, int]]:
    """Return aspect, Keulegan-Carpenter number and cells per height of every flow of the table, by its name."""
    cells = {case.name: case.full.cells for case in sections.cases()}
    nodes = [(aspect, keulegan) for aspect in sections.ASPECTS for keulegan in sections.KEULEGANS]
    points_by_name = {sections.name_of(*point): point for point in (*nodes, *sections.HELD_OUT)}
    fine_points = {
        name: point for point in sections.FINER for name in cells if name.startswith(f"{sections.name_of(*point)}_")
    }
    return {name: (*point, cells[name]) for name, point in (points_by_name | fine_points).items()}


def attached(keulegan: float, stokes: float = sections.STOKES) -> tuple[float, float]:
    """Return drag coefficient and added mass of a round section in attached flow [-].

    Args:
        keulegan: number of Keulegan and Carpenter, small [-].
        stokes: number of Stokes, large [-].

    Source: Stokes 1851; Wang 1968, J. Fluid Mech. 32, 55-68.
    """
    layer = 1.0 / sqrt(pi * stokes)
    drag = 1.5 * pi**3 / keulegan * (layer + layer**2 - 0.25 * layer**3)
    return drag, 1.0 + 4.0 * layer + layer**3


def likely(
    half_width: Float[np.ndarray, " s"], half_height: Float[np.ndarray, " s"], amplitude: Float[np.ndarray, " s"]
) -> tuple[float, float]:
    """Return factors between the coefficients of a swim and those of the table, over the sections of a body [-].

    The table holds an attached viscous layer at its Stokes number; a robot's layer is much thinner, and is taken away.
    For drag, each section is weighted by the power that drag takes; for added mass, by its kinetic energy. Outside the
    table the nearest aspect and Keulegan-Carpenter number are taken.

    Args:
        half_width: of equally spaced sections [m].
        half_height: of them [m].
        amplitude: of their motion to the side [m].

    Returns:
        Factors on ``Water.cross_drag`` and on the added mass of ideal water.
    """
    solid = (half_width > 0.0) & (half_height > 0.0)  # an end that comes to a point has no section
    half_width, half_height, amplitude = half_width[solid], half_height[solid], amplitude[solid]
    aspect = np.clip(half_height / half_width, sections.ASPECTS[0], sections.ASPECTS[-1])
    keulegan = np.clip(pi * amplitude / half_height, sections.KEULEGANS[0], sections.KEULEGANS[-1])
    table_coefficients = np.array([coefficients(float(a), float(k)) for a, k in zip(aspect, keulegan, strict=True)])
    layer = np.array([attached(float(k)) for k in keulegan])
    drag, added_mass = (
        np.maximum(table_coefficients[:, 0] - layer[:, 0], 0.0),
        table_coefficients[:, 1] - layer[:, 1] + 1.0,
    )
    power, energy = half_height * amplitude**3, (half_height * amplitude) ** 2
    return float(np.average(drag, weights=power)) / Water().cross_drag, float(np.average(added_mass, weights=energy))


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
    """Write the table of finished flows, and return a summary of its errors.

    Args:
        outcomes: of ``atlas.sections.cases``, by name.
        path: of the table.

    Raises:
        InvalidDesign: a flow failed or is missing.
        Unwritable: the place cannot be written to.
    """
    stream = StringIO()
    print(
        f"# Oscillating ellipses in water at rest, beta {sections.STOKES:g}; made by tools/sections.py from "
        "suchus.atlas.sections. Points between the nodes are held out.",
        file=stream,
    )
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for name, (aspect, keulegan, cells) in points().items():
        if name not in outcomes or outcomes[name].failed:
            reason = outcomes[name].failed if name in outcomes else "it was not computed"
            raise InvalidDesign(f"the table of sections lacks the flow {name}: {reason}; compute it first.")
        curves = outcomes[name].curves
        previous_values, last_values = (
            [float(curves[quantity][1][i]) for quantity in ("drag", "added", "left")] for i in (-2, -1)
        )
        numbers = (*last_values[:2], *previous_values[:2], last_values[2])
        writer.writerow([aspect, keulegan, cells, *(f"{value:.5g}" for value in numbers), outcomes[name].digest])
    write(path, stream.getvalue())
    errors = held_out(path)
    return f"{len(points())} flows; held-out points are off by {errors.max():.1%} at most"


@lru_cache(maxsize=4)
def table(path: Path = TABLE) -> tuple[SectionFlow, ...]:
    """Return all points of a table, also those that are held out and those on a finer grid.

    Raises:
        UnreadableFile: it holds something else.
    """
    try:
        lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
        rows = list(csv.DictReader(lines))
        return tuple(
            SectionFlow(
                *(kind(row[name]) for name, kind in zip(_COLUMNS, SectionFlow.__annotations__.values(), strict=True))
            )
            for row in rows
        )
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise UnreadableFile(
            f"{path} is no table of sections: {error}; make it anew with tools/sections.py."
        ) from error


def coefficients(aspect: float, keulegan: float, path: Path = TABLE) -> tuple[float, float]:
    """Return drag coefficient by height and added mass over that of ideal water of an elliptic section [-].

    Args:
        aspect: height across the motion over thickness along it, 0.25 to 4 [-].
        keulegan: largest speed over frequency and height, 1 to 20 [-].
        path: of the table.

    Raises:
        InvalidDesign: outside the table.
    """
    for name, value, nodes in (("aspect", aspect, sections.ASPECTS), ("keulegan", keulegan, sections.KEULEGANS)):
        if not nodes[0] <= value <= nodes[-1]:
            raise InvalidDesign(f"{name} is {value:g}; the table of sections holds {nodes[0]:g} to {nodes[-1]:g}.")
    drag, added_interpolator = _interpolators(path)
    log_point = np.log([[aspect, keulegan]])
    return float(np.exp(drag(log_point)[0])), float(np.exp(added_interpolator(log_point)[0]))


def held_out(path: Path = TABLE) -> Float[np.ndarray, "point 2"]:
    """Return the relative errors of interpolated Cd and Ca at the points that are not nodes [-]."""
    flows = {
        (section_flow.aspect, section_flow.keulegan): section_flow
        for section_flow in table(path)
        if (section_flow.aspect, section_flow.keulegan) in sections.HELD_OUT
    }
    pairs = [(coefficients(*point, path), (flows[point].drag, flows[point].added)) for point in sections.HELD_OUT]
    return np.array(
        [[abs(estimate / reference - 1.0) for estimate, reference in zip(*pair, strict=True)] for pair in pairs]
    )


@lru_cache(maxsize=4)
def _interpolators(path: Path) -> tuple[RegularGridInterpolator, RegularGridInterpolator]:
    """Return the interpolators of the logarithms of drag coefficient and added mass in the logarithms of the nodes."""
    nodes = {
        (section_flow.aspect, section_flow.keulegan): section_flow for section_flow in reversed(table(path))
    }  # the coarser grid comes first
    axes = np.log(sections.ASPECTS), np.log(sections.KEULEGANS)
    values = np.array(
        [[nodes[a, k][3:5] for k in sections.KEULEGANS] for a in sections.ASPECTS],
        dtype=float,
    )  # fmt: skip
    drag, added_mass = (RegularGridInterpolator(axes, np.log(values[..., i])) for i in (0, 1))
    return drag, added_mass
