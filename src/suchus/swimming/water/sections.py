"""Drag and added mass of elliptic sections: a table that was computed by the flow solver.

The sections oscillate in water at rest, see ``evidence.atlas.sections``. Between the nodes the logarithms are linear in
those of aspect and Keulegan-Carpenter number. The table has a Stokes number of 20, that is Reynolds numbers of 20 to
400. The robot's Stokes number is 3600; docs/amphibious.md describes the consequences.
"""

import csv
from functools import lru_cache
from math import pi, sqrt
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.interpolate import RegularGridInterpolator

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.robot.design.water import Water

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
TABLE = Path(__file__).parent / "data" / "sections.csv"
"""The table that is shipped."""
COLUMNS = ("aspect", "keulegan", "cells", "drag", "added", "drag_before", "added_before", "left", "digest")
"""Columns of the table."""


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
    added_mass: float
    """Added mass over that of the same section in ideal water, Ca [-]."""
    previous_drag: float
    """Cd of the period before [-]."""
    previous_added_mass: float
    """Ca of the period before [-]."""
    residual: float
    """Rms of the force that drag and added mass do not explain, over that of the force [-]."""
    digest: str
    """Hash of set-up and code of the flow."""


def attached_coefficients(keulegan: float, stokes: float = STOKES) -> tuple[float, float]:
    """Return drag coefficient and added mass of a round section in attached flow [-].

    Args:
        keulegan: number of Keulegan and Carpenter, small [-].
        stokes: number of Stokes, large [-].

    Source: Stokes 1851; Wang 1968, J. Fluid Mech. 32, 55-68.
    """
    layer = 1.0 / sqrt(pi * stokes)
    drag = 1.5 * pi**3 / keulegan * (layer + layer**2 - 0.25 * layer**3)
    return drag, 1.0 + 4.0 * layer + layer**3


def correction_factors(
    half_width: Float[np.ndarray, " s"], half_height: Float[np.ndarray, " s"], amplitude: Float[np.ndarray, " s"]
) -> tuple[float, float]:
    """Return factors between the coefficients of a swim and those of the table, over the sections of a body [-].

    The table holds an attached viscous layer at its Stokes number; a robot's layer is much thinner, and is taken away.
    For drag, each section is weighted by the power that drag takes; for added mass, by its kinetic energy. Outside the
    table the nearest aspect and Keulegan-Carpenter number are taken.

    Args:
        half_width: half width of equally spaced sections [m].
        half_height: half height of them [m].
        amplitude: amplitude of their motion to the side [m].

    Returns:
        Factors on ``Water.cross_drag`` and on the added mass of ideal water.
    """
    solid = (half_width > 0.0) & (half_height > 0.0)  # an end that comes to a point has no section
    half_width, half_height, amplitude = half_width[solid], half_height[solid], amplitude[solid]
    aspect = np.clip(half_height / half_width, ASPECTS[0], ASPECTS[-1])
    keulegan = np.clip(pi * amplitude / half_height, KEULEGANS[0], KEULEGANS[-1])
    table_coefficients = np.array([coefficients(float(a), float(k)) for a, k in zip(aspect, keulegan, strict=True)])
    layer = np.array([attached_coefficients(float(k)) for k in keulegan])
    drag, added_mass = (
        np.maximum(table_coefficients[:, 0] - layer[:, 0], 0.0),
        table_coefficients[:, 1] - layer[:, 1] + 1.0,
    )
    power, energy = half_height * amplitude**3, (half_height * amplitude) ** 2
    return float(np.average(drag, weights=power)) / Water().cross_drag, float(np.average(added_mass, weights=energy))


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
                *(kind(row[name]) for name, kind in zip(COLUMNS, SectionFlow.__annotations__.values(), strict=True))
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
        path: path of the table.

    Raises:
        InvalidDesign: outside the table.
    """
    for name, value, nodes in (("aspect", aspect, ASPECTS), ("keulegan", keulegan, KEULEGANS)):
        if not nodes[0] <= value <= nodes[-1]:
            raise InvalidDesign(f"{name} is {value:g}; the table of sections holds {nodes[0]:g} to {nodes[-1]:g}.")
    drag, added_interpolator = _interpolators(path)
    log_point = np.log([[aspect, keulegan]])
    return float(np.exp(drag(log_point)[0])), float(np.exp(added_interpolator(log_point)[0]))


def held_out_errors(path: Path = TABLE) -> Float[np.ndarray, "point 2"]:
    """Return the relative errors of interpolated Cd and Ca at the points that are not nodes [-]."""
    flows = {
        (section_flow.aspect, section_flow.keulegan): section_flow
        for section_flow in table(path)
        if (section_flow.aspect, section_flow.keulegan) in HELD_OUT
    }
    pairs = [(coefficients(*point, path), (flows[point].drag, flows[point].added_mass)) for point in HELD_OUT]
    return np.array(
        [[abs(estimate / reference - 1.0) for estimate, reference in zip(*pair, strict=True)] for pair in pairs]
    )


@lru_cache(maxsize=4)
def _interpolators(path: Path) -> tuple[RegularGridInterpolator, RegularGridInterpolator]:
    """Return the interpolators of the logarithms of drag coefficient and added mass in the logarithms of the nodes."""
    nodes = {
        (section_flow.aspect, section_flow.keulegan): section_flow for section_flow in reversed(table(path))
    }  # the coarser grid comes first
    axes = np.log(ASPECTS), np.log(KEULEGANS)
    values = np.array(
        [[nodes[a, k][3:5] for k in KEULEGANS] for a in ASPECTS],
        dtype=float,
    )  # fmt: skip
    drag, added_mass = (RegularGridInterpolator(axes, np.log(values[..., i])) for i in (0, 1))
    return drag, added_mass
