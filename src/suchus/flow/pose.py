"""Where a body is and how it moves: a pose, and motions that give a pose at every time."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose:
    """Position, attitude and their rates of a body's own frame."""

    position: tuple[float, float] = (0.0, 0.0)
    """Origin of the body's frame (x, y) [m]."""
    angle: float = 0.0
    """Angle of the body's x axis, counter-clockwise [rad]."""
    velocity: tuple[float, float] = (0.0, 0.0)
    """Velocity of the origin [m/s]."""
    spin: float = 0.0
    """Rate of the angle [rad/s]."""

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
    centre: tuple[float, float] = (0.0, 0.0)
    """Mean position [m]."""
    heave: tuple[float, float] = (0.0, 0.0)
    """Amplitude along x and y [m]."""
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
            position=(
                self.centre[0] + self.heave[0] * np.sin(heave),
                self.centre[1] + self.heave[1] * np.sin(heave),
            ),
            angle=self.mean_angle + self.pitch * np.sin(pitch),
            velocity=(rate * self.heave[0] * np.cos(heave), rate * self.heave[1] * np.cos(heave)),
            spin=rate * self.pitch * np.cos(pitch),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Glide:
    """Steady translation from a starting point."""

    start: tuple[float, float]
    """Position at time 0 [m]."""
    velocity: tuple[float, float]
    """Velocity [m/s]."""

    def __call__(self, time: float) -> Pose:
        """Return the pose at a time [s]."""
        return Pose(
            position=(self.start[0] + self.velocity[0] * time, self.start[1] + self.velocity[1] * time),
            velocity=self.velocity,
        )
