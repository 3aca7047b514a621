# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""The shape of a body in the plane or in space: distance, normal and velocity at points, and markers over its surface.

Distances are negative inside; normals point into the water.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import isfinite
from typing import ClassVar

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import is_number, show
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass
from suchus.flow.pose import Pose

Axes = tuple[np.ndarray, ...]
"""Coordinates of the points of a window along each axis, x first, each of shape (point along the axis,) [m]."""


@dataclass(slots=True)
class Field:
    """Distance, normal and velocity of a body at the points of a window, arrays of shape (y, x) or (z, y, x)."""

    distance: np.ndarray
    """Signed distance to the surface, negative inside [m]."""
    normal: tuple[np.ndarray, ...]
    """Outward normal, along each axis [-]."""
    velocity: tuple[np.ndarray, ...]
    """Velocity of the body along each axis, extended smoothly a few cells into the water [m/s]."""
    thickness: np.ndarray
    """Thickness of the body behind the nearest point of its surface, infinite where it is thick [m]."""
    part_index: np.ndarray | None = None
    """Index of the body's part to which a point belongs; None for a body of one part [-]."""


def box_slices(points: Axes, low_corner: np.ndarray, high_corner: np.ndarray, margin: float) -> tuple[slice, ...]:
    """Return the part of a window around a box, a slice for each axis of its arrays, the last axis first.

    Args:
        points: coordinates of the window along each axis [m].
        low_corner: low corner of the box, shape (axis,) [m].
        high_corner: its high corner, shape (axis,) [m].
        margin: distance around the box that belongs to it [m].
    """
    ends = zip(points, low_corner, high_corner, strict=True)
    return tuple([slice(*np.searchsorted(line, (a - margin, b + margin))) for line, a, b in ends][::-1])


def write_nearer(window_field: Field, box: tuple[slice, ...], piece: Field, part_index: int) -> None:
    """Write the field of a piece of a body where the piece is nearer than what the window's field has already.

    Where the far side of the piece lies inside the body that is there already, the piece counts as thick.

    Args:
        window_field: field of the body so far, changed.
        box: part of the window on which the piece's field is given; see ``box_slices``.
        piece: field of the piece on that part.
        part_index: index of the body's part that the piece belongs to; it is written if the body has parts [-].
    """
    present_distance = window_field.distance[box]
    is_nearer = piece.distance < present_distance
    facing = sum(
        component * present_component[box]
        for component, present_component in zip(piece.normal, window_field.normal, strict=True)
    )
    piece_thickness = np.where(np.isfinite(piece.thickness), piece.thickness, 0.0)
    is_sunk = present_distance < facing * (piece.distance + piece_thickness)
    values = [
        (window_field.distance, piece.distance),
        (window_field.thickness, np.where(is_sunk, np.inf, piece.thickness)),
        *zip(window_field.normal, piece.normal, strict=True),
        *zip(window_field.velocity, piece.velocity, strict=True),
    ]
    for target, value in values:
        target[box] = np.where(is_nearer, value, target[box])
    if window_field.part_index is not None:
        window_field.part_index[box] = np.where(is_nearer, part_index, window_field.part_index[box])


class Shape(ABC):
    """A body's shape in its own frame, in the plane or in space; it may change with time."""

    ndim: ClassVar[int] = 2
    """Number of axes: 2 in the plane, 3 in space [-]."""
    mirror_symmetry: ClassVar[tuple[bool, ...]] = (True, True, True)
    """Whether the planes through the origin across x, y and z are planes of symmetry."""
    jointed: ClassVar[bool] = False
    """Whether its parts are rigid and connected by joints."""

    @abstractmethod
    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window.

        Args:
            points: coordinates of the window along each axis: x (nx,), y (ny,) and in space z (nz,) [m].
            time: time [s].
            pose: pose of the body's frame.
            reach: only distances below it need be exact [m].
        """

    @abstractmethod
    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers along the outline or over the skin, about ``spacing`` [m] apart."""

    @abstractmethod
    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the smallest rectangle or box around the body: x0, x1, y0, y1, and z0, z1 in space [m]."""

    @abstractmethod
    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stations along the body and its thickness there, two arrays of one shape [m]."""

    @abstractmethod
    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments of a body of density 1, in the body's own frame."""

    def volume(self, time: float) -> float:
        """Return the volume, in the plane the area [m^3, m^2]."""
        return self.mass(time).volume

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return the surface in the middle of a thin body, through which no water passes; None if it is never thin.

        In the plane it is made of the pieces of a line, in space of triangles, shape (corner, axis, piece) [m].

        Args:
            time: time [s].
            pose: pose of the body's frame.
        """
        return None

    def is_closed(self, time: float) -> bool:
        """Return whether no water passes through the middle of the body, however thin it is."""
        return self.midsurface(time, Pose()) is not None

    @property
    def parts(self) -> int:
        """Parts that loads and record tell of one by one [-]."""
        return 1

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return True

    @property
    def is_compact(self) -> bool:
        """Whether it is a blunt body in space, about as long along each axis, for ``resolution``."""
        return False


def check_positive(name: str, value: float) -> None:
    """Refuse a length that is not a positive number.

    Args:
        name: name of the length, for the message.
        value: the length [m].

    Raises:
        InvalidDesign: naming the value.
    """
    if not (is_number(value) and isfinite(value) and value > 0):
        raise InvalidDesign(f"{name} is {show(value)} m; a positive length is needed.")
