"""How much memory the fields of a grid take, and whether the machine has it."""

import os

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.grid import Grid


def arrays_of(axes: int) -> float:
    """Return how many numbers are kept per cell, those of the coarser levels with them [-].

    Velocity three times, pressure, the bodies' share; three work arrays; and, on all levels, solution, right side,
    inverse diagonal and faces. What counts around the bodies only is kept there alone and comes on top.
    """
    return 3 * axes + 1 + axes + 3 + (3 + axes) / (1 - 0.5**axes)


def needed_memory(grid: Grid, dtype: type) -> int:
    """Return the memory of all fields of a grid [bytes]."""
    cells = float(np.prod([n + 2.0 * PAD for n in grid.cells]))
    return int(cells * arrays_of(grid.axes) * np.dtype(dtype).itemsize)


def machine_memory() -> int | None:
    """Return the memory of this machine, None where it does not say [bytes]."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None


def check_memory(grid: Grid, dtype: type) -> None:
    """Refuse a grid whose fields the machine cannot hold.

    Raises:
        InvalidDesign: with both numbers, and the cell that would do.
    """
    need, have = needed_memory(grid, dtype), machine_memory()
    if have is None or need <= have:
        return
    cell = grid.cell * (need / have) ** (1 / grid.axes)
    raise InvalidDesign(
        f"a grid of {' x '.join(map(str, grid.cells))} cells takes {need / 1e9:.3g} GB of memory, and this machine has "
        f"{have / 1e9:.3g} GB; take cells of at least {cell:.2g} m, or a smaller domain."
    )
