"""Sides of a domain in space that move as they would in water without end: a source and a dipole for each body.

From afar a body that moves with W through the water is a dipole of moment ``(volume + added mass / density) W``, and
its wake is a source of strength ``D / (density |W|)`` where it stands, D the drag: what the wake lacks flows around it.
What leaves with the wake itself goes out where the stream does, which balances the sum over all sides.

Source: Batchelor 1967, An Introduction to Fluid Dynamics, sections 2.9, 5.12 and 6.4.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus.flow.grid import Grid


def turned(angle: float) -> np.ndarray:
    """Return the matrix that turns a vector about z by an angle [rad], shape (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


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
        r = points - self.place.reshape(3, *(1,) * (points.ndim - 1))
        square = (r * r).sum(axis=0)
        along = np.tensordot(self.dipole, r, axes=1)
        spread = self.source + 3 * along / square
        moment = self.dipole.reshape(3, *(1,) * (points.ndim - 1))
        induced: np.ndarray = (spread * r - moment) / (4 * np.pi * square**1.5)
        return induced

    def move(self, place: np.ndarray, angle: float, through: np.ndarray) -> None:
        """Take the body's motion.

        Args:
            place: its middle, in the frame of the grid, shape (3,) [m].
            angle: of its x axis about z [rad].
            through: its velocity through the far water, shape (3,) [m/s].
        """
        turn = turned(angle)
        self.place, self.dipole = place, turn @ (self.mass @ (turn.T @ through))

    def drag(self, force: np.ndarray, through: np.ndarray, share: float) -> None:
        """Let the source follow the drag.

        Args:
            force: of the water on the body over the density, shape (3,) [m^4/s^2].
            through: velocity of the body through the far water, shape (3,) [m/s].
            share: how far the source goes to what this force says, 0 to 1 [-].
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
    """What induces."""

    def inward(self, axis: int, low: bool) -> np.ndarray:
        """Return the velocity into the domain that the bodies induce on a side's faces, the last axis first [m/s]."""
        grid = self.grid
        plane = grid.origin[axis] + (0.0 if low else grid.size[axis])
        lines = [np.array([plane]) if d == axis else at for d, at in enumerate((grid.x, grid.y, grid.z))]
        z, y, x = np.meshgrid(*reversed(lines), indexing="ij")
        points = np.squeeze(np.stack([x, y, z]), axis=3 - axis)
        total = np.zeros(points.shape[1:])
        for body in self.bodies:
            total += body.velocity(points)[axis]
        return total if low else -total
