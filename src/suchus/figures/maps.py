"""A quantity over two parameters."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from suchus.figures.data import carry
from suchus.figures.style import SEQUENTIAL


def draw_map(
    ax: Axes,
    values: xr.DataArray,
    *,
    levels: Sequence[float],
    label: str,
    emphasised: float | None = None,
    form: str = "%g",
) -> None:
    """Draw filled contours of a positive quantity on a logarithmic scale, with labelled lines.

    Args:
        ax: to draw on; its labels come from the ``long_name`` and ``units`` of the coordinates.
        values: two-dimensional, the first dimension up, the second to the right.
        levels: of the lines, increasing.
        label: of the colour bar.
        emphasised: level to draw thick.
        form: how a level is written.
    """
    up, right = (values[d] for d in values.dims)
    data = np.clip(np.nan_to_num(values.values.astype(float), nan=levels[0], posinf=levels[-1]), levels[0], levels[-1])
    fine = np.geomspace(levels[0], levels[-1], 40)
    filled = ax.contourf(right, up, data, levels=fine, cmap=SEQUENTIAL, norm=LogNorm(levels[0], levels[-1]))
    carry(filled, values.values, right.values, up.values)
    lines = ax.contour(right, up, data, levels=list(levels[1:-1]), colors="white", linewidths=1.1)
    ax.clabel(lines, fmt=form, fontsize=11)
    if emphasised is not None:
        thick = ax.contour(right, up, data, levels=[emphasised], colors="#D55E00", linewidths=2.6)
        ax.clabel(thick, fmt=form, fontsize=12)
    for axis, coordinate in ((ax.set_xlabel, right), (ax.set_ylabel, up)):
        axis(f"{coordinate.attrs['long_name']} [{coordinate.attrs['units']}]")
    assert ax.figure is not None
    bar = ax.figure.colorbar(filled, ax=ax, ticks=list(levels), format=form)
    bar.set_label(label)
    bar.minorticks_off()
