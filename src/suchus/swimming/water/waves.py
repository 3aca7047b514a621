"""Waves given as curves: (20) in each of its readings, and waves of which a film gave the ends."""

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from suchus.robot.design import Robot
from suchus.robot.kinematics import wave as wave_kinematics
from suchus.robot.kinematics.wave import READINGS, TravellingWave
from suchus.swimming.water.outline import tail_root

_FINE = 2049
"""Points along a wave from which its arc length is found [-]."""


@runtime_checkable
class BodyWave(Protocol):
    """A midline that is given as a curve, x from the snout towards the tail."""

    @property
    def period(self) -> float:
        """Period of one cycle [s]."""

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis, to the right positive [m]."""

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedWave:
    """(20) on a robot, from the snout or from the root of the tail on; the body ahead of it stays straight.

    Paper: Eq. (20).
    """

    wave: TravellingWave
    """Its constants in SI units."""
    origin: float
    """Where x of the wave begins, from the snout [m]."""

    @property
    def period(self) -> float:
        """Period of one cycle [s]."""
        return 2 * np.pi / self.wave.angular_frequency

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis [m]."""
        return wave_kinematics.displacement(self.wave, np.maximum(x - self.origin, 0.0), time)

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""
        wave_slope = wave_kinematics.slope(self.wave, np.maximum(x - self.origin, 0.0), time)
        return np.where(x >= self.origin, wave_slope, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmedWave:
    """A wave with amplitudes and length from a film: ``A(x) sin 2 pi (x / wave - f t)``.

    Between snout and tail the amplitude is a parabola with zero slope at the snout. A film that gives the amplitudes of
    the ends only does not say more. Eel-like and carp-like swimmers have such envelopes (Di Santo et al. 2021, PNAS
    118, e2113206118).
    """

    length: float
    """Length of the body [m]."""
    frequency: float
    """Frequency of the wave [Hz]."""
    wavelength: float
    """Length of one whole wave [body length]."""
    head: float
    """Amplitude of the snout, half of the distance from side to side [body length]."""
    tail: float
    """Amplitude of the tail's tip, half of the distance from side to side [body length]."""

    @property
    def period(self) -> float:
        """Period of one cycle [s]."""
        return 1.0 / self.frequency

    def displacement(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return how far the midline lies off the axis [m]."""
        position = x / self.length
        phase = 2 * np.pi * (position / self.wavelength - self.frequency * time)
        return np.asarray(self.length * self._amplitude(position) * np.sin(phase))

    def slope(self, x: np.ndarray, time: np.ndarray) -> np.ndarray:
        """Return dy/dx [-]."""
        position = x / self.length
        phase = 2 * np.pi * (position / self.wavelength - self.frequency * time)
        grows = 2 * position * (self.tail - self.head)
        return np.asarray(
            grows * np.sin(phase) + self._amplitude(position) * 2 * np.pi / self.wavelength * np.cos(phase)
        )

    def _amplitude(self, position: np.ndarray) -> np.ndarray:
        return self.head + (self.tail - self.head) * position**2


def printed_wave(
    robot: Robot, reading: str = "I", *, frequency: float = 1.0, sign: int = -1, waves_per_body: float = 1.0
) -> PrintedWave:
    """Return (20) on a robot in one of its readings.

    Args:
        robot: robot whose body it runs along.
        reading: letter of ``kinematics.wave.READINGS``.
        frequency: which the article does not give [Hz].
        sign: -1 runs from head to tail; 1 as printed.
        waves_per_body: of reading I [-].

    Raises:
        UnknownName: there is no such reading.
    """
    wave = wave_kinematics.reading(
        reading,
        length=robot.length,
        angular_frequency=2 * np.pi * frequency,
        sign=sign,
        waves_per_body=waves_per_body,
    )
    return PrintedWave(wave=wave, origin=tail_root(robot) if READINGS[reading].tail_only else 0.0)


def wave_at_arc_lengths(wave: BodyWave, s: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return heading, x and y of a wave at given arc lengths, each of shape (time, station).

    Args:
        wave: the curve.
        s: arc lengths from the snout, ascending [m].
        time: [s].
    """
    x = np.linspace(0.0, s[-1], _FINE)
    step = x[1] - x[0]
    heading, x_positions, y_positions = (np.empty((len(time), len(s))) for _ in range(3))
    for i, t in enumerate(time):
        stretch = np.sqrt(1.0 + wave.slope(x, t) ** 2)
        arc = np.concatenate([[0.0], np.cumsum(0.5 * step * (stretch[1:] + stretch[:-1]))])
        x_positions[i] = np.interp(s, arc, x)  # arc lengths grow faster than x, so that s ends within
        heading[i] = np.arctan(wave.slope(x_positions[i], t))
        y_positions[i] = wave.displacement(x_positions[i], t)
    return heading, x_positions, y_positions
