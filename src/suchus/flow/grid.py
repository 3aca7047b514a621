"""The grid: square cells in a rectangle, and where its staggered values sit."""

from dataclasses import dataclass
from math import ceil, isfinite
from numbers import Real

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.multigrid import COARSEST
from suchus.kinds import misfits, show

MOST = 2**16
"""Cells along a side [-]; the fields of a square of so many would take a hundred gigabytes."""


def _coarsest(nx: int, ny: int) -> tuple[int, int]:
    while nx % 2 == 0 and ny % 2 == 0 and min(nx, ny) > 4:
        nx, ny = nx // 2, ny // 2
    return nx, ny


def _fitting(nx: int, ny: int) -> tuple[int, int]:
    """Return the next sizes that can be halved until at most ``COARSEST`` cells are left along each side."""
    halvings = 0
    while ceil(max(nx, ny) / 2**halvings) > COARSEST:
        halvings += 1
    step = 2**halvings
    return step * max(4, ceil(nx / step)), step * max(4, ceil(ny / step))


def _is_number(value: object) -> bool:
    return not isinstance(value, bool) and isinstance(value, Real) and isfinite(value)


def check_kinds(value: object) -> None:
    """Refuse a setting whose fields hold other kinds of things than they declare.

    Raises:
        InvalidDesign: naming all of them.
    """
    wrong = [f"{field} {text}" for field, text in misfits(value)]
    if wrong:
        raise InvalidDesign(f"{'; '.join(wrong)}.")


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """A rectangle of square cells.

    Raises:
        InvalidDesign: on creation, for sizes that cannot be or that the multigrid cannot halve far enough.
    """

    cells: tuple[int, int]
    """Number of cells along x and y [-]."""
    cell: float
    """Side of a cell [m]."""
    origin: tuple[float, float] = (0.0, 0.0)
    """Lower left corner of the domain (x, y) [m]."""

    def __post_init__(self) -> None:
        check_kinds(self)
        if not (isfinite(self.cell) and self.cell > 0):
            raise InvalidDesign(f"cell is {self.cell} m; a cell has a positive side. Give the side in metres.")
        if not all(isfinite(place) for place in self.origin):
            raise InvalidDesign(f"the origin is {self.origin} m; two finite numbers are needed.")
        nx, ny = self.cells
        if max(nx, ny) > MOST:
            raise InvalidDesign(f"the grid has {show(self.cells)} cells; up to {MOST} along each side are allowed.")
        if min(nx, ny) < 8:
            raise InvalidDesign(f"the grid has {nx} x {ny} cells; at least 8 x 8 are needed.")
        if max(_coarsest(nx, ny)) > COARSEST:
            good = _fitting(nx, ny)
            raise InvalidDesign(
                f"a grid of {nx} x {ny} cells cannot be halved down to {COARSEST} cells a side, as multigrid needs; "
                f"take {good[0]} x {good[1]}, or let Grid.covering choose."
            )

    @classmethod
    def covering(cls, x: tuple[float, float], y: tuple[float, float], *, cell: float) -> "Grid":
        """Return the smallest fitting grid that covers [x0, x1] x [y0, y1], grown evenly on both sides [m].

        Raises:
            InvalidDesign: an empty rectangle or a cell that is not positive.
        """
        ends: tuple[object, ...] = (x, y, (0.0, cell))
        if not all(isinstance(end, (tuple, list)) and len(end) == 2 and all(map(_is_number, end)) for end in ends):
            raise InvalidDesign(
                f"the rectangle is {show(x)} x {show(y)} m and the cell {show(cell)} m; two pairs of finite "
                "numbers and one more are needed."
            )
        wide, high = x[1] - x[0], y[1] - y[0]
        if cell > 0 and max(wide, high) / MOST > cell:
            raise InvalidDesign(f"cells of {cell} m make a side of {max(wide, high) / cell:.3g}; {MOST} are allowed.")
        if not (cell > 0 and wide > 0 and high > 0):
            raise InvalidDesign(
                f"the rectangle {x} x {y} m with cells of {cell} m is empty; give rising limits and a positive cell."
            )
        cells = _fitting(max(8, ceil(wide / cell - 1e-6)), max(8, ceil(high / cell - 1e-6)))
        origin = (x[0] - (cells[0] * cell - wide) / 2, y[0] - (cells[1] * cell - high) / 2)
        return cls(cells=cells, cell=cell, origin=origin)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the domain [m]."""
        return self.cells[0] * self.cell, self.cells[1] * self.cell

    @property
    def x(self) -> np.ndarray:
        """Cell centres along x, shape (nx,) [m]."""
        return self.origin[0] + self.cell * (np.arange(self.cells[0]) + 0.5)

    @property
    def y(self) -> np.ndarray:
        """Cell centres along y, shape (ny,) [m]."""
        return self.origin[1] + self.cell * (np.arange(self.cells[1]) + 0.5)

    def faces(self, first: int, end: int, axis: int) -> np.ndarray:
        """Return the coordinates of the padded face indices ``first`` to ``end`` along an axis [m]."""
        return self.origin[axis] + self.cell * (np.arange(first, end) - PAD)

    def centres(self, first: int, end: int, axis: int) -> np.ndarray:
        """Return the coordinates of the padded cell indices ``first`` to ``end`` along an axis [m]."""
        return self.origin[axis] + self.cell * (np.arange(first, end) - PAD + 0.5)
