"""Tables I and II of the article, as printed and as they must be read.

The tables head their columns ``a_i`` and ``alpha_i``, but equations (2) to (7) use row ``i`` as ``a_(i-1)``
and ``alpha_(i-1)`` of the modified Denavit-Hartenberg convention (Craig). The SI chains follow the equations.

Before them stand the times of its experiments, and the constants of its body wave, for which it gives no units.
"""

from dataclasses import dataclass
from math import pi

CYCLE_PERIOD = 4.0
"""Duration of one crawling cycle in the experiments of section IV.A [s]: seconds 1 to 5, then 5 to 9."""
CYCLES = 2
"""Number of cycles in an experiment [-]."""
CRAWL_START = 1.0
"""Time at which the first cycle begins [s]."""
CRAWL_END = CRAWL_START + CYCLES * CYCLE_PERIOD
"""Time at which the last cycle ends [s]."""
SNAPSHOT_TIMES = (1.2, 1.5, 1.8)
"""Times at which Fig. 14 shows the robot [s]."""

C1 = 0.027
"""Linear coefficient of the envelope of the body wave, equation (20), printed without a unit."""
C2 = 0.30
"""Quadratic coefficient of the envelope, printed without a unit."""
K = 0.023
"""Wave number, printed without a unit."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedRow:
    """One row of Table I or II, under the labels that the article gives its columns."""

    i: int
    """Number of the row [-]."""
    theta: str
    """Name of the joint's angle."""
    d_mm: float
    """Column ``d_i`` [mm]."""
    a_mm: float
    """Column ``a_i`` [mm]."""
    alpha: float
    """Column ``alpha_i`` [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """A chain of modified D-H links; element ``i`` leads from frame ``i`` to frame ``i + 1``."""

    a: tuple[float, ...]
    """Along x of frame ``i``, to the next joint's axis [m]."""
    alpha: tuple[float, ...]
    """About x of frame ``i``, to the next joint's axis [rad]."""
    d: tuple[float, ...]
    """Along the next joint's axis [m]."""


def in_si(table: tuple[PrintedRow, ...]) -> Chain:
    """Return a printed table in metres, row ``i`` read as ``a_(i-1)``, ``alpha_(i-1)``, ``d_i``."""
    return Chain(
        a=tuple(row.a_mm / 1000 for row in table),
        alpha=tuple(row.alpha for row in table),
        d=tuple(row.d_mm / 1000 for row in table),
    )


TABLE_I = (
    PrintedRow(i=1, theta="theta_1", d_mm=0.0, a_mm=70.0, alpha=0.0),
    PrintedRow(i=2, theta="theta_2", d_mm=0.0, a_mm=0.0, alpha=pi / 2),
    PrintedRow(i=3, theta="theta_3", d_mm=0.0, a_mm=86.0, alpha=0.0),
    PrintedRow(i=4, theta="theta_4", d_mm=0.0, a_mm=89.0, alpha=0.0),
)
"""The hind leg, as printed."""

TABLE_II = (
    PrintedRow(i=1, theta="theta_1", d_mm=0.0, a_mm=50.5, alpha=0.0),
    PrintedRow(i=2, theta="theta_2", d_mm=0.0, a_mm=60.5, alpha=-pi / 2),
    PrintedRow(i=3, theta="theta_3", d_mm=0.0, a_mm=60.5, alpha=pi / 2),
    PrintedRow(i=4, theta="theta_4", d_mm=0.0, a_mm=60.5, alpha=-pi / 2),
    PrintedRow(i=5, theta="theta_5", d_mm=0.0, a_mm=60.5, alpha=pi / 2),
)
"""The torso, as printed."""

LEG_CHAIN = in_si(TABLE_I)
"""The hind leg in SI: ``a[0]`` to ``a[3]`` are the article's a0 to a3."""

SPINE_CHAIN = in_si(TABLE_II)
"""The torso in SI: ``a[0]`` to ``a[4]``."""

FEMUR = LEG_CHAIN.a[2]
"""From hip to knee, a2 [m]."""
TIBIA = LEG_CHAIN.a[3]
"""From knee to the end of the shank, a3 [m]."""
LIMB_REACH = FEMUR + TIBIA
"""From hip to the end of the shank of a stretched hind leg [m]."""
TAIL_JOINTS = 6
"""Number of joints of the tail's cable section, N [-] (III.C)."""
