"""Sides of a domain in space that move as they would in an unbounded domain: a source and a dipole for each body.

From afar a body that moves with W through the water is a dipole of moment ``(volume + added mass / density) W``, and
its wake is a source of strength ``D / (density |W|)`` where it stands, D the drag: what the wake lacks flows around it.
What leaves with the wake itself goes out where the stream does, which balances the sum over all sides.

Source: Batchelor 1967, An Introduction to Fluid Dynamics, sections 2.9, 5.12 and 6.4.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus.flow.compiled import compiled
from suchus.flow.grid import Grid


@compiled
def _induce(points, place, dipole, source, out):  # type: ignore[no-untyped-def]
    """Write the velocity that a source and a dipole at ``place`` induce at ``points``, both of shape (3, point)."""
    for k in range(points.shape[1]):
        square, along = 0.0, 0.0
        for d in range(3):
            r = points[d, k] - place[d]
            square += r * r
            along += dipole[d] * r
        near = 1.0 / (4.0 * np.pi * square * np.sqrt(square))
        spread = source + 3.0 * along / square
        for d in range(3):
            out[d, k] = near * (spread * (points[d, k] - place[d]) - dipole[d])


@dataclass(slots=True)
class FarBody:
    """What a body is from afar."""

    place: np.ndarray
    """Its middle, in the frame of the grid, shape (3,) [m]."""
    dipole: np.ndarray
    """Moment of the dipole, shape (3,) [m^4/s]."""
    mass: np.ndarray
    """Displaced and added mass over the density, in the body's own axes, shape (3, 3) [m^3]."""
    source: float = 0.0
    """Strength of the source [m^3/s]."""

    def velocity(self, points: np.ndarray) -> np.ndarray:
        """Return the velocity that it induces at points, both of shape (3, ...) [m, m/s]."""
        out = np.empty((3, points[0].size))
        _induce(points.reshape(3, -1), self.place, self.dipole, self.source, out)
        return out.reshape(points.shape)

    def move(self, place: np.ndarray, turn: np.ndarray, through: np.ndarray) -> None:
        """Take the body's motion.

        Args:
            place: its middle, in the frame of the grid, shape (3,) [m].
            turn: rotation matrix of its frame, shape (3, 3) [-].
            through: its velocity through the far water, shape (3,) [m/s].
        """
        self.place, self.dipole = place, turn @ (self.mass @ (turn.T @ through))

    def drag(self, force: np.ndarray, through: np.ndarray, share: float) -> None:
        """Let the source follow the drag.

        Args:
            force: of the water on the body over the density, shape (3,) [m^4/s^2].
            through: velocity of the body through the far water, shape (3,) [m/s].
            share: weight of the source that belongs to this force against the present one, 0 to 1 [-].
        """
        square = float(through @ through)
        if square > 0:
            self.source += share * (-float(force @ through) / square - self.source)


@dataclass(slots=True)
class FarField:
    """The bodies from afar, and the faces of the sides."""

    grid: Grid
    """The grid inside the sides."""
    bodies: list[FarBody] = field(default_factory=list)
    """Bodies that induce the flow far away."""
    points: dict[tuple[int, bool], np.ndarray] = field(init=False)
    """Middles of the faces of each side, by its axis and whether it is the low one, the last axis first [m]."""

    def __post_init__(self) -> None:
        self.points = {(axis, low): self._faces(axis, low) for axis in range(3) for low in (True, False)}

    def _faces(self, axis: int, low: bool) -> np.ndarray:
        grid = self.grid
        plane = grid.origin[axis] + (0.0 if low else grid.size[axis])
        lines = [np.array([plane]) if d == axis else at for d, at in enumerate((grid.x, grid.y, grid.z))]
        z, y, x = np.meshgrid(*reversed(lines), indexing="ij")
        return np.ascontiguousarray(np.squeeze(np.stack([x, y, z]), axis=3 - axis))

    def inward(self, axis: int, low: bool) -> np.ndarray:
        """Return the velocity into the domain that the bodies induce on a side's faces, the last axis first [m/s]."""
        total = np.zeros(self.points[axis, low].shape[1:])
        for body in self.bodies:
            total += self.of(body, axis, low)
        return total

    def of(self, body: FarBody, axis: int, low: bool) -> np.ndarray:
        """Return the same of one body, which need not be among them."""
        velocity = body.velocity(self.points[axis, low])[axis]
        return velocity if low else -velocity
