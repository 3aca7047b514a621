"""Pose of a body, and motions: functions that return a pose for every time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import zip_longest
from math import cos, degrees, hypot, isfinite, pi, radians, sin
from operator import add, mul
from typing import Any

import numpy as np

from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show

ROTATION_PLANES = {2: ((0, 1),), 3: ((1, 2), (2, 0), (0, 1))}
"""The planes of rotation for 2 and 3 axes: for each rotation axis, the first and the second axis of its plane."""


def cross(first_vector: Sequence[Any] | np.ndarray, second_vector: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
    """Return the vector product of two vectors of shape (3, ...), component by component.

    For a second vector in the plane, of shape (2, ...), only the first one's component about z counts.
    """
    if len(second_vector) == 2:
        turn, (x, y) = first_vector[-1], second_vector
        return -turn * y, turn * x
    (a, b, c), (x, y, z) = first_vector, second_vector
    return b * z - c * y, c * x - a * z, a * y - b * x


def rotate_vectors(matrix: np.ndarray, vectors: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
    """Return vectors of shape (axis, ...), rotated by a matrix, component by component.

    Args:
        matrix: rotation matrix, shape (3, 3); vectors in the plane, of two axes, are turned about z by its first two
            rows and columns.
        vectors: the vectors, shape (2, ...) or (3, ...).
    """
    ndim = len(vectors)
    rows = matrix[:ndim, :ndim].tolist()
    return tuple([reduce(add, map(mul, row, vectors)) for row in rows])


def length(parts: Sequence[float] | np.ndarray) -> float:
    """Return the length of a vector of one, two or three parts, in their unit."""
    return hypot(*parts)


def speeds(velocity: np.ndarray) -> np.ndarray:
    """Return the lengths of vectors, shape (axis, ...), of two or three axes, in their unit."""
    size: np.ndarray = np.hypot(velocity[0], velocity[1])
    return size if len(velocity) == 2 else np.hypot(size, velocity[2])


def angle_text(name: str, angle: float) -> str | None:
    """Return a sentence about an angle of more than a turn, or None.

    Args:
        name: of the angle.
        angle: its value [rad].
    """
    if abs(angle) <= 2 * pi:
        return None
    return (
        f"{name} is {angle:.4g} rad, {degrees(angle):.4g} degrees or {angle / (2 * pi):.2g} turns. Angles are in "
        f"radians: {angle:.4g} degrees are {radians(angle):.4g} rad."
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose:
    """Position, attitude and their rates of a body's own frame.

    In space the three angles are yaw, pitch and roll, which are successive rotations about the body's own axes
    (``suchus.core.rotation``). The three spins are the angular velocity about the axes of the world.
    """

    position: tuple[float, ...] = (0.0, 0.0)
    """Origin of the body's frame, (x, y) or (x, y, z); two numbers in space mean z = 0 [m]."""
    angle: float = 0.0
    """Angle of the body's x axis, counter-clockwise about z: the yaw [rad]."""
    velocity: tuple[float, ...] = (0.0, 0.0)
    """Velocity of the origin (x, y) or (x, y, z) [m/s]."""
    spin: float = 0.0
    """Angular velocity about z [rad/s]."""
    pitch: float = 0.0
    """In space, angle about the body's y axis after the yaw: nose down [rad]."""
    roll: float = 0.0
    """In space, angle about the body's x axis after yaw and pitch: left side up [rad]."""
    spin_x: float = 0.0
    """In space, angular velocity about x [rad/s]."""
    spin_y: float = 0.0
    """In space, angular velocity about y [rad/s]."""

    def in_dimensions(self, ndim: int) -> "Pose":
        """Return the same pose, with as many components of position and velocity as the domain has axes.

        A missing z is 0.

        Args:
            ndim: number of axes of the domain, 2 or 3.

        Raises:
            InvalidDesign: another number of components, a number that is not finite, or pitch, roll, ``spin_x`` or
                ``spin_y`` in the plane.
        """
        scalars = (self.angle, self.spin, self.pitch, self.roll, self.spin_x, self.spin_y)
        if not isfinite(sum(self.position) + sum(self.velocity) + sum(scalars)):
            self._refuse_non_finite()
        position, velocity = (
            (*vector, 0.0) if len(vector) == 2 and ndim == 3 else vector for vector in (self.position, self.velocity)
        )
        if len(position) != ndim or len(velocity) != ndim:
            raise InvalidDesign(
                f"a pose has the position {show(self.position)} m and the velocity {show(self.velocity)} m/s; "
                f"{'two numbers are needed in the plane' if ndim == 2 else 'three numbers are needed in space'}."
            )
        if ndim == 2 and not self.in_plane:
            raise InvalidDesign(
                f"a pose has pitch {self.pitch:.4g} rad, roll {self.roll:.4g} rad and the spins {self.spin_x:.4g} and "
                f"{self.spin_y:.4g} rad/s; in the plane a body has an angle and a spin alone. Leave the others 0."
            )
        if position is self.position and velocity is self.velocity:
            return self
        return replace(self, position=position, velocity=velocity)

    def _refuse_non_finite(self) -> None:
        """Refuse numbers that are not finite.

        Raises:
            InvalidDesign: naming them.
        """
        for name in ("position", "velocity", "angle", "spin", "pitch", "roll", "spin_x", "spin_y"):
            quantity = getattr(self, name)
            if not all(map(isfinite, quantity if isinstance(quantity, tuple) else (quantity,))):
                raise InvalidDesign(f"{name} of a pose is {show(quantity)}; finite numbers are needed.")

    @property
    def in_plane(self) -> bool:
        """Whether the body stands upright and turns about z alone."""
        return not (self.pitch or self.roll or self.spin_x or self.spin_y)

    @property
    def matrix(self) -> np.ndarray:
        """Rotation matrix, shape (3, 3): its columns are the body's axes in the world [-]."""
        if self.pitch or self.roll:
            return rotation.matrix(rotation.from_angles(self.angle, self.pitch, self.roll))
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    @property
    def spins(self) -> np.ndarray:
        """Angular velocity about x, y and z, shape (3,) [rad/s]."""
        return np.array([self.spin_x, self.spin_y, self.spin])

    def rotate(self, vectors: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
        """Return directions of the body's frame in the world frame, component by component.

        Args:
            vectors: components along each axis of the body's frame, shape (2, ...) or (3, ...).
        """
        return rotate_vectors(self.matrix, vectors)

    def to_world(self, points: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
        """Return points of the body's frame in the world frame, component by component [m].

        Args:
            points: coordinates along each axis of the body's frame, shape (2, ...) or (3, ...) [m].
        """
        return tuple([a + b for a, b in zip(self.rotate(points), self._along(self.position, len(points)), strict=True)])

    def to_body(self, points: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
        """Return points of the world frame in the body's frame, component by component [m].

        Args:
            points: coordinates along each axis of the world, shape (2, ...) or (3, ...) [m].
        """
        return rotate_vectors(self.matrix.T, self._arms(points))

    def velocity_at(self, points: Sequence[Any] | np.ndarray) -> tuple[Any, ...]:
        """Return the velocity of the rigid motion at points, component by component [m/s].

        Args:
            points: coordinates along each axis of the world, shape (2, ...) or (3, ...) [m].
        """
        turning = cross((self.spin_x, self.spin_y, self.spin), self._arms(points))
        return tuple([a + b for a, b in zip(self._along(self.velocity, len(points)), turning, strict=True)])

    def _arms(self, points: Sequence[Any] | np.ndarray) -> list[Any]:
        """Return the vectors from the origin of the body's frame to points of the world, component by component [m]."""
        return [a - b for a, b in zip(points, self._along(self.position, len(points)), strict=True)]

    @staticmethod
    def _along(vector: tuple[float, ...], ndim: int) -> tuple[float, ...]:
        """Return the components of a vector along two axes or three; a missing one along z is 0."""
        return vector if len(vector) == ndim else (*vector, 0.0)[:ndim]


Motion = Callable[[float], Pose]
"""Pose as a function of the time [s]."""


class CachedMotion:
    """A motion that caches its last poses: a step needs the pose at the same times often."""

    MAX_CACHED_TIMES = 8
    """Number of times that are cached [-]."""

    def __init__(self, motion: Motion) -> None:
        self._motion, self._poses = motion, dict[float, Pose]()

    def __call__(self, time: float) -> Pose:
        """Return the pose at a time [s]."""
        pose = self._poses.get(time)
        if pose is None:
            pose = self._motion(time)
            if len(self._poses) == self.MAX_CACHED_TIMES:
                del self._poses[next(iter(self._poses))]
            self._poses[time] = pose
        return pose

    def clear(self) -> None:
        """Clear the cache, because the motion has changed."""
        self._poses.clear()


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
        rate = 2 * pi * self.frequency
        heave, pitch = rate * time + self.phase, rate * time + self.pitch_phase
        heave_sine, speed = sin(heave), rate * cos(heave)
        return Pose(
            position=tuple(
                [
                    mean + amplitude * heave_sine
                    for mean, amplitude in zip_longest(self.centre, self.heave, fillvalue=0.0)
                ]
            ),
            angle=self.mean_angle + self.pitch * sin(pitch),
            velocity=tuple([speed * amplitude for amplitude in self.heave]),
            spin=rate * self.pitch * cos(pitch),
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
                start + speed * time for start, speed in zip_longest(self.start, self.velocity, fillvalue=0.0)
            ),
            velocity=self.velocity,
        )
