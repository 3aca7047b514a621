"""Quantities over time, one line per arm."""

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.axes import Axes

from suchus.visual.figures.style import COLOURS, LINES


def draw_lines(ax: Axes, values: xr.DataArray, roles: Sequence[str], *, scale: float = 1.0) -> None:
    """Draw one line per run in the colours of its role.

    Args:
        ax: axes to draw on.
        values: values with the dimensions ``run`` and ``time``.
        roles: roles of ``style.LINES``, one per run.
        scale: factor on the values, for a unit people read.
    """
    for i, role in enumerate(roles):
        ax.plot(values.time, scale * values.isel(run=i).transpose("time"), **LINES[role])
    ax.set_xlabel("time [s]")
    ax.set_xlim(float(values.time[0]), float(values.time[-1]))


def draw_band(ax: Axes, values: xr.DataArray, role: str) -> None:
    """Shade the range of all runs over time in the colour of a role.

    Args:
        ax: axes to draw on.
        values: values with the dimensions ``run`` and ``time``.
        role: role of ``style.LINES``.
    """
    lower_bound, upper_bound = values.min("run"), values.max("run")
    ax.fill_between(values.time, lower_bound, upper_bound, color=COLOURS[role], alpha=0.22, linewidth=0)


def mark_cycles(ax: Axes, times: Sequence[float]) -> None:
    """Mark where cycles begin and end."""
    for time in times:
        ax.axvline(time, color=COLOURS["neutral"], linewidth=0.9, linestyle=(0, (1, 2)), zorder=0)


def mark_printed(ax: Axes, values: Mapping[str, float], time: float) -> None:
    """Mark the article's values with diamonds; the first has an entry in the legend.

    Args:
        ax: axes to draw on.
        values: values by role, whose colour the bar takes.
        time: position along the axis of time [s].
    """
    for i, (role, value) in enumerate(values.items()):
        ax.plot([time], [value], "D", color=COLOURS[role], markeredgecolor="black", markersize=8, zorder=5,
                clip_on=False, label=None if i else "article")  # fmt: skip
