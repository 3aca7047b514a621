"""The axis of a body: segments from the snout to the tip of the tail."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum

import numpy as np

from suchus.core.checks import Checks
from suchus.robot.design.hinge import Hinge

Point = tuple[float, float, float]
"""Forward, left, up [m]."""
_AXES = ("forward", "left", "up")


@dataclass(frozen=True, slots=True, kw_only=True)
class Rod:
    """A rod with round ends."""

    name: str
    """Unique in the robot."""
    start: Point
    """Middle of one end: forward, left, up in the frame of its segment [m]."""
    end: Point
    """Middle of the other end [m]."""
    radius: float
    """[m]."""
    mass: float
    """[kg]."""

    def __post_init__(self) -> None:
        with Checks(f"rod {self.name}", self) as check:
            check.number("radius", 1e-5, 10.0, "m")
            check.number("mass", 1e-8, 1e5, "kg")
            check.each("start", _AXES, -100.0, 100.0, "m")
            check.each("end", _AXES, -100.0, 100.0, "m")
            check.that(self.start != self.end, f"rod {self.name} begins where it ends; give it a length")

    @property
    def centre(self) -> Point:
        """Centre of mass in the frame of its segment [m]."""
        a, b = self.start, self.end
        return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2

    @property
    def span(self) -> tuple[float, float]:
        """Hindmost and foremost place along the segment [m]."""
        return min(self.start[0], self.end[0]) - self.radius, max(self.start[0], self.end[0]) + self.radius

    @property
    def bottom(self) -> float:
        """Depth of its lowest point below the axis [m]."""
        return self.radius - min(self.start[2], self.end[2])


@dataclass(frozen=True, slots=True, kw_only=True)
class Shell:
    """An ellipsoid."""

    name: str
    """Unique in the robot."""
    at: Point
    """Its centre: forward, left, up in the frame of its segment [m]."""
    half: Point
    """Half of its length, width and height [m]."""
    mass: float
    """[kg]."""

    def __post_init__(self) -> None:
        with Checks(f"shell {self.name}", self) as check:
            check.each("at", _AXES, -100.0, 100.0, "m")
            check.each("half", ("length", "width", "height"), 1e-5, 10.0, "m")
            check.number("mass", 1e-8, 1e5, "kg")

    @property
    def centre(self) -> Point:
        """Centre of mass in the frame of its segment [m]."""
        return self.at

    @property
    def span(self) -> tuple[float, float]:
        """Hindmost and foremost place along the segment [m]."""
        return self.at[0] - self.half[0], self.at[0] + self.half[0]

    @property
    def bottom(self) -> float:
        """Depth of its lowest point below the axis [m]."""
        return self.half[2] - self.at[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Inertia:
    """Measured inertia of a rigid body, in place of that of its shapes."""

    centre: Point
    """Centre of mass: forward, left, up in the frame of its segment; of a left limb's link, from its beginning [m]."""
    moments: Point
    """Moments of inertia xx, yy, zz about the centre of mass [kg m2]."""
    products: Point = (0.0, 0.0, 0.0)
    """Entries xy, xz, yz of the tensor of inertia about the centre of mass, with the signs of a URDF [kg m2]."""

    def __post_init__(self) -> None:
        with Checks("inertia", self) as check:
            check.each("centre", _AXES, -100.0, 100.0, "m")
            check.each("moments", ("xx", "yy", "zz"), 1e-18, 1e9, "kg m2")
            check.each("products", ("xy", "xz", "yz"), -1e9, 1e9, "kg m2")
            min_moment, mid_moment, max_moment = np.linalg.eigvalsh(self.tensor)
            check.that(
                min_moment > 0 and max_moment <= (min_moment + mid_moment) * (1 + 1e-9),
                f"inertia has the principal moments {min_moment:.4g}, {mid_moment:.4g} and {max_moment:.4g} kg "
                "m2, which no body has: "
                "each must be positive and at most the sum of the other two; check moments and products",
            )

    @property
    def tensor(self) -> np.ndarray:
        """Tensor of inertia about the centre of mass, shape (3, 3) [kg m2]."""
        (xx, yy, zz), (xy, xz, yz) = self.moments, self.products
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def combine_inertias(parts: Sequence[tuple[float, np.ndarray, np.ndarray]]) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass, centre and inertia of several rigid bodies joined to one, by the parallel-axis theorem.

    Args:
        parts: of each its mass [kg], its centre of mass, shape (3,) [m], and its tensor of inertia about that,
            shape (3, 3) [kg m2].

    Returns:
        The same three of all together; a body without mass has its centre in the first one's.
    """
    mass = fsum(part_mass for part_mass, _, _ in parts)
    centre = np.sum([part_mass * place for part_mass, place, _ in parts], axis=0) / mass if mass > 0 else parts[0][1]
    tensor_sum = np.zeros((3, 3))
    for part_mass, place, tensor in parts:
        offset = place - centre
        tensor_sum += tensor + part_mass * ((offset @ offset) * np.eye(3) - np.outer(offset, offset))
    return mass, centre, tensor_sum


@dataclass(frozen=True, slots=True, kw_only=True)
class Segment:
    """A stiff piece of the axis: x forward, y left, z up, the origin anywhere on the axis.

    Its front joint or tip lies ``front`` ahead of the origin, its rear joint or tip ``rear`` behind it.
    """

    name: str
    """Unique in the robot."""
    front: float
    """Distance from the origin forward to the joint with the segment ahead, or to the tip [m]."""
    rear: float
    """Distance from the origin back to the joint with the segment behind, or to the tip [m]."""
    shapes: tuple[Rod | Shell, ...]
    """What it is made of; the masses are theirs."""
    hinges: tuple[Hinge, ...] = ()
    """Up to three hinges in its rear joint, in the order in which they turn what is farther from the root."""
    inertia: Inertia | None = None
    """Where its mass lies; None: as in its shapes, each of one density."""

    def __post_init__(self) -> None:
        with Checks(f"segment {self.name}", self) as check:
            check.number("front", -10.0, 100.0, "m")
            check.number("rear", -10.0, 100.0, "m")
            check.that(
                self.front + self.rear > 1e-6,
                f"segment {self.name} is {self.front + self.rear:g} m long; its front must lie ahead of its rear",
            )
            check.that(
                len(self.hinges) <= 3,
                f"segment {self.name} has {len(self.hinges)} hinges at its rear; up to 3 are allowed",
            )
            check.that(bool(self.shapes), f"segment {self.name} has no shape, so no mass; give it a rod or a shell")
            for shape in self.shapes:
                rear_end, front_end = shape.span
                check.that(
                    rear_end <= self.front and front_end >= -self.rear,
                    f"{shape.name} lies {rear_end:g} to {front_end:g} m along segment {self.name}, which reaches from "
                    f"{-self.rear:g} to {self.front:g} m: the parts do not join; move it there",
                )
