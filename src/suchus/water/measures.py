"""Numbers read from the records of a held and of a free swim; how each is defined stands here."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

SYMMETRIC = 0.15
"""Forces half a cycle apart count as mirrored if they differ by less than this part of the force at T/4 [-]."""
DIAGONAL = 0.1
"""A force is diagonal if neither of its parts is below this part of the other [-]."""


class Quarters(NamedTuple):
    """What the article says of T/4, T/2, 3T/4 and T, in that order."""

    difference: list[float]
    """Mean pressure along the convex side of the tail less that along the concave side [Pa]."""
    place: list[float]
    """Where the difference sits: the mean place along the tail, root 0 to tip 1, weighted with its size [-]."""
    thrust: list[float]
    """Force forward [N/m]."""
    aside: list[float]
    """Force to the right [N/m]."""

    @classmethod
    def of(cls, held: xr.Dataset) -> "Quarters":
        """Read them from a record of ``tether``."""
        at = held.interp(phase=held.instant.values)
        return cls(*(at[name].values.tolist() for name in cls._fields))

    @property
    def convex(self) -> bool:
        """Whether the convex side has the higher pressure at T/4."""
        return self.difference[0] > 0.0

    @property
    def diagonal(self) -> bool:
        """Whether the force at T/4 is forward and to the side."""
        ahead, aside = self.thrust[0], abs(self.aside[0])
        return ahead > DIAGONAL * aside and aside > DIAGONAL * ahead

    @property
    def falls(self) -> bool:
        """Whether the difference at T/2 is smaller than at T/4, whatever its sign."""
        return abs(self.difference[1]) < abs(self.difference[0])

    @property
    def moves(self) -> float:
        """How far the difference has moved towards the tip from T/4 to T/2, in tail lengths [-]."""
        return self.place[1] - self.place[0]

    @property
    def asymmetry(self) -> float:
        """Greatest change of the mirrored force from T/4 to 3T/4, over the greatest part of the force at T/4 [-]."""
        size = max(abs(self.thrust[0]), abs(self.aside[0]))
        apart = max(abs(self.thrust[0] - self.thrust[2]), abs(self.aside[0] + self.aside[2]))
        return apart / size if size > 0 else 0.0

    @property
    def mirrored(self) -> bool:
        """Whether the force at 3T/4 is that at T/4, left and right swapped."""
        return self.asymmetry < SYMMETRIC


def convex_higher(held: xr.Dataset) -> float:
    """Return in which share of the cycle the convex side of the tail has the higher pressure [-]."""
    return float((held.difference > 0).mean())


def level(track: np.ndarray) -> np.ndarray:
    """Return a track over whole cycles, first and last instant included, less its mean line.

    The line's slope is the way from the first to the last instant: a line of least squares would lean with a sine.
    """
    drift = (track[-1] - track[0]) * np.linspace(-0.5, 0.5, track.size)
    return np.asarray(track - drift - np.mean(track[:-1] - drift[:-1]))


def crossings(free: xr.Dataset) -> int:
    """Return how often the snout crosses its own mean line in the last two cycles: an S does so at least thrice."""
    return int(np.sum(np.diff(np.sign(level(free.snout_y.values))) != 0))


def swing(across: Float[np.ndarray, "sample station"]) -> tuple[np.ndarray, np.ndarray]:
    """Return how far each station swings to either side as a sine, and which share of its swing that sine is.

    Args:
        across: places to the side over two whole cycles, first and last instant included [m].

    Returns:
        Amplitude of the sine of one cycle, shape (station,) [m], and its share of the variance about the mean line [-].
    """
    swung = np.column_stack([level(track) for track in across.T])[:-1]
    harmonic = 2.0 * np.fft.rfft(swung, axis=0)[2] / len(swung)
    variance = np.maximum(np.mean(swung**2, axis=0), np.finfo(float).tiny)
    return np.abs(harmonic), 0.5 * np.abs(harmonic) ** 2 / variance


class Swum(NamedTuple):
    """A free swim in numbers, of its last cycle."""

    speed: float
    """Forward [m/s]."""
    gain: float
    """Of the speed over the cycle before [-]."""
    slip: float
    """Speed over that of the body wave [-]."""
    strouhal: float
    """Frequency times the way of the tail's tip from side to side, over speed [-]."""
    cost_of_transport: float
    """Power over displaced weight and speed [-]."""
    head_yaw: float
    """Amplitude of the head's direction [rad]."""

    @classmethod
    def of(cls, free: xr.Dataset, frequency: float) -> "Swum":
        """Read them from a record of ``free_swim``."""
        speed, power = float(free.speed[-1]), float(free.power[-1])
        return cls(
            speed,
            speed / float(free.speed[-2]) - 1.0 if free.speed.size > 1 else float("nan"),
            speed / float(free.wave_speed),
            frequency * float(np.ptp(level(free.tail_y.values))) / abs(speed),
            power / (float(free.weight) * abs(speed)),
            float(np.ptp(free.heading.values)) / 2,
        )


def efficiency(drag: float, speed: float, power: float) -> float:
    """Return the quasi-propulsive efficiency: the power that towing the straight body takes over that of the joints.

    Args:
        drag: of the straight body at that speed [N or N/m].
        speed: [m/s].
        power: of the joints on the water [W or W/m].

    Source: Maertens, Gao and Triantafyllou 2017, J. Fluid Mech. 813, 301.
    """
    return drag * abs(speed) / power
