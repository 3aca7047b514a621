"""Pieces beside each other: what the kernel computes of some pieces at a time, one quantity in each row.

The numbers of the table of pieces stand beside each other likewise. Spatial quantities are MuJoCo's: rotation
first, about the point of reference, the centre of mass of the tree to which the body belongs.
"""

from typing import NamedTuple

from suchus.core.water_table import COLUMNS
from suchus.sim.hydro.vectors import Vector

(
    KIND, CENTRE_IN_BODY, AXIS_A, AXIS_B, AXIS_T, HALF, VOLUME, AIR, ADDED_MASS, AREA, SKIN, END, ROLL, SHED_MASS,
    SHED_POSITION,
) = (
    COLUMNS[name][0]
    for name in ("kind", "at", "across", "upward", "forward", "half", "volume", "air", "added", "area", "skin", "end",
                 "roll", "shed", "shed_at")
)  # fmt: skip
"""Rows of the table of pieces."""
TURN = 0
"""Row of the orientation of the body (9)."""
ORIGIN = TURN + 9
"""Row of the origin of the body (3) [m]."""
REFERENCE = ORIGIN + 3
"""Row of the point of reference (3) [m]."""
MOVING = REFERENCE + 3
"""Row of the spatial velocity of the body (6)."""
BIAS = MOVING + 6
"""Row of its spatial acceleration without that of the joints (6)."""
E_A = BIAS + 6
"""Row of the axis e_a in the world (3)."""
E_B = E_A + 3
"""Row of e_b (3)."""
E_T = E_B + 3
"""Row of t (3)."""
CENTRE = E_T + 3
"""Row of the centre (3) [m]."""
LEVER = CENTRE + 3
"""Row of the centre from the point of reference (3) [m]."""
ELEVATION = LEVER + 3
"""Row of the height of the surface above the level [m]."""
STREAM = ELEVATION + 1
"""Row of the velocity of the water (3) [m/s]."""
SURGE = STREAM + 3
"""Row of its acceleration (3) [m/s2]."""
DEPTH = SURGE + 3
"""Row of the depth of the centre over the half extent against gravity [-]."""
ARM = DEPTH + 1
"""Row of the point highest up under the centre's plane, from the centre (3) [m]."""
AGAINST = ARM + 3
"""Row of the velocity of the centre against the water, in the world (3) [m/s]."""
SPEED = AGAINST + 3
"""Row of the same along e_a, e_b and t (3) [m/s]."""
TURBULENT = SPEED + 3
"""Row of the coefficient of turbulent friction, 0 where it does not count [-]."""
WET_FRACTION = TURBULENT + 1
"""Row of the share under water [-]."""
WET_VOLUME = WET_FRACTION + 1
"""Row of the volume under water [m3]."""
FIRST_SUM = WET_VOLUME + 1
"""First row of what is added up over the pieces of a body."""
ROTATIONAL_INERTIA = FIRST_SUM
"""Row of the moments that resist rotation: the lower half, row by row (6) [kg m2]."""
COUPLING_INERTIA = ROTATIONAL_INERTIA + 6
"""Row of the forces that resist rotation: three rows (9) [kg m]."""
LINEAR_INERTIA = COUPLING_INERTIA + 9
"""Row of the forces that resist motion: the lower half, row by row (6) [kg]."""
FORCE = LINEAR_INERTIA + 9
"""Row of the force (3) [N], after that of the couple (3) [N m]."""
SUMS = 28
"""Rows that are added up, one of them empty: four numbers are added at once [-]."""
ROWS = FIRST_SUM + SUMS
"""Rows in all."""
NORMAL = ROWS
"""Row of the surface's normal at a shape (3) [-]."""
OFFSET = NORMAL + 3
"""Row of the centre of buoyancy from the centre (3) [m]."""
CUT = OFFSET + 3
"""Row of the area in which the surface cuts a shape, over the shape's volume [1/m]."""
CUT_OFFSET = CUT + 1
"""Row of the middle of that area from the centre (3) [m]."""
SHAPE_ROWS = CUT_OFFSET + 3
"""Rows in all for shapes."""
LOAD_VOLUME = SUMS - 1
"""Place, among what is added up, of the volume under water of a shape [m3]."""


class WaterProperties(NamedTuple):
    """What the water is, read once."""

    level: float
    """Height of the surface above the world's origin, against gravity, without waves [m]."""
    density: float
    """Density of the water [kg/m3]."""
    air_fraction: tuple[float, float]
    """Shares of the hull's air that are kept, in the front and in the rear chambers [-]."""
    viscosity: float
    """Kinematic viscosity [m2/s]."""
    cross_drag: float
    """Drag coefficient of a section across [-]."""
    thickening: float
    """Factor on plate friction [-]."""
    added_mass_factor: float
    """Factor on added mass [-]."""
    shedding: float
    """Factor on what is shed at the tail [-]."""
    splash: float
    """Fraction of what the change of added mass at the surface moves that is lost [-]."""
    up_axis: Vector
    """Unit vector against gravity."""
    gravity: float
    """Its size [m/s2]."""
    length: float
    """Length of the body, for its Reynolds number [m]."""
