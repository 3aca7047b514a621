"""Where a body is and how it moves: a pose, and motions that give a pose at every time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

import numpy as np

from suchus.errors import InvalidDesign
from suchus.kinds import show


def length(parts: Sequence[float] | np.ndarray) -> float:
    """Return the length of a vector of two or three parts, in their unit."""
    return float(speeds(np.asarray(parts, float)))


def speeds(velocity: np.ndarray) -> np.ndarray:
    """Return the lengths of vectors, shape (axis, ...), of two or three axes, in their unit."""
    size: np.ndarray = np.hypot(velocity[0], velocity[1])
    return size if len(velocity) == 2 else np.hypot(size, velocity[2])


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose:
    """Position, attitude and their rates of a body's own frame; in space it turns about z."""

    position: tuple[float, ...] = (0.0, 0.0)
    """Origin of the body's frame (x, y) or (x, y, z); without it, z is 0 in space [m]."""
    angle: float = 0.0
    """Angle of the body's x axis, counter-clockwise about z [rad]."""
    velocity: tuple[float, ...] = (0.0, 0.0)
    """Velocity of the origin (x, y) or (x, y, z) [m/s]."""
    spin: float = 0.0
    """Rate of the angle [rad/s]."""

    def along(self, axes: int) -> "Pose":
        """Return the same pose with as many numbers in position and velocity as there are axes.

        Raises:
            InvalidDesign: it has other than two or three, or three in the plane.
        """
        position, velocity = (
            (*part, 0.0) if len(part) == 2 and axes == 3 else part for part in (self.position, self.velocity)
        )
        if len(position) != axes or len(velocity) != axes:
            raise InvalidDesign(
                f"a pose has the position {show(self.position)} m and the velocity {show(self.velocity)} m/s; "
                f"{'two numbers are needed in the plane' if axes == 2 else 'three numbers are needed in space'}."
            )
        return replace(self, position=position, velocity=velocity)

    def to_world(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return points of the body's frame in the world [m]."""
        wx, wy = self.turn(x, y)
        return wx + self.position[0], wy + self.position[1]

    def to_body(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return points of the world in the body's frame [m]."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        dx, dy = x - self.position[0], y - self.position[1]
        return c * dx + s * dy, c * dy - s * dx

    def turn(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return directions of the body's frame in the world."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return c * x - s * y, s * x + c * y

    def carry(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the velocity that the rigid motion gives to points of the world [m/s]."""
        return (
            self.velocity[0] - self.spin * (y - self.position[1]),
            self.velocity[1] + self.spin * (x - self.position[0]),
        )


Motion = Callable[[float], Pose]
"""A pose at every time [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Oscillation:
    """Sinusoidal heave and pitch: ``offset sin(2 pi f t + phase)``."""

    frequency: float
    """Frequency f [Hz]."""
    centre: tuple[float, ...] = (0.0, 0.0)
    """Mean position [m]."""
    heave: tuple[float, ...] = (0.0, 0.0)
    """Amplitude along x and y (and z) [m]."""
    pitch: float = 0.0
    """Amplitude of the angle [rad]."""
    mean_angle: float = 0.0
    """Angle about which it pitches [rad]."""
    phase: float = 0.0
    """Phase of the heave at time 0 [rad]."""
    pitch_phase: float = 0.0
    """Phase of the pitch at time 0 [rad]."""

    def __call__(self, time: float) -> Pose:
        """Return the pose at a time [s]."""
        rate = 2 * np.pi * self.frequency
        heave, pitch = rate * time + self.phase, rate * time + self.pitch_phase
        return Pose(
            position=tuple(
                mean + part * np.sin(heave) for mean, part in zip_longest(self.centre, self.heave, fillvalue=0.0)
            ),
            angle=self.mean_angle + self.pitch * np.sin(pitch),
            velocity=tuple(rate * part * np.cos(heave) for part in self.heave),
            spin=rate * self.pitch * np.cos(pitch),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Glide:
    """Steady translation from a starting point."""

    start: tuple[float, ...]
    """Position at time 0 [m]."""
    velocity: tuple[float, ...]
    """Velocity [m/s]."""

    def __call__(self, time: float) -> Pose:
        """Return the pose at a time [s]."""
        return Pose(
            position=tuple(
                start + part * time for start, part in zip_longest(self.start, self.velocity, fillvalue=0.0)
            ),
            velocity=self.velocity,
        )
