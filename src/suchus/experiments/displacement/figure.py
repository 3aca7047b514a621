"""Crawls side by side from above, as far as each gets in the same time, and the displacement over two parameters."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from suchus.design import Robot
from suchus.figures.data import carry
from suchus.figures.posture import draw_strip
from suchus.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled
from suchus.motion import START

_USUAL = 1.01  # [m]; length of the article's robot, for which distances between the strips are


def draw_crawls(robot: Robot, record: xr.Dataset, arms: Sequence[str]) -> Figure:
    """Draw one robot per run from above at the beginning, between and at the end of its walk.

    Args:
        robot: whose record it is.
        record: with one run per arm.
        arms: roles of ``style.LINES``.
    """
    end = float(record.time[-1])
    times = [START, (START + end) / 2, end]
    size = robot.length / _USUAL
    apart = 0.42 * size
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=10.5, height=5.2)
        ax = axes[0, 0]
        ahead = record.centre_of_mass.sel(xyz="x")
        for i, role in enumerate(arms):
            run, aside = record.isel(run=i), -apart * i
            draw_strip(ax, robot, run, times, role=role, aside=aside)
            start, stop = (float(ahead.isel(run=i).sel(time=t, method="nearest")) for t in (START, end))
            dim = aside - 0.21 * size
            ax.annotate(
                "", (start, dim), (stop, dim), arrowprops={"arrowstyle": "|-|", "color": COLOURS[role], "lw": 2}
            )
            ax.text(
                max(stop, start + 0.02 * size) + 0.03 * size,
                dim,
                f"{stop - start:.{2 if size > 0.5 else 4}f} m, {LINES[role]['label']}",
                color=COLOURS[role],
                va="center",
                fontsize=13,
            )
        ax.set_axis_off()
    return captioned(
        figure,
        f"Two crawls from above with identical leg commands, at {times[0]:g}, {times[1]:g} and {times[2]:g} s, with "
        "the track of the centre of mass: above spine and tail take part, below the legs work alone. Filled feet "
        "stand.",
    )


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
