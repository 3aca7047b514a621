"""The solution of the inverse kinematics of the leg, without checks: for one leg, or for many of other lengths at once.

``suchus.robot.kinematics.leg`` has the frames and the meaning of the angles.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.robot.kinematics.links import LegLinks

CHUNK = 8192
"""Points solved at a time: the work arrays then stay in the processor's cache [-]."""
ROUNDING = 1e-12
"""How far the knee's cosine may exceed one by rounding alone [-]."""


class Lengths(NamedTuple):
    """The lengths of the leg of each of some points, or of the one leg of all of them."""

    hip_offset: float | Float[np.ndarray, " point"]
    """Distance from the midline to the yaw axis [m]."""
    femur: float | Float[np.ndarray, " point"]
    """Length from hip to knee [m]."""
    tibia: float | Float[np.ndarray, " point"]
    """Length from knee to foot [m]."""
    squares: float | Float[np.ndarray, " point"]
    """Sum of the squares of femur and tibia [m2]."""
    double_product: float | Float[np.ndarray, " point"]
    """Twice the product of femur and tibia [m2]."""

    @classmethod
    def of(cls, legs: Sequence[LegLinks], points: int = 1) -> "Lengths":
        """Return the lengths of some legs, of which each has as many points, one leg after the other.

        Args:
            legs: the legs.
            points: number of points of each leg; of one leg it does not matter.
        """
        numbers = [
            (leg.hip_offset, leg.femur, leg.tibia, leg.femur**2 + leg.tibia**2, 2.0 * leg.femur * leg.tibia)
            for leg in legs
        ]
        is_one = len(set(numbers)) == 1
        return cls(*numbers[0]) if is_one else cls(*np.repeat(np.array(numbers), points, axis=0).T.copy())

    def part(self, points: slice) -> "Lengths":
        """Return the lengths of a part of the points."""
        if not isinstance(self.femur, np.ndarray) or points.stop - points.start >= len(self.femur):
            return self
        return Lengths(*(np.asarray(numbers)[points] for numbers in self))


def solve(
    lengths: Lengths, points: Float[np.ndarray, "point 3"], *, knee: int = 1, side: int = 1
) -> tuple[Float[np.ndarray, "point 3"], bool]:
    """Return the angles of ``leg.inverse`` [rad], and whether every point is within reach; if not, they mean nothing.

    Args:
        lengths: the lengths of the legs.
        points: places of the feet, each in its leg's base frame [m].
        knee: sign of the knee angle, 1 (knee up) or -1.
        side: 1, or -1 for the solution with the yaw turned by half a turn.
    """
    angles = np.empty_like(points)
    is_reachable = True
    with np.errstate(invalid="ignore", over="ignore"):
        for chunk in _chunks(len(points)):
            is_reachable &= _solve(lengths.part(chunk), points[chunk], angles[chunk], knee, side)
    return angles, is_reachable


def _chunks(count: int) -> Iterator[slice]:
    return (slice(start, start + CHUNK) for start in range(0, count, CHUNK))


def _solve(leg: Lengths, foot: np.ndarray, angles: np.ndarray, knee: int, side: int) -> bool:
    """Write the angles of one chunk; return whether every point was within reach."""
    x, y, z = (foot[:, 0] - leg.hip_offset) * side, foot[:, 1] * side, foot[:, 2].copy()
    rho = x * x
    rho += y * y
    c3 = z * z
    c3 += rho
    np.sqrt(rho, out=rho)
    c3 -= leg.squares
    c3 /= leg.double_product
    is_within_reach = bool(np.maximum.reduce(np.abs(c3)) <= 1.0 + ROUNDING)  # NaN fails
    np.minimum(np.maximum(c3, -1.0, out=c3), 1.0, out=c3)  # as ``numpy.clip``, in less time for few numbers
    s3 = 1.0 - c3
    s3 *= 1.0 + c3
    np.sqrt(s3, out=s3)
    s3 *= knee
    np.arctan2(y, x, out=angles[:, 0])
    np.arctan2(s3, c3, out=angles[:, 2])
    rho *= side
    s3 *= leg.tibia  # across the femur
    c3 *= leg.tibia
    c3 += leg.femur  # along the femur
    pitch_sine = z * c3  # pitch = atan2(z, rho) - atan2(s3, c3), as one angle
    pitch_sine -= rho * s3
    rho *= c3
    z *= s3
    rho += z
    np.arctan2(pitch_sine, rho, out=angles[:, 1])
    return is_within_reach
