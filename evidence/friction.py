"""Friction of a boundary layer on a body whose layer no grid carries: a law along stations, and its band.

The friction at a station is that of a flat plate whose layer has the same momentum thickness. A layer that is laminar
to the end has the least friction, a layer that is turbulent from the nose on the most: the two are the band. The law
holds where the layer stays attached, not behind a separation. It leaves out the effect of the layer on the pressure.

Sources: Blasius 1908, Z. Math. Phys. 56, 1-37, and Thwaites 1949, Aeronaut. Q. 1, 245-280, with the girth after Mangler
1948, Z. angew. Math. Mech. 28, 97-103 (laminar); ITTC 1957, 8th International Towing Tank Conference, Madrid, the
correlation line of ship models, and Truckenbrodt 1952, Ing.-Arch. 20, 211-228 (turbulent).
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign

MIN_TURBULENT_REYNOLDS = 2e4
"""Reynolds number below which no layer is turbulent; the friction of the turbulent end is laminar up to there [-]."""


class FrictionBand(NamedTuple):
    """A quantity at the two ends of the law."""

    laminar: float
    """Where the layer is laminar to the end of the body."""
    turbulent: float
    """Where it is turbulent from the nose on."""


def along_stations(
    arc: Float[np.ndarray, " station"],
    girth: Float[np.ndarray, " station"],
    speed: Float[np.ndarray, " station"],
    *,
    viscosity: float,
    density: float,
    slope: Float[np.ndarray, " station"] | float = 1.0,
) -> FrictionBand:
    """Return the force of friction along a body whose layer stays attached [N].

    Between two stations girth, speed and slope are taken as even and the layer grows as on a plate, so that on a plate
    the result is exact for any stations. Where the body widens or the water gains speed the layer is thinner than a
    plate's of the same length, and it rubs more.

    Args:
        arc: distance of the stations from the nose along the body, rising [m].
        girth: wetted [m].
        speed: of the water beside the layer against the skin, towards the tail [m/s].
        viscosity: kinematic [m^2/s].
        density: [kg/m^3].
        slope: cosine of the angle between the skin and the direction of the force [-].

    Raises:
        InvalidDesign: stations that do not rise from 0 on, a girth that is negative, a speed that is not positive
            somewhere between the ends, or numbers that are not finite.
    """
    slope = np.broadcast_to(np.asarray(slope, float), arc.shape)
    _check(arc, girth, speed, slope)
    if not (np.isfinite([viscosity, density]).all() and viscosity > 0 and density > 0):
        raise InvalidDesign(
            f"viscosity is {viscosity:.4g} m^2/s and density {density:.4g} kg/m^3; both must be above 0."
        )
    mean_girth, mean_speed, mean_slope = (0.5 * (a[1:] + a[:-1]) for a in (girth, speed, slope))
    forces = []
    for total, (of_girth, of_speed) in ((_laminar_total, _LAMINAR), (_turbulent_total, _TURBULENT)):
        end, start = _plate(arc, mean_girth, mean_speed, of_girth, of_speed)
        rubbed = total(mean_speed * end / viscosity) - total(mean_speed * start / viscosity)
        forces.append(float((0.5 * density * mean_speed * viscosity * mean_girth * mean_slope * rubbed).sum()))
    return FrictionBand(*forces)


_LAMINAR, _TURBULENT = (2.0, 5.0), (7.0 / 6.0, 10.0 / 3.0)
"""Powers of girth and speed that weight the history of a layer, laminar and turbulent [-]."""


def _plate(
    arc: np.ndarray, mean_girth: np.ndarray, mean_speed: np.ndarray, of_girth: float, of_speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lengths of the plates whose layers are those at the end and at the start of each interval [m].

    Args:
        arc: distance of the stations from the nose [m].
        mean_girth: of each interval [m].
        mean_speed: of each interval [m/s].
        of_girth: power of the girth with which the layer grows [-].
        of_speed: power of the speed with which the layer grows [-].
    """
    growth = (mean_girth / max(mean_girth.max(), 1e-300)) ** of_girth * (mean_speed / mean_speed.max()) ** of_speed
    ds = np.diff(arc)
    accumulated_growth = growth[0] * arc[0] + np.concatenate([[0.0], np.cumsum(growth * ds)[:-1]])
    start = np.divide(accumulated_growth, growth, out=np.zeros_like(growth), where=growth > 0)
    return start + ds, start


def _laminar_total(reynolds: Float[np.ndarray, " *n"]) -> Float[np.ndarray, " *n"]:
    """Return the integral of a laminar plate's local coefficient over the Reynolds number from 0 on."""
    return 1.328 * np.sqrt(reynolds)


def _turbulent_total(reynolds: Float[np.ndarray, " *n"]) -> Float[np.ndarray, " *n"]:
    """Return the integral of a turbulent plate's local coefficient over the Reynolds number, up to a constant."""

    def line(number: Float[np.ndarray, " *n"]) -> Float[np.ndarray, " *n"]:
        return np.asarray(0.075 * number / (np.log10(number) - 2.0) ** 2)

    turbulent_reynolds = np.maximum(reynolds, MIN_TURBULENT_REYNOLDS)
    return _laminar_total(np.minimum(reynolds, MIN_TURBULENT_REYNOLDS)) + line(turbulent_reynolds)


def _check(arc: np.ndarray, girth: np.ndarray, speed: np.ndarray, slope: np.ndarray) -> None:
    """Refuse stations for which the law does not hold; see ``along_stations``."""
    if not (arc.ndim == 1 and arc.shape == girth.shape == speed.shape and arc.size >= 2):
        raise InvalidDesign(
            f"stations have shape {arc.shape}, girths {girth.shape} and speeds {speed.shape}; give three rows of as "
            f"many numbers, two at least."
        )
    if not (np.isfinite(arc).all() and arc[0] >= 0 and (np.diff(arc) > 0).all()):
        raise InvalidDesign(f"stations go from {arc[0]:.4g} to {arc[-1]:.4g} m; give rising distances from the nose.")
    if not (np.isfinite(girth).all() and girth.min() >= 0):
        raise InvalidDesign(f"the girth is {girth.min():.4g} m at least; give finite numbers, none negative.")
    if not (np.isfinite(speed).all() and speed.min() >= 0 and (speed[1:-1] > 0).all()):
        raise InvalidDesign(
            f"the speed of the water along the body is {speed.min():.4g} m/s at least; the law is for water that runs "
            f"towards the tail everywhere: give positive numbers."
        )
    if not (np.isfinite(slope).all() and np.abs(slope).max() <= 1):
        raise InvalidDesign(f"the slope is up to {np.abs(slope).max():.4g}; it is a cosine: give numbers from -1 to 1.")
