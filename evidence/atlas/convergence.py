"""What three grids say of a result's own error: the observed order of convergence and the grid convergence index.

Of values f1, f2, f3 on cells h1 < h2 < h3 whose error falls with the power p of the cell,

    |f3 - f2| / |f2 - f1| = (h2 / h1)^p ((h3 / h2)^p - s) / ((h2 / h1)^p - s)

gives p, where s is 1 if both changes go the same way and -1 if the second turns back, and
``SAFETY |f2 - f1| / ((h2 / h1)^p - 1)`` is the index: the band around f1 in which the limit of small cells should lie.
Of a curve the changes are their root mean squares over its points, and s is the sign of what they have in common; at
which share of the points they turn back is told beside. It says nothing of the domain, of the time step (which goes
with the cell) and of what a flow does that has two states.

Source: Roache 1994, J. Fluids Eng. 116, 405-413; Celik, Ghia, Roache and Freitas 2008, J. Fluids Eng. 130, 078001,
whose equations 3 and 7 these are, and who ask for that share. They take the mean of the orders at the points of a
curve; where changes are near nought those have no meaning, and the root mean square leaves such points no weight.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from evidence.atlas.case import AtlasRow, Curves, published
from evidence.atlas.comparison import LEAST_SHARE, values_of

GRIDS = 3
"""Grids that the index needs."""

SAFETY = 1.25
"""Factor on the estimated error of three grids [-]: Roache 1994, Celik et al. 2008."""

FORMAL = 2.0
"""Order of the solver's scheme away from walls; a higher observed one is not counted on [-]."""

_HIGHEST = 40.0  # order up to which the equation is solved; from FORMAL on its value does not matter [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class GridConvergence:
    """What three grids say of a row."""

    uncertainty: float | None = None
    """Grid convergence index of the finest grid, over the same peak as the row's difference; None where there is none
    [-]."""
    order: float | None = None
    """Observed order of convergence; of several numbers their median; None where there is none [-]."""
    turning: float = 0.0
    """Share of the points, or of the numbers, at which the second change turns back: oscillatory convergence [-]."""
    refusal: str = ""
    """Why there is no index; empty where there is one."""


def grid_convergence(values: Sequence[np.ndarray], cells: Sequence[float], peak: float) -> GridConvergence:
    """Return what the values of one quantity, or of one curve at the same points, on three grids say.

    Args:
        values: on the finest grid first, each of shape (point,).
        cells: per diameter or chord of the grids, falling [-].
        peak: what the index is divided by, in the unit of the values.
    """
    if len(values) != GRIDS:
        return GridConvergence(refusal=f"{len(values)} of {GRIDS} grids are there")
    finest, middle, coarsest = values
    first, second = middle - finest, coarsest - middle
    near, far = (float(np.sqrt(np.mean(change**2))) for change in (first, second))
    if near == 0.0:
        return GridConvergence(uncertainty=0.0)
    r21, r32 = (fine / coarse for fine, coarse in pairwise(cells))
    turning = float(np.mean(first * second < 0))
    order = _order(far / near, r21, r32, -1 if float(np.mean(first * second)) < 0 else 1)
    if order is None:
        return GridConvergence(turning=turning, refusal="its change does not become smaller with the cells")
    band = SAFETY * near / (r21 ** min(order, FORMAL) - 1) / abs(peak)
    return GridConvergence(uncertainty=band, order=order, turning=turning)


def _order(ratio: float, r21: float, r32: float, sign: int) -> float | None:
    """Return the order at which two changes, of the same sign or not, have a ratio; None where they do not fall."""

    def excess(p: float) -> float:
        return float(r21**p * (r32**p - sign) / (r21**p - sign)) - ratio

    least = 1e-6
    if excess(least) >= 0:
        return None
    return _HIGHEST if excess(_HIGHEST) <= 0 else float(brentq(excess, least, _HIGHEST))


def row_convergence(row: AtlasRow, grids: Mapping[int, tuple[int, Curves]]) -> GridConvergence:
    """Return what the grids of a flow say of one of its rows.

    Single numbers are judged one by one, and the row's uncertainty is the root mean square of theirs, over the
    published ones; all have to converge.

    Args:
        row: the row.
        grids: cells per diameter or chord, and curves, by the number of the grid, from 1 for the finest.
    """
    found = [grids[number] for number in sorted(grids)]
    cells = [float(cells) for cells, _ in found]
    if len(found) != GRIDS:
        return GridConvergence(refusal=f"{len(found)} of {GRIDS} grids are there")
    if row.kind == "numbers":
        return _of_numbers(row, [curves for _, curves in found], cells)
    read = [values_of(row, curves) for _, curves in found]
    missing = [cells for cells, one in zip(cells, read, strict=True) if one is None]
    if missing:
        return GridConvergence(refusal=f"{missing[0]:g} cells gave no such curve")
    lines = [one for one in read if one is not None]
    reached = np.all([np.isfinite(line.computed) for line in lines], axis=0)
    if reached.mean() < LEAST_SHARE:
        return GridConvergence(refusal="the three reach fewer than half of the points together")
    peak = float(np.abs(lines[0].published).max())
    return grid_convergence([line.computed[reached] for line in lines], cells, peak)


def _of_numbers(row: AtlasRow, curves: Sequence[Curves], cells: Sequence[float]) -> GridConvergence:
    table = published(row.data)
    names = table.columns["quantity"]
    if any(name not in each for name in names for each in curves):
        return GridConvergence(refusal="a grid gave not all of the numbers")
    sources = np.stack([table.values(column) for column in table.columns if column != "quantity"])
    theirs = np.nanmean(sources, axis=0)
    each = {
        name: grid_convergence([np.atleast_1d(one[name]) for one in curves], cells, float(value))
        for name, value in zip(names, theirs, strict=True)
    }
    refused = [f"{name}: {one.refusal}" for name, one in each.items() if one.refusal]
    if refused:
        return GridConvergence(refusal="; ".join(refused))
    sizes = [one.uncertainty for one in each.values() if one.uncertainty is not None]
    orders = [one.order for one in each.values() if one.order is not None]
    return GridConvergence(
        uncertainty=float(np.sqrt(np.mean(np.square(sizes)))), order=float(np.median(orders)) if orders else None,
        turning=float(np.mean([one.turning for one in each.values()])),
    )  # fmt: skip
