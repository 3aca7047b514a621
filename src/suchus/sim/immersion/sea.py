"""The sea: plane waves, seas of many waves, currents that vary with depth and time."""

from dataclasses import dataclass
from math import pi, sqrt, tau

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks, Schedule, require
from suchus.core.errors import InvalidDesign
from suchus.core.physics import GRAVITY

STEEPEST = 0.142
"""Height over length beyond which waves on deep water break [-]. Source: Michell 1893."""
STEEPEST_SEA = 1 / 15
"""Significant height over the length of the peak's wave beyond which seas break [-]. Source: DNV-RP-C205, 3.5.4."""
DEEPEST = 1000.0
"""Greatest distance of the level from the world's origin [m]."""
FASTEST = 5.0
"""Greatest speed of a current [m/s]."""
_PLUMB = 1.0 - 1e-6
"""Cosine between x and the vertical beyond which forward is y [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wave:
    """Plane waves of small height on deep water, after Airy."""

    height: float
    """Height from trough to crest [m]."""
    length: float
    """Length from crest to crest [m]."""
    heading: float = 0.0
    """Direction in which they run, forward 0, to the left positive [rad]."""
    phase: float = 0.0
    """Phase at the world's origin at time 0, a crest at 0 [cycle]."""

    def __post_init__(self) -> None:
        """Refuse heights, lengths and directions outside their ranges, and waves that would break."""
        with Checks("wave", self) as check:
            check.number("height", 0.0, 100.0, "m")
            check.number("length", 0.01, 1000.0, "m")
            check.number("heading", -2 * pi, 2 * pi, "rad")
            check.number("phase", -1.0, 1.0, "cycle")
            steepness = self.height / self.length if self.length > 0 else 0.0
            check.that(
                not steepness > STEEPEST,
                f"a wave {self.height:g} m high and {self.length:g} m long is steeper than {STEEPEST:g}, where waves "
                f"break: at this length at most {STEEPEST * self.length:.3g} m are allowed",
            )

    @property
    def frequency(self) -> float:
        """Frequency of the wave on deep water, sqrt(g / (2 pi length)) [Hz]."""
        return sqrt(GRAVITY / (tau * self.length))


@dataclass(frozen=True, slots=True, kw_only=True)
class Current:
    """A horizontal current, which may change with depth and over time."""

    velocity: tuple[float, float] = (0.0, 0.0)
    """Velocity at the surface, forward and to the left [m/s]."""
    shear: tuple[float, float] = (0.0, 0.0)
    """Change of the velocity per metre upward, forward and to the left [1/s]; above the level it is as at the level."""
    factor: Schedule = 1.0
    """Factor on ``velocity`` over time [-], as ``((0.0, 0.0), (10.0, 1.0))`` for a current that sets in."""

    def __post_init__(self) -> None:
        """Refuse velocities and factors outside their ranges."""
        with Checks("current", self) as check:
            check.each("velocity", ("forward", "left"), -FASTEST, FASTEST, "m/s")
            check.each("shear", ("forward", "left"), -FASTEST, FASTEST, "1/s")
            check.course("factor", -10.0, 10.0, "")


def sea(
    significant_height: float,
    peak_period: float,
    *,
    count: int = 24,
    peakedness: float = 3.3,
    heading: float = 0.0,
    spread: float = 0.0,
    seed: int = 0,
) -> tuple[Wave, ...]:
    """Return a sea as waves with random phases, whose heights follow JONSWAP's spectrum.

    Args:
        significant_height: four times the standard deviation of the surface [m].
        peak_period: period of the spectrum's peak [s].
        count: number of waves, 1 to 200 [-].
        peakedness: factor of the peak; 1 is the spectrum of Pierson and Moskowitz [-].
        heading: mean direction in which they run, forward 0, to the left positive [rad].
        spread: standard deviation of the directions [rad].
        seed: seed of phases and directions.

    Raises:
        InvalidDesign: a number outside its range, or a sea that would break.

    Source: Hasselmann et al. 1973; DNV-RP-C205, 3.5.5.
    """
    require("sea", "significant_height", significant_height, 0.0, 30.0, "m")
    require("sea", "peak_period", peak_period, 0.1, 30.0, "s")
    require("sea", "count", count, 1, 200, "")
    require("sea", "peakedness", peakedness, 1.0, 10.0, "")
    require("sea", "spread", spread, 0.0, pi, "rad")
    length = GRAVITY * peak_period**2 / tau
    if significant_height > STEEPEST_SEA * length:
        raise InvalidDesign(
            f"a sea of significant height {significant_height:g} m and peak period {peak_period:g} s is steeper than "
            f"{STEEPEST_SEA:.3g}, where seas break: at this period at most {STEEPEST_SEA * length:.3g} m are allowed."
        )
    rng = np.random.default_rng(seed)
    edges = np.geomspace(0.6, 2.5, int(count) + 1)  # of frequency over the peak's
    ratios = np.sqrt(edges[1:] * edges[:-1])
    widths = np.where(ratios > 1.0, 0.09, 0.07)
    spectrum = ratios**-5.0 * np.exp(-1.25 * ratios**-4.0)
    spectrum *= peakedness ** np.exp(-0.5 * ((ratios - 1.0) / widths) ** 2)
    variances = spectrum * np.diff(edges)
    variances *= (significant_height / 4.0) ** 2 / variances.sum()
    directions = heading + spread * rng.standard_normal(int(count))
    directions = (directions + pi) % tau - pi
    phases = rng.uniform(-0.5, 0.5, int(count))
    return tuple(
        Wave(height=float(height), length=float(wavelength), heading=float(direction), phase=float(phase))
        for height, wavelength, direction, phase in zip(
            2.0 * np.sqrt(2.0 * variances), length / ratios**2, directions, phases, strict=True
        )
    )


def wave_rows(waves: tuple[Wave, ...], up_axis: Float[np.ndarray, "3"], gravity: float) -> Float[np.ndarray, "wave 6"]:
    """Return waves as the kernel reads them, see ``core.water_table.WAVE_WIDTH``.

    Args:
        waves: the waves, on deep water.
        up_axis: unit vector against gravity.
        gravity: its size [m/s2].
    """
    forward, leftward = level_axes(up_axis)
    rows = np.zeros((len(waves), 6))
    for row, wave in zip(rows, waves, strict=True):
        number = tau / wave.length
        direction = np.cos(wave.heading) * forward + np.sin(wave.heading) * leftward
        row[:] = wave.height / 2, *(number * direction), sqrt(gravity * number), tau * wave.phase
    return rows


def level_axes(up_axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return forward and left along the surface, as unit vectors.

    Args:
        up_axis: unit vector against gravity.
    """
    forward_axis = np.array([0.0, 1.0, 0.0]) if abs(up_axis[0]) > _PLUMB else np.array([1.0, 0.0, 0.0])
    forward = forward_axis - (forward_axis @ up_axis) * up_axis
    forward /= np.linalg.norm(forward)
    return forward, np.cross(up_axis, forward)
