"""Boundary values: fills the cells around the domain from what its sides say, in flow units.

Each side is seen with its normal first: ``normal[k]`` and ``tangent[k]`` are lines parallel to the side, so every
kind of side is written once.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus.flow.compiled import PAD
from suchus.flow.grid import Grid
from suchus.flow.sides import Inflow, Outflow, Periodic, Side, Sides, Slip, Stream, Wall

_LEAVES = 0.3
"""Share of the stream's speed along the normal from which a Stream side carries the wake out [-]."""


@dataclass(slots=True)
class Edge:
    """One side of the domain at work."""

    side: Side
    """What the side is."""
    axis: int
    """Axis of the normal: 0 is x, 1 is y."""
    low: bool
    """Whether the side is at the smallest coordinate."""
    cells: int
    """Cells along the normal [-]."""
    prescribed: np.ndarray
    """Velocity into the domain on the side's faces [m/s]."""
    leaves: bool = False
    """Whether water is carried out here in this step."""

    @property
    def sign(self) -> int:
        """+1 if the inward normal points along the axis, else -1."""
        return 1 if self.low else -1

    @property
    def face(self) -> int:
        """Index of the side's faces along the normal."""
        return PAD if self.low else PAD + self.cells

    def normal(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the velocity along the normal, normal index first."""
        return u.T if self.axis == 0 else v

    def tangent(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the velocity along the side, normal index first."""
        return v.T if self.axis == 0 else u

    def fill(self, u: np.ndarray, v: np.ndarray, stream: tuple[float, float]) -> None:
        """Write this side's values to the cells and faces around the domain."""
        n, t, f, step = self.normal(u, v), self.tangent(u, v), self.face, self.sign
        inner = PAD if self.low else PAD + self.cells - 1
        beyond = (f - 1, f - 2) if self.low else (f + 1,)
        if isinstance(self.side, Periodic):
            for k in range(1, PAD + 1):
                if self.low:
                    n[f - k], t[f - k] = n[f - k + self.cells], t[f - k + self.cells]
                else:
                    n[f + k - 1], t[f + k - 1] = n[f + k - 1 - self.cells], t[f + k - 1 - self.cells]
            return
        n[f, PAD:-PAD] = step * self.prescribed
        for k in beyond:
            n[k] = 2 * n[f] - n[f + step] if isinstance(self.side, Wall | Slip) else n[f]
        for k in (1, 2):
            if isinstance(self.side, Wall):
                t[inner - k * step] = 2 * self.side.speed - t[inner + (k - 1) * step]
            elif isinstance(self.side, Inflow):
                t[inner - k * step] = -t[inner + (k - 1) * step]
            elif isinstance(self.side, Stream) and step * stream[self.axis] > 0:
                t[inner - k * step] = stream[1 - self.axis]
            else:
                t[inner - k * step] = t[inner]


@dataclass(slots=True)
class Border:
    """The four sides at work; ``prepare`` once a step, ``fill`` whenever the velocity changed."""

    edges: list[Edge]
    """Left, right, bottom, top."""
    stream: tuple[float, float] = (0.0, 0.0)
    """Velocity of the far water at the end of the step [m/s]."""
    balance: float = field(default=0.0)
    """Flow that the bodies swallow, which leaves less for the outflow [cell m/s]."""

    @classmethod
    def of(cls, sides: Sides, grid: Grid, dtype: type) -> "Border":
        """Return the border of a grid."""
        edges = []
        for name, axis, low in (("left", 0, True), ("right", 0, False), ("bottom", 1, True), ("top", 1, False)):
            along = grid.cells[1 - axis]
            side = getattr(sides, name)
            prescribed: np.ndarray = np.zeros(along, dtype)
            if isinstance(side, Inflow):
                prescribed[:] = side.profile(grid.centres(PAD, PAD + along, 1 - axis))
            edges.append(Edge(side, axis, low, grid.cells[axis], prescribed))
        return cls(edges)

    def prepare(self, u: np.ndarray, v: np.ndarray, dt: float, stream: tuple[float, float]) -> None:
        """Fix the velocity on all sides at the end of the step from the fields at its start.

        On return as much water leaves as enters.
        """
        before, self.stream = self.stream, stream
        size = max(float(np.hypot(*stream)), 1e-30)
        for edge in self.edges:
            if isinstance(edge.side, Stream):
                inward = edge.sign * stream[edge.axis]
                edge.leaves = -inward > _LEAVES * size
                if not edge.leaves:
                    edge.prescribed[:] = inward
            elif isinstance(edge.side, Outflow):
                edge.leaves = True
            if edge.leaves:
                change = edge.sign * (stream[edge.axis] - before[edge.axis])
                self._carry_out(edge, u, v, dt, change if isinstance(edge.side, Stream) else 0.0)
        self._balance()

    @staticmethod
    def _carry_out(edge: Edge, u: np.ndarray, v: np.ndarray, dt: float, change: float) -> None:
        n = edge.normal(u, v)
        at = edge.sign * n[edge.face, PAD:-PAD]
        inner = edge.sign * n[edge.face + edge.sign, PAD:-PAD]
        speed = max(-float(at.mean(dtype=np.float64)), 0.0)
        edge.prescribed[:] = at - min(speed * dt, 1.0) * (at - inner) + change

    def _balance(self) -> None:
        net, room = self.balance, 0
        for edge in self.edges:
            if not isinstance(edge.side, Periodic):
                net += float(edge.prescribed.sum(dtype=np.float64))
                room += edge.prescribed.size if edge.leaves else 0
        if room:
            for edge in self.edges:
                if edge.leaves:
                    edge.prescribed -= net / room

    def fill(self, u: np.ndarray, v: np.ndarray) -> None:
        """Write all boundary values around the domain."""
        for edge in self.edges:
            edge.fill(u, v, self.stream)
