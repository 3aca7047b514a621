"""The body wave of swimming, and what its constants may mean.

The article prints y = (c1 x + c2 x^2) sin(k x + omega t) with c1 = 0.027, c2 = 0.30, k = 0.023 and no unit
for any of them, nor a value for omega. ``READINGS`` holds every reading that was tried, A to K; ``reading``
makes a wave in SI units of one of them. With x from head to tail a wave that swims forward has the sign -1,
the printed one +1.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

from suchus.article.paper.tables import C1, C2, K
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.kinds import show
from suchus.robot.kinematics.given import check_broadcast, number, numbers
from suchus.robot.kinematics.links import Numbers

MILLIMETRE, CENTIMETRE = 1e-3, 1e-2
_MAX_COEFFICIENT = 1e12  # of a wave's numbers in SI units


@dataclass(frozen=True, slots=True, kw_only=True)
class TravellingWave:
    """A travelling wave under a growing envelope, in SI units."""

    linear: float
    """c1, the envelope's slope at the origin [-]."""
    quadratic: float
    """c2, half of the envelope's curvature [1/m]."""
    wave_number: float
    """k [rad/m]."""
    angular_frequency: float
    """omega [rad/s]."""
    sign: int
    """Sign of omega t: -1 runs from head to tail, +1 from tail to head, as printed [-]."""

    def __post_init__(self) -> None:
        with Checks("wave", self) as check:
            check.that(self.sign in (1, -1), f"wave.sign is {show(self.sign)}; 1 or -1 is allowed")
            for name in ("linear", "quadratic", "wave_number", "angular_frequency"):
                check.number(name, -_MAX_COEFFICIENT, _MAX_COEFFICIENT, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class UnitReading:
    """One choice of units for the printed constants."""

    meaning: str
    """Units of the constants, and origin of x."""
    envelope_unit: float
    """Unit of x and y in the envelope [m]; zero stands for one body length."""
    wave_number: float
    """k [rad/m]; zero stands for one wave per body length."""
    tail_only: bool
    """Whether x begins at the root of the tail instead of the snout."""
    verdict: str
    """Evidence for or against it."""


PER_MM, PER_CM = K / MILLIMETRE, K / CENTIMETRE
CYCLES_PER_CM, DEG_PER_MM = 2 * pi * PER_CM, pi / 180 * PER_MM

READINGS: Mapping[str, UnitReading] = MappingProxyType(
    {
        name: UnitReading(meaning=meaning, envelope_unit=unit, wave_number=k, tail_only=tail, verdict=verdict)
        for name, meaning, unit, k, tail, verdict in (
            ("A", "all SI, x from the snout", 1.0, K, False, "consistent, but a sway: 0.004 waves per body"),
            ("B", "envelope SI, k in rad/mm", 1.0, PER_MM, False, "impossible: slopes of 82 deg"),
            ("C", "envelope SI, k in rad/cm", 1.0, PER_CM, False, "possible; three times a fish's amplitude"),
            ("D", "all in millimetres", MILLIMETRE, PER_MM, False, "absurd: 300 m amplitude"),
            ("E", "all in centimetres", CENTIMETRE, PER_CM, False, "absurd: 30 m amplitude"),
            ("F", "tail only, all SI", 1.0, K, True, "sane amplitude, no wave"),
            ("G", "tail only, k in rad/mm", 1.0, PER_MM, True, "impossible: over 100 deg per joint"),
            ("H", "tail only, k in rad/cm", 1.0, PER_CM, True, "sane amplitude, a fifth of a wave"),
            ("I", "in body lengths, one wave per body", 0.0, 0.0, False, "ordinary for a fish; the default"),
            ("J", "envelope SI, k in cycles/cm", 1.0, CYCLES_PER_CM, False, "impossible: 179 deg per joint"),
            ("K", "envelope SI, k in deg/mm", 1.0, DEG_PER_MM, False, "no wave"),
        )
    }
)
"""The readings of (20) that were tried, by letter."""


def reading(
    name: str, *, length: float, angular_frequency: float, sign: int = -1, waves_per_body: float = 1.0
) -> TravellingWave:
    """Return the wave of (20) under one of ``READINGS``.

    Args:
        name: letter of the reading.
        length: length of the body [m]; only reading I depends on it.
        angular_frequency: omega, which the article does not give [rad/s].
        sign: sign of omega t; 1 as printed.
        waves_per_body: wavelengths along the body [-]; only reading I depends on it.

    Raises:
        UnknownName: there is no such reading.
        InvalidDesign: the length or the number of waves is not positive.
    """
    if name not in READINGS:
        raise UnknownName("reading of (20)", name, READINGS)
    length, waves_per_body = number(length, "the length"), number(waves_per_body, "waves_per_body")
    if not (length > 0 and waves_per_body > 0 and np.isfinite(length * waves_per_body)):
        raise InvalidDesign(
            f"length is {length!r} m and waves_per_body {waves_per_body!r}; both must be positive and finite."
        )
    unit_reading = READINGS[name]
    if unit_reading.envelope_unit:
        quadratic, k = C2 / unit_reading.envelope_unit, unit_reading.wave_number
    else:
        wavelength = 2 * pi / PER_MM  # the body of 0.273 m for which c2 would have been found [m]
        quadratic, k = C2 * wavelength / length, 2 * pi * waves_per_body / length
    return TravellingWave(linear=C1, quadratic=quadratic, wave_number=k, angular_frequency=angular_frequency, sign=sign)


def printed_wave(*, angular_frequency: float) -> TravellingWave:
    """Return (20) letter by letter: reading A, running from tail to head."""
    return reading("A", length=1.0, angular_frequency=angular_frequency, sign=1)


def envelope(wave: TravellingWave, x: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return the amplitude [m] at ``x`` [m], measured from the head towards the tail."""
    place = numbers(x, "the place", finite=False)
    return np.asarray((wave.linear + wave.quadratic * place) * place)


def displacement(wave: TravellingWave, x: Numbers, t: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return how far the midline lies off the axis.

    Args:
        wave: the wave.
        x: along the axis from the head towards the tail [m].
        t: time [s]; it broadcasts against ``x``.

    Returns:
        To the side [m].

    Paper: Eq. (20).
    """
    return np.asarray(envelope(wave, x) * np.sin(_phase(wave, x, t)))


def slope(wave: TravellingWave, x: Numbers, t: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return the midline's slope dy/dx [-]; arguments as for ``displacement``."""
    place, phase = numbers(x, "the place", finite=False), _phase(wave, x, t)
    growth = wave.linear + 2 * wave.quadratic * place
    return np.asarray(growth * np.sin(phase) + wave.wave_number * envelope(wave, place) * np.cos(phase))


def speed(wave: TravellingWave, x: Numbers, t: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return the midline's sideways speed dy/dt [m/s]; arguments as for ``displacement``."""
    rate = wave.sign * wave.angular_frequency
    return np.asarray(rate * envelope(wave, x) * np.cos(_phase(wave, x, t)))


def _phase(wave: TravellingWave, x: Numbers, t: Numbers) -> np.ndarray:
    place, time = numbers(x, "the place", finite=False), numbers(t, "the time", finite=False)
    check_broadcast(place, time, label="place and time")
    return np.asarray(wave.wave_number * place + wave.sign * wave.angular_frequency * time)
