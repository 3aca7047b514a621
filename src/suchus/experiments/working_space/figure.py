"""The room that the snout reaches, from the side and from above."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from suchus.figures.style import COLOURS, panels, styled

_ROLES = ("limbs_only", "coordinated")
_VIEWS = (("from the side", (0, 2), "height [m]"), ("from above", (0, 1), "to the left [m]"))


def room(record: xr.Dataset, states: Sequence[str]) -> Figure:
    """Draw the cells that the snout reaches in two states, and the highest configuration of each.

    Args:
        record: with ``snout_STATE`` (kept, xyz), ``body_STATE`` (point, xyz), ``legs_STATE`` (leg, end, xyz) [m].
        states: their names, the smaller room first.
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=5.6)
        for ax, (title, (across, up), label) in zip(axes[0], _VIEWS, strict=True):
            for state, role in reversed(tuple(zip(states, _ROLES, strict=True))):
                snout, colour = record[f"snout_{state}"].values, COLOURS[role]
                if up == 1:
                    snout = np.concatenate([snout, snout * [1.0, -1.0, 1.0]])
                _cells(ax, snout[:, [across, up]], record.attrs["cell"], colour)
                ax.plot([], [], "s", color=colour, alpha=0.55, markersize=10, label=state)
            for state, role in zip(states, _ROLES, strict=True):
                if f"body_{state}" in record:
                    _posture(ax, record, state, (across, up), COLOURS[role])
            ax.set_aspect("equal")
            ax.set(title=title, xlabel="ahead of the hind feet [m]", ylabel=label)
        axes[0, 0].axhline(0.0, color=COLOURS["ground"], linewidth=2.0, zorder=1)
        axes[0, 0].legend(loc="upper left")
    return figure


def _cells(ax: Any, points: np.ndarray, cell: float, colour: str) -> None:
    """Fill the cells that hold a point."""
    if len(points) == 0:
        return
    edges = [np.arange(p.min(), p.max() + 2 * cell, cell) for p in points.T]
    counts, _ = np.histogramdd(points, bins=edges)
    there = np.ma.masked_equal(counts.T > 0, False)
    ax.pcolormesh(*edges, there, cmap=ListedColormap([colour]), alpha=0.38, antialiased=False, linewidth=0, zorder=1)


def _posture(ax: Any, record: xr.Dataset, state: str, axes: tuple[int, int], colour: str) -> None:
    body, legs = record[f"body_{state}"].values[:, list(axes)], record[f"legs_{state}"].values[..., list(axes)]
    ax.plot(*body.T, color=colour, linewidth=4.0, solid_capstyle="round", solid_joinstyle="round", zorder=3)
    for leg in legs:
        ax.plot(*leg.T, color=colour, linewidth=2.2, marker="o", markersize=4, zorder=3)
    ax.plot(*body[-1], "o", color=colour, markersize=7, markeredgecolor="white", zorder=4)
