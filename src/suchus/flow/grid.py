"""The grid: square cells in a rectangle or cubic ones in a box, and where its staggered values sit."""

from dataclasses import dataclass, field
from math import ceil, floor, isfinite
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np

from suchus.core import large
from suchus.core.errors import InvalidDesign
from suchus.core.kinds import misfits, show
from suchus.flow.compiled import PAD
from suchus.flow.multigrid import MAX_CHANNEL_CELLS, MAX_COARSEST_CELLS

if TYPE_CHECKING:
    from suchus.flow.sides import Sides

MAX_CELLS_PER_SIDE = 2**16
"""Cells along a side [-]; the fields of a square of so many would take a hundred gigabytes."""


POSITION_TOLERANCE = 1e-6
"""Largest distance of a side of the domain from the requested position, over a cell [-]."""

RATIOS = 2, 4, 8
"""Fine cells of a patch along a cell of the grid around it [-]."""

MAX_CHANNEL_WIDTH = 8
"""Most cells across a channel on the coarsest level that may be long [-]."""


def _coarsest(cells: tuple[int, ...]) -> tuple[int, ...]:
    while all(n % 2 == 0 for n in cells) and min(cells) > 4:
        cells = tuple(n // 2 for n in cells)
    return cells


def _fitting(cells: tuple[int, ...]) -> tuple[int, ...]:
    """Return the next sizes that can be halved until at most ``MAX_COARSEST_CELLS`` cells are left along each side.

    A long channel may keep up to ``MAX_CHANNEL_CELLS`` cells along its length, so that it does not become wider.
    """
    halvings, min_side = 0, min(cells)
    while ceil(max(cells) / 2**halvings) > (MAX_COARSEST_CELLS if min_side > 4 * 2**halvings else MAX_CHANNEL_CELLS):
        halvings += 1
    step = 2**halvings
    return tuple(step * max(4, ceil(n / step)) for n in cells)


def _times(values: tuple[object, ...]) -> str:
    """Return numbers or pairs as text, such as ``2 x 3 x 4``."""
    return " x ".join(str(value) for value in values)


def _is_number(value: object) -> bool:
    return not isinstance(value, bool) and isinstance(value, Real) and isfinite(value)


def _are_pairs(ends: tuple[object, ...]) -> bool:
    """Return whether each is a pair of finite numbers."""
    return all(isinstance(end, (tuple, list)) and len(end) == 2 and all(map(_is_number, end)) for end in ends)


def check_kinds(value: object) -> None:
    """Refuse a setting whose fields have values of other types than they declare.

    Raises:
        InvalidDesign: the message names all such fields.
    """
    problems = [f"{field} {text}" for field, text in misfits(value)]
    if problems:
        raise InvalidDesign(f"{'; '.join(problems)}.")


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """A rectangle of square cells, or a box of cubic ones.

    Raises:
        InvalidDesign: on creation, for sizes that cannot be or that the multigrid cannot halve far enough.
    """

    cells: tuple[int, int] | tuple[int, int, int]
    """Number of cells along x and y, or along x, y and z [-]."""
    cell: float
    """Side of a cell [m]."""
    origin: tuple[float, ...] = ()
    """Corner of the domain with the smallest coordinates, one for each axis; all 0 if it is not given [m]."""
    request: tuple[tuple[float, float], ...] = field(default=(), compare=False, repr=False)
    """First and last place along each axis that ``covering`` was asked for; empty of other grids [m]."""

    def __post_init__(self) -> None:
        """Refuse sizes that cannot be or that multigrid cannot halve far enough; an empty origin becomes 0."""
        check_kinds(self)
        if not self.origin:
            object.__setattr__(self, "origin", (0.0,) * len(self.cells))
        if not (isfinite(self.cell) and self.cell > 0):
            raise InvalidDesign(f"cell is {self.cell} m; a cell has a positive side. Give the side in metres.")
        if len(self.origin) != len(self.cells) or not all(isfinite(place) for place in self.origin):
            count = "two" if self.ndim == 2 else "three"
            raise InvalidDesign(f"the origin is {show(self.origin)} m; {count} finite numbers are needed.")
        size = _times(self.cells)
        if max(self.cells) > MAX_CELLS_PER_SIDE:
            raise InvalidDesign(
                f"the grid has {show(self.cells)} cells; up to {MAX_CELLS_PER_SIDE} along each side are allowed."
            )
        if min(self.cells) < 8:
            raise InvalidDesign(f"the grid has {size} cells; at least {_times((8,) * self.ndim)} are needed.")
        coarsest = _coarsest(self.cells)
        if max(coarsest) > (MAX_CHANNEL_CELLS if min(coarsest) <= MAX_CHANNEL_WIDTH else MAX_COARSEST_CELLS):
            raise InvalidDesign(
                f"a grid of {size} cells cannot be halved down to {MAX_COARSEST_CELLS} cells a side, as multigrid "
                f"needs; "
                f"take {_times(_fitting(self.cells))}, or let Grid.covering choose."
            )

    @classmethod
    def covering(
        cls, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float] | None = None, *, cell: float,
        sides: "Sides | None" = None,
    ) -> "Grid":  # fmt: skip
        """Return the smallest fitting grid that covers [x0, x1] x [y0, y1] (x [z0, z1]) [m].

        The excess length is split evenly between both ends of each axis, or added to one end where the other is held.

        Args:
            x: first and last place along x [m].
            y: the same along y.
            z: the same along z, in space.
            cell: side of a cell [m].
            sides: those of the setup; each that is no ``Stream`` and no ``Outflow`` stays at the requested
                position. Without them a mirror or a wall may move by some cells.

        Raises:
            InvalidDesign: an empty rectangle or box, a cell that is not positive, or one that does not fit between two
                sides that are held.
        """
        pairs = (x, y) if z is None else (x, y, z)
        shape_name, count = ("rectangle", "two") if z is None else ("box", "three")
        if not _are_pairs((*pairs, (0.0, cell))):
            raise InvalidDesign(
                f"the {shape_name} is {_times(tuple(show(pair) for pair in pairs))} m and the cell {show(cell)} m; "
                f"{count} pairs of finite numbers and one more are needed."
            )
        lengths = [end - start for start, end in pairs]
        if cell > 0 and max(lengths) / MAX_CELLS_PER_SIDE > cell:
            raise InvalidDesign(
                f"cells of {cell} m make a side of {max(lengths) / cell:.3g}; {MAX_CELLS_PER_SIDE} are allowed."
            )
        if not (cell > 0 and min(lengths) > 0):
            raise InvalidDesign(
                f"the {shape_name} {_times(pairs)} m with cells of {cell} m is empty; give rising limits and a "
                f"positive cell."
            )
        if cell > min(lengths):
            raise InvalidDesign(
                f"cells of {cell} m are wider than the {shape_name} {_times(pairs)} m; give a cell below "
                f"{min(lengths):.6g} m, in metres as the {shape_name}."
            )
        cells = _fitting(tuple(max(8, ceil(side / cell - POSITION_TOLERANCE)) for side in lengths))
        origin = []
        for d, ((start, _), n, side) in enumerate(zip(pairs, cells, lengths, strict=True)):
            is_low_held, is_high_held = (False, False) if sides is None else sides.is_fixed(len(pairs))[d]
            if is_low_held and is_high_held and abs(n * cell - side) > POSITION_TOLERANCE * cell:
                raise InvalidDesign(
                    f"along {'xyz'[d]} both sides are held, {side:.6g} m apart, and {n} cells of {cell:.6g} m, as "
                    f"multigrid needs, are {n * cell:.6g} m; take cells of {side / n:.12g} m."
                )
            origin.append(start - (n * cell - side) * (0.0 if is_low_held else 1.0 if is_high_held else 0.5))
        request = tuple((float(start), float(end)) for start, end in pairs)
        return cls(cells=cells, cell=cell, origin=tuple(origin), request=request)  # type: ignore[arg-type]

    def patch(
        self, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float] | None = None, *, ratio: int = 4
    ) -> "Grid":  # fmt: skip
        """Return a grid of finer cells that covers [x0, x1] x [y0, y1] (x [z0, z1]) [m], nested in this one.

        It fills whole cells of this one, as many as multigrid needs. The excess is split evenly between both ends of
        each axis, as far as this grid reaches.

        Args:
            x: first and last place along x [m].
            y: the same along y.
            z: the same along z, in space.
            ratio: fine cells along a coarse one [-].

        Raises:
            InvalidDesign: another number of axes, no numbers, another ratio, or a place outside this grid.
        """
        pairs = (x, y) if z is None else (x, y, z)
        if len(pairs) != self.ndim:
            raise InvalidDesign(f"the grid has {self.ndim} axes and the patch {len(pairs)}; give a pair for each axis.")
        if not _are_pairs(pairs):
            raise InvalidDesign(
                f"the patch is {_times(tuple(show(pair) for pair in pairs))} m; give a pair of finite numbers for each "
                f"axis."
            )
        if ratio not in RATIOS or not isinstance(ratio, int):
            raise InvalidDesign(f"the ratio is {show(ratio)}; give {RATIOS[0]}, {RATIOS[1]} or {RATIOS[2]}.")
        first_cells, counts = [], []
        for pair, start, n, name in zip(pairs, self.origin, self.cells, "xyz", strict=False):
            a, b = ((place - start) / self.cell for place in pair)
            if not -POSITION_TOLERANCE <= a < b <= n + POSITION_TOLERANCE:
                raise InvalidDesign(
                    f"along {name} the patch reaches from {pair[0]:.6g} to {pair[1]:.6g} m and the grid from "
                    f"{start:.6g} to {start + n * self.cell:.6g} m; give rising places in it."
                )
            first_cells.append(floor(a + POSITION_TOLERANCE))
            counts.append(ceil(b - POSITION_TOLERANCE) - first_cells[-1])
        fine = _fitting(tuple(ratio * max(n, ceil(8 / ratio)) for n in counts))
        coarse_cells = [ceil(n / ratio) for n in fine]
        if any(a > b for a, b in zip(coarse_cells, self.cells, strict=True)):
            raise InvalidDesign(
                f"a patch of {_times(tuple(ratio * n for n in coarse_cells))} cells, as multigrid needs, is larger "
                f"than the grid around it; take a smaller patch or a larger grid."
            )
        corner = [
            min(max(a - (n - requested_cells) // 2, 0), max_cells - n)
            for a, requested_cells, n, max_cells in zip(first_cells, counts, coarse_cells, self.cells, strict=True)
        ]
        origin = tuple(start + self.cell * k for start, k in zip(self.origin, corner, strict=True))
        return Grid(cells=tuple(ratio * n for n in coarse_cells), cell=self.cell / ratio, origin=origin)  # type: ignore[arg-type]

    @property
    def ndim(self) -> int:
        """Number of dimensions: 2 in the plane, 3 in space [-]."""
        return len(self.cells)

    @property
    def size(self) -> tuple[float, ...]:
        """Length of the domain along each axis [m]."""
        return tuple(n * self.cell for n in self.cells)

    @property
    def x(self) -> np.ndarray:
        """Cell centres along x, shape (nx,) [m]."""
        return self.origin[0] + self.cell * (np.arange(self.cells[0]) + 0.5)

    @property
    def y(self) -> np.ndarray:
        """Cell centres along y, shape (ny,) [m]."""
        return self.origin[1] + self.cell * (np.arange(self.cells[1]) + 0.5)

    @property
    def z(self) -> np.ndarray:
        """Cell centres along z of a grid in space, shape (nz,) [m]."""
        return self.origin[2] + self.cell * (np.arange(self.cells[-1]) + 0.5)

    def faces(self, start: int, end: int, axis: int) -> np.ndarray:
        """Return the coordinates of the padded face indices ``first`` to ``end`` along an axis [m]."""
        return self.origin[axis] + self.cell * (np.arange(start, end) - PAD)

    def centres(self, start: int, end: int, axis: int) -> np.ndarray:
        """Return the coordinates of the padded cell indices ``first`` to ``end`` along an axis [m]."""
        return self.origin[axis] + self.cell * (np.arange(start, end) - PAD + 0.5)


def numbers_per_cell(ndim: int) -> float:
    """Return how many numbers are kept per cell of a grid with so many axes; those of the coarser levels count too [-].

    They are: the velocity three times, pressure, and the bodies' fraction of each face; three work arrays; and, on all
    levels, solution, right side, inverse diagonal and faces. Arrays of the window around the bodies come on top.
    """
    return 3 * ndim + 1 + ndim + 3 + (3 + ndim) / (1 - 0.5**ndim)


def needed_memory(grid: Grid, dtype: type) -> int:
    """Return the memory of all fields of a grid [bytes]."""
    cells = float(np.prod([n + 2.0 * PAD for n in grid.cells]))
    return int(cells * numbers_per_cell(grid.ndim) * np.dtype(dtype).itemsize)


def check_memory(grid: Grid, dtype: type) -> None:
    """Refuse a grid whose fields need too much memory; see ``core.large``.

    Raises:
        InvalidDesign: the fields need too much; the message has both numbers and the cell that fits.
    """
    need, have = needed_memory(grid, dtype), large.memory()
    if have is None:
        return
    cell = grid.cell * (need / (large.MAX_MEMORY_FRACTION * have)) ** (1 / grid.ndim)
    large.check_memory(
        f"a grid of {' x '.join(map(str, grid.cells))} cells",
        need,
        f"take cells of at least {cell:.2g} m, or a smaller domain",
    )
