"""Numbers without a unit by which swims of other sizes and in other media are compared."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from suchus.robot.design import GRAVITY

SIMILARITY: Mapping[str, str] = {
    "reynolds": "speed times length over the viscosity",
    "froude": "speed over the root of gravity times length",
    "strouhal": "frequency times the peak-to-peak amplitude of the tail's tip, over speed",
    "swimming_number": "angular frequency times the tail's way from side to side times length over the viscosity",
}
"""The numbers, and what each is."""


class SwimNumbers(NamedTuple):
    """Four numbers of a swim; the length is that of the body, the speed that of its centre of mass along its course."""

    reynolds: float
    """U L / nu: inertia over viscosity [-]."""
    froude: float
    """U / sqrt(g L): near 0.4 the bow wave is as long as the body, and a swimmer at the surface pays for it [-]."""
    strouhal: float
    """f A / U, A the way of the tail's tip from side to side: how fast it beats for what it gains; NaN at rest [-]."""
    swimming_number: float
    """Sw = 2 pi f A L / nu, what the swimmer does, without the speed that results [-].

    Source: Gazzola, Argentina and Mahadevan 2014, Nature Physics 10, 758, whose A is the same way.
    """


def swim_numbers(*, speed: float, length: float, frequency: float, swing: float, viscosity: float) -> SwimNumbers:
    """Return the numbers by which swims of other sizes are compared.

    Args:
        speed: mean speed of the centre of mass along its course; tail first it counts as forward [m/s].
        length: length of the body, snout to tail tip [m].
        frequency: frequency of the beat [Hz].
        swing: distance of the tail's tip from side to side, peak to peak [m].
        viscosity: kinematic, of the medium [m2/s].
    """
    pace = abs(speed)
    return SwimNumbers(
        reynolds=pace * length / viscosity,
        froude=pace / (GRAVITY * length) ** 0.5,
        strouhal=frequency * swing / pace if pace else float("nan"),
        swimming_number=2.0 * float(np.pi) * frequency * swing * length / viscosity,
    )
