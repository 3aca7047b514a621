"""Resolution of a body's boundary layer by a grid, and the resulting error of its forces.

The boundary layer is ``L / sqrt(Re)`` thick. In the plane, the estimated error is ``0.14 n^-1.5`` of the force for
``n`` cells across the layer. The estimate is a least-squares fit to errors of this solver in cases with a better
reference:

* impulsively started cylinder at Re 3000: 20 % with n = 0.88 (48 cells a diameter), and 2.6 % with 3.5;
* impulsively started cylinder at Re 550: 4.5 % with n = 2.05, and 0.7 % with 4.1;
* cylinder in a stream at Re 185: 9 % with n = 1.18, and 5 % with 1.76;
* NACA 0012: 18 % with n = 0.91 at Re 5000, and 4 % with 2.0 at Re 1000.

The fit is within a factor of 1.3 of each error except that of the finest grid, which is smaller. The error of the drag
in the DFG channel is ten times smaller.

For a blunt body in space, the estimate is ``0.09 n^-2.25``. The reference is the drag of a sphere, 20 diameters after
its start, extrapolated from 16 to 32 cells a diameter. The drag was too large by 14.1, 5.9, 3.0 and 1.2 % at Re 100
with 0.80, 1.20, 1.60 and 2.40 cells, and by 27, 13.1, 7.2 and 3.0 % at Re 200 with 0.57, 0.85, 1.13 and 1.70 cells. The
fit is within a factor of 1.25 of each error. Less is known about long and bending bodies in space, which have the
estimate of the plane.

Both estimates hold for laminar layers that are attached up to a corner or a wake. They do not include the errors of an
unresolved wake or of a small domain.
"""

from math import inf, sqrt

SKIN_SUM = 0.02, 0.06
"""How much the drag by pressure and friction along the skin is low on a cylinder at Re 100, on 31 and 16 cells a
diameter [-]; ``make validate`` checks it."""

SKIN_FRICTION = 0.08, 0.16
"""How much the drag by friction alone is low on a cylinder that is started at once, Re 550, on 96 and 48 cells a
diameter, where the layer is 4 and 2 cells thin [-]; ``make validate`` checks it."""

SKIN_SPHERE = 0.10, 0.20
"""How much the drag by pressure and friction over the skin is low on a sphere at Re 50, 0.6 diameters after its start,
on 16 and 8 cells a diameter [-]."""

SKIN_PEAK = 0.2
"""How much the peak wall vorticity of a cylinder at Re 185 is low on 24 cells a diameter [-]; docs/flow_limits.md."""

ALONG_THE_SKIN = (
    f"Read from points one to three cells off the wall: pressure and friction are {100 * SKIN_SUM[0]:.0f} to "
    f"{SKIN_SUM[1]:.0%} low in sum where pressure is most of it, friction alone {100 * SKIN_FRICTION[0]:.0f} to "
    f"{SKIN_FRICTION[1]:.0%} where its layer is 4 to 2 cells thin, and more where they peak (the peak wall vorticity "
    f"of a cylinder at Re 185 by {SKIN_PEAK:.0%} at 24 cells a diameter). On a sphere at Re 50 that has just started "
    f"both together are {100 * SKIN_SPHERE[0]:.0f} to {SKIN_SPHERE[1]:.0%} low with 16 to 8 cells a diameter. Forces "
    "from the momentum exchanged are not."
)
"""Statement of the error of ``Surface`` and ``Record.surface_force``, for the caption of each plot of them."""

MAX_FORCE_ERROR = 0.2
"""Estimated relative error of the force above which a grid is refused [-]."""

WARNING_FORCE_ERROR = 0.1
"""Estimated relative error of the force above which a warning is issued [-]."""

_ERROR_AT_ONE_CELL, _ORDER = (0.14, 0.09), (1.5, 2.25)  # in the plane, of a blunt body in space


def cells_across(length: float, speed: float, viscosity: float, cell: float) -> float:
    """Return the cells across the boundary layer of a body; infinite below Reynolds number 1, where there is none.

    Args:
        length: length of the body [m].
        speed: fastest speed of its surface through the water [m/s].
        viscosity: kinematic [m^2/s].
        cell: side of a cell [m].
    """
    reynolds = speed * length / viscosity
    return inf if reynolds < 1 else length / sqrt(reynolds) / cell


def estimate_force_error(cells: float, *, is_compact: bool = False) -> float:
    """Return the estimated relative error of the force on a body [-].

    Args:
        cells: across the boundary layer [-].
        is_compact: whether it is a blunt body in space.
    """
    return 0.0 if cells == inf else _ERROR_AT_ONE_CELL[is_compact] * cells ** -_ORDER[is_compact]


def required_cells(error: float, *, is_compact: bool = False) -> float:
    """Return the cells across the boundary layer at which the estimated error of the force has a value [-].

    Args:
        error: relative error of the force [-].
        is_compact: whether it is a blunt body in space.
    """
    return float((_ERROR_AT_ONE_CELL[is_compact] / error) ** (1 / _ORDER[is_compact]))
