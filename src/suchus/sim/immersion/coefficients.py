"""Added mass and drag of simple shapes, from closed forms and published tables.

Added mass over density: ellipsoids exactly (Lamb 1932, art. 114 and 115); cylinders and boxes from DNV-RP-C205 (2010),
appendix D, which gives plates, prisms and finite cylinders; capsules have the ratio of added to displaced mass of the
ellipsoid of the same half extents. Drag coefficients: Hoerner, Fluid-Dynamic Drag (1965), chapter 3.
"""

from dataclasses import dataclass
from math import inf, pi, sqrt

import numpy as np
from jaxtyping import Float
from scipy.special import elliprd

from suchus.core.checks import Checks
from suchus.core.water_table import BALL, CAPSULE, CYLINDER, POLYHEDRON

Triple = tuple[float, float, float]
BOX = -1
"""Kind of a box; in the table of shapes it is a polyhedron."""

_PLATE_ADDED = ((1, 1.25, 1.59, 2, 2.5, 3.17, 4, 5, 6.25, 8, 10, inf),
                (0.579, 0.642, 0.704, 0.757, 0.801, 0.840, 0.872, 0.897, 0.917, 0.934, 0.947, 1.0))  # fmt: skip
"""Length over width of a plate, and its added mass over pi / 4 times density, square of the width and length [-]."""
_STRIP_THICKNESS = ((0, 0.1, 0.2, 0.5, 1, 2, 5, 10), (1.0, 1.14, 1.21, 1.36, 1.51, 1.70, 1.98, 2.23))
"""Thickness of a long prism over its width, and its added mass over that of the strip of the same width [-]."""
_PRISM_THICKNESS = ((0, 0.1, 0.2, 0.5, 1, 2, 5, 10), (1.0, 1.14, 1.21, 1.36, 1.495, 1.58, 1.65, 1.76))
"""The same of a square prism: from 1 on its table over that of the square plate, below as the long prism [-]."""
_CYLINDER_ADDED = ((0, 0.5, 1.2, 2.5, 5, 9, inf), (0.0, 0.31, 0.62, 0.78, 0.90, 0.96, 1.0))
"""Length of a round cylinder over its diameter, and its added over its displaced mass for motion across [-]; the two
least lengths are of ellipsoids."""
_PLATE_DRAG = ((1, 5, 10, 20, inf), (1.17, 1.20, 1.29, 1.40, 1.98))
"""Length over width of a plate, and its drag coefficient [-]."""
_THICKNESS_DRAG = ((0, 0.5, 1, 2, 4, 8), (1.0, 1.0, 0.90, 0.74, 0.74, 0.76))
"""Thickness of a blunt body along the flow over the root of its front, and its drag over that of a plate [-]."""
_CYLINDER_DRAG = ((1, 2, 3, 5, 10, 20, 40, inf), (0.63, 0.68, 0.74, 0.74, 0.82, 0.90, 0.98, 1.20))
"""Length of a round cylinder over its diameter, and its drag coefficient across [-]."""
_CAPSULE_DRAG = ((1, 1.5, 3, 5, 10, 20, 40, inf), (0.47, 0.60, 0.74, 0.74, 0.82, 0.90, 0.98, 1.20))
"""Length of a capsule over its diameter, and its drag coefficient across: from a sphere's to a cylinder's [-]."""
_DISC_DRAG, _SPHERE_DRAG, _ROUND_END_DRAG = 1.17, 0.47, 0.25
_CUBE_TURNING = 0.3
"""Least weight of the drag that turning faces of a box have [-]; a face twice as far from the axis as wide has 0.5."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GeomCoefficients:
    """What the water does to one geom, in place of what follows from its shape; None keeps that.

    Triples are along the geom's x, y, z as MuJoCo has them; a mesh's are its principal axes.
    """

    drag: float | Triple | None = None
    """Drag coefficient, over the projected area of the shape [-]."""
    linear_drag: float | Triple | None = None
    """Force over speed, wholly under water [N s/m]."""
    linear_turning_drag: float | Triple | None = None
    """Torque over rate, wholly under water [N m s]."""
    added_mass: float | Triple | None = None
    """Added mass over the mass of water that the shape displaces [-]."""
    lift: float | None = None
    """Slope of the lift coefficient of its largest face [1/rad]; 2 pi for a long wing, about 2 for a square plate."""
    volume: float = 1.0
    """Volume that displaces water over that of the shape [-]; 0 for a geom that lies inside another one."""
    is_convex: bool = False
    """Whether the convex hull of a mesh stands for it."""

    def __post_init__(self) -> None:
        """Refuse coefficients outside their ranges."""
        with Checks("coefficients", self) as check:
            for name, bound, unit in (
                ("drag", 100.0, ""), ("linear_drag", 1e9, "N s/m"), ("linear_turning_drag", 1e9, "N m s"),
                ("added_mass", 1e4, ""),
            ):  # fmt: skip
                value = getattr(self, name)
                if isinstance(value, tuple):
                    check.each(name, ("x", "y", "z"), 0.0, bound, unit)
                elif value is not None:
                    check.number(name, 0.0, bound, unit)
            if self.lift is not None:
                check.number("lift", 0.0, 20.0, "1/rad")
            check.number("volume", 0.0, 100.0, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeCoefficients:
    """What a shape has along its three axes, over the density of the water where it has one."""

    added: Float[np.ndarray, "3"]
    """Added mass [m3]."""
    added_inertia: Float[np.ndarray, "3"]
    """Added moment of inertia [m5]."""
    area: Float[np.ndarray, "3"]
    """Projected area [m2]."""
    drag: Float[np.ndarray, "3"]
    """Drag coefficient [-]."""
    turning: Float[np.ndarray, "3"]
    """Torque of drag over half the density and the square of the rate [m5]."""


def ellipsoid_added_mass(half: Float[np.ndarray, "3"]) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Return added mass [m3] and added moment of inertia [m5] over density of an ellipsoid along its axes, exactly.

    Args:
        half: half axes [m].

    Source: Lamb, Hydrodynamics (1932), art. 114 and 115.
    """
    a, b, c = (float(length) for length in half)
    volume, squares = 4.0 / 3.0 * pi * a * b * c, np.square([a, b, c])
    alpha = 2.0 / 3.0 * a * b * c * np.array(
        [elliprd(b * b, c * c, a * a), elliprd(c * c, a * a, b * b), elliprd(a * a, b * b, c * c)]
    )  # fmt: skip
    inertia = np.zeros(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        difference, total = squares[j] - squares[k], squares[j] + squares[k]
        denominator = 2.0 * difference + total * (alpha[j] - alpha[k])
        if abs(difference) > 1e-9 * total:
            inertia[i] = volume / 5.0 * difference**2 * (alpha[k] - alpha[j]) / denominator
    return volume * alpha / (2.0 - alpha), inertia


def box_added_mass(half: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """Return the added mass of a box over density, along its axes [m3].

    It is that of the plate that the box shows to the flow, times a factor of the box's thickness, which lies between
    those of a square and of a long prism.

    Args:
        half: half extents [m].

    Source: DNV-RP-C205 (2010), tables D-1 and D-2.
    """
    added = np.zeros(3)
    for i in range(3):
        width, length = sorted(2.0 * np.delete(half, i))
        slenderness, thickness = length / width, 2.0 * half[i] / width
        plate = 0.25 * pi * width**2 * length * _at_ratio(slenderness, _PLATE_ADDED)
        square, strip = _at_ratio(thickness, _PRISM_THICKNESS), _at_ratio(thickness, _STRIP_THICKNESS)
        added[i] = plate * (strip + (square - strip) / slenderness)
    return added


def shape_coefficients(
    kind: int, half: Float[np.ndarray, "3"], volume: float, own_drag: float | Triple | None = None
) -> ShapeCoefficients:
    """Return added mass and drag of a shape, by its kind and half extents.

    Args:
        kind: ``BALL``, ``CYLINDER``, ``CAPSULE``, ``POLYHEDRON`` (half axes of the ellipsoid that stands for it) or
            ``BOX``.
        half: half extents along its axes; a cylinder and a capsule lie along the third [m].
        volume: [m3].
        own_drag: drag coefficient in place of that of the shape [-].
    """
    half = np.maximum(np.asarray(half, float), 1e-6 * float(np.max(half)))
    added, inertia = ellipsoid_added_mass(half)
    ellipsoid = added.copy()
    a, b, c = half
    area = pi * np.array([b * c, a * c, a * b])
    drag = np.array([_ellipsoid_drag(half, i) for i in range(3)])
    if kind == BOX:
        added = box_added_mass(half)
        area = 4.0 * np.array([b * c, a * c, a * b])
        for i in range(3):
            width, length = sorted(np.delete(half, i))
            thickness = half[i] / sqrt(width * length)
            drag[i] = _at_ratio(length / width, _PLATE_DRAG) * _at_ratio(thickness, _THICKNESS_DRAG)
    elif kind == CYLINDER:
        slenderness = c / a
        across = volume * _at_ratio(slenderness, _CYLINDER_ADDED)
        added = np.array([across, across, 8.0 / 3.0 * a**3 * _at_ratio(slenderness, _PRISM_THICKNESS)])
        area = np.array([4.0 * a * c, 4.0 * a * c, pi * a * a])
        across_drag = float(_at_ratio(slenderness, _CYLINDER_DRAG))
        thickness = 2.0 * c / (a * sqrt(pi))
        drag = np.array([across_drag, across_drag, _DISC_DRAG * _at_ratio(thickness, _THICKNESS_DRAG)])
    elif kind in (CAPSULE, POLYHEDRON):
        added = added * volume / (4.0 / 3.0 * pi * a * b * c)
        if kind == CAPSULE:
            straight = max(c - a, 0.0)
            area[:2] = 4.0 * a * straight + pi * a * a
            drag[:2] = _at_ratio(c / a, _CAPSULE_DRAG)
            drag[2] = _ROUND_END_DRAG + (_SPHERE_DRAG - _ROUND_END_DRAG) * a / c
    if own_drag is not None:
        drag = np.broadcast_to(np.asarray(own_drag, float), 3)
    scale = float(added.sum() / ellipsoid.sum())
    return ShapeCoefficients(
        added=added,
        added_inertia=inertia * scale ** (5.0 / 3.0),
        area=area,
        drag=drag,
        turning=_turning_drag(kind, half, drag),
    )


def _at_ratio(ratio: float, table: tuple[tuple[float, ...], tuple[float, ...]]) -> float:
    """Return a coefficient at a ratio from 0 to infinity, interpolated over ratio / (1 + ratio) [-]."""
    ratios = np.array(table[0], float)
    nodes = np.where(np.isinf(ratios), 1.0, ratios / (1.0 + np.where(np.isinf(ratios), 0.0, ratios)))
    return float(np.interp(ratio / (1.0 + ratio), nodes, table[1]))


def _ellipsoid_drag(half: Float[np.ndarray, "3"], axis: int) -> float:
    """Return the drag coefficient of an ellipsoid along an axis, between disc, sphere and streamlined body [-]."""
    fineness = float(half[axis] / np.sqrt(np.prod(np.delete(half, axis))))
    if fineness >= 1.0:
        return _SPHERE_DRAG / fineness
    return _DISC_DRAG + (_SPHERE_DRAG - _DISC_DRAG) * fineness


def _turning_drag(kind: int, half: Float[np.ndarray, "3"], drag: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """Return the torque of drag of a turning shape over half the density and the square of the rate, by strips [m5].

    Strips at the distance r from the axis meet the water at r times the rate. A body of revolution about the axis has
    none; a shape as thick as it is wide has little.

    Args:
        kind: kind of the shape.
        half: half extents [m].
        drag: drag coefficients [-].
    """
    turning = np.zeros(3)
    for axis in range(3):
        for face, arm in (((axis + 1) % 3, (axis + 2) % 3), ((axis + 2) % 3, (axis + 1) % 3)):
            weight = max(1.0 - half[face] / half[arm], 0.0)
            if kind == BOX:
                weight = max(weight, _CUBE_TURNING)
            is_round = kind in (BALL, POLYHEDRON) or (kind != BOX and arm != 2)
            strips = half[axis] * half[arm] ** 4 * (8.0 / 15.0 if is_round else 1.0)
            turning[axis] += weight * drag[face] * strips
    return turning
