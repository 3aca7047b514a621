"""Coefficients of what a body's form does in water: drag of nose, blunt end and folded limbs, and what its tail sheds.

A table of pieces has the nose alone, and lets momentum leave at its last strip alone; ``formed`` gives it the rest.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.core.water_table import BALL, column

NOSE_DRAG = 0.1
"""Drag coefficient of the nose of every table of pieces, over the greatest section [-]; streamlined noses have 0.05 to
0.2 (Hoerner 1965, Fluid-Dynamic Drag, chapter 3)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyForm:
    """What the form of a body feels; the defaults are what sections have without one."""

    head_drag: float = NOSE_DRAG
    """Drag coefficient of the head, over the greatest section [-]."""
    base_drag: float = 0.0
    """Drag coefficient of the blunt end, over the section of the last strip [-]."""
    limb_drag: float = 0.0
    """Drag coefficient of a limb along the stream, over the section of its thickest link [-]."""
    edge_shedding: float = 1.0
    """Share of the lateral momentum of the last strip that is shed [-]."""
    taper_shedding: float = 0.0
    """Share that is shed of the lateral momentum that strips of the rear half lose to those behind them [-]."""

    def __post_init__(self) -> None:
        """Refuse coefficients outside their ranges."""
        with Checks("form", self) as check:
            for name in ("head_drag", "base_drag", "limb_drag"):
                check.number(name, 0.0, 10.0, "")
            for name in ("edge_shedding", "taper_shedding"):
                check.number(name, 0.0, 2.0, "")


def formed(table: Float[np.ndarray, "piece column"], form: BodyForm) -> Float[np.ndarray, "piece column"]:
    """Return a table of pieces with what a form adds.

    Args:
        table: pieces of a robot, strips of its axis first, from head to tail, see ``pieces``.
        form: its coefficients.
    """
    result = np.array(table)
    last = _last_strip(table)
    column(result, "end")[0] *= form.head_drag / NOSE_DRAG
    half = column(table, "half")
    column(result, "end")[last] += form.base_drag * np.pi * half[last, 0] * half[last, 1]
    _shed(result, last, form)
    first = last + 1
    for foot in np.flatnonzero(table[:, 1] == BALL).tolist():  # of each limb the foot is the last piece
        column(result, "end")[first] += form.limb_drag * np.pi * half[first:foot, 0].max() ** 2
        first = foot + 1
    return result


def shed_momenta(table: Float[np.ndarray, "piece column"], form: BodyForm) -> Float[np.ndarray, " strip"]:
    """Return the lateral momentum that each strip of the axis sheds, over density, speed and lateral velocity [m2].

    Args:
        table: pieces of a robot, as ``formed`` takes them.
        form: coefficients of its form.
    """
    last = _last_strip(table)
    momentum = np.pi * column(table, "half")[: last + 1, 1] ** 2
    lost = np.zeros(last + 1)
    rear = slice((last + 1) // 2, last + 1)
    greatest_behind = np.maximum.accumulate(momentum[rear][::-1])[::-1]
    lost[rear][:-1] = greatest_behind[:-1] - greatest_behind[1:]
    lost *= form.taper_shedding
    lost[last] = form.edge_shedding * momentum[last]
    return lost


def _shed(table: Float[np.ndarray, "piece column"], last: int, form: BodyForm) -> None:
    """Write what the strips shed into a table; up and down the last strip alone sheds, as without a form."""
    momenta = shed_momenta(table, form)
    column(table, "shed")[: last + 1, 0] = momenta
    column(table, "shed_at")[: last + 1, 0] = np.where(momenta > 0.0, -column(table, "half")[: last + 1, 2], 0.0)


def _last_strip(table: Float[np.ndarray, "piece column"]) -> int:
    """Return the row of the last strip of the axis: the one that sheds in every table."""
    return int(np.flatnonzero(column(table, "shed")[:, 0] > 0.0)[-1])
