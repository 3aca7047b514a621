"""Maps of swimming over frequency, amplitude and wavelength, and how far the slender-body models are off."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from suchus.visual.figures.data import carry
from suchus.visual.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled

_SALAMANDRA = (0.9, 1.3)
"""Frequencies between which its CPG swims [Hz]."""
_AXES = ("frequency", "waves")
_ROWS: tuple[tuple[str, str], ...] = (
    ("speed", "speed [m/s]"),
    ("efficiency", "efficiency [-]"),
    ("water_cost_of_transport", "cost of transport [-]"),
)
"""Rows of the maps: quantity and label."""
_DARK_TEXT_LEVEL = 0.55
"""Fraction of the scale above which digits are dark [-]."""
_HATCHED: Mapping[str, Any] = {"facecolor": "#EDEDED", "edgecolor": "#555555", "hatch": "///", "linewidth": 0.0}


def draw_maps(record: xr.Dataset, model: str) -> Figure:
    """Draw speed, efficiency and cost over frequency and amplitude, and over wavelength and amplitude.

    Each motion that was computed is a cell with its number; nothing is interpolated, and scales begin at zero.

    Args:
        record: record of the experiment ``swim_sweep``.
        model: which of the slender-body models.
    """
    model_record = record.sel(model=model)
    with styled(axes__grid=False):
        figure, axes = panels(len(_ROWS), 2, width=10.5, height=10.2, sharex="col", sharey=True)
        for row, (name, label) in zip(axes, _ROWS, strict=True):
            scale = Normalize(0.0, _max_value(model_record, name))
            for ax, axis in zip(row, _AXES, strict=True):
                mesh = _map(ax, model_record, name, axis, scale)
            figure.colorbar(mesh, ax=row, label=label, shrink=0.9)
            row[0].set_ylabel("amplitude over\nthat of eq. (20) [-]")
        for ax, text in zip(axes[-1], ("frequency [Hz]", "waves per body length [-]"), strict=True):
            ax.set_xlabel(text)
        axes[0, 0].set_title("one wave per body length")
        axes[0, 1].set_title("1 Hz")
        figure.legend(handles=_legend(), loc="outside lower center", ncols=3, frameon=False)
    return captioned(
        figure,
        f"Free swimming by the {model} model, left over the frequency, right over the wavelength of the body wave. "
        "The amplitude 1 is that of (20); every cell is a motion that was computed. Hatched: joints or servos cannot "
        "follow. Circles: checked by CFD, in two dimensions.",
    )


def _max_value(record: xr.Dataset, name: str) -> float:
    """Return the greatest value of a quantity in both maps over possible motions; 1 if none is possible."""
    maps = [record[f"{name}_by_{axis}"].where(record[f"possible_by_{axis}"]).values.ravel() for axis in _AXES]
    values = np.concatenate(maps)
    values = values[np.isfinite(values)]
    return max(float(values.max()), 1e-9) if values.size else 1.0


def _map(ax: Axes, record: xr.Dataset, name: str, axis: str, scale: Normalize) -> ScalarMappable:
    """Draw one quantity as a map over amplitude and another parameter; motions that cannot be followed are hatched.

    Args:
        ax: axes to draw on.
        record: record of one slender-body model.
        name: name of the quantity, one of ``_ROWS``.
        axis: the other parameter, one of ``_AXES``.
        scale: colour scale of the quantity.
    """
    x, y = record[axis].values, record.amplitude.values
    values = record[f"{name}_by_{axis}"].transpose("amplitude", axis).values
    possible = record[f"possible_by_{axis}"].transpose("amplitude", axis).values.astype(bool)
    edges, possible_values = (_edges(x), _edges(y)), np.where(possible, values, np.nan)
    mesh = ax.pcolormesh(*edges, possible_values, cmap=SEQUENTIAL, norm=scale, edgecolors="white", linewidth=0.8)
    carry(mesh, possible_values, x, y)
    if not np.isfinite(possible_values).any():
        reason = "no value was found" if possible.any() else "joints or servos can follow none"
        ax.text(0.5, 0.5, f"empty: {reason}", transform=ax.transAxes, ha="center", va="center", bbox=_PAPER, zorder=6)
    for j, i in np.ndindex(values.shape):
        if not possible[j, i]:
            corners = (edges[0][i], edges[0][i + 1])
            ax.fill_between(corners, edges[1][j], edges[1][j + 1], **_HATCHED)
        elif np.isfinite(values[j, i]):
            colour = "black" if scale(values[j, i]) > _DARK_TEXT_LEVEL else "white"
            ax.text(
                float(x[i]), float(y[j]), f"{values[j, i]:.2g}", color=colour, ha="center", va="center", fontsize=10
            )
    if axis == "frequency":
        for edge in _SALAMANDRA:
            if edges[0][0] <= edge <= edges[0][-1]:
                ax.axvline(edge, **_DOTTED)
    else:
        ax.plot(record.point_waves, record.point_amplitude, **_CHECKED)
    ax.set_xticks(x, [f"{value:g}" for value in x])
    ax.set_yticks(y, [f"{value:g}" for value in y])
    return mesh


_PAPER: Mapping[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.9}
_DOTTED: Mapping[str, Any] = {"color": COLOURS["limbs_only"], "linewidth": 1.8, "linestyle": (0, (1, 1.5)), "zorder": 4}
_CHECKED: Mapping[str, Any] = {"marker": "o", "linestyle": "none", "markersize": 18, "markerfacecolor": "none",
            "markeredgecolor": COLOURS["limbs_only"], "markeredgewidth": 1.8, "zorder": 5}  # fmt: skip


def _legend() -> list[Line2D | Patch]:
    """Return the entries of the legend: checked points, Salamandra's range, hatching."""
    return [
        Line2D([], [], **{**_CHECKED, "markersize": 9}, label="checked by CFD"),
        Line2D([], [], **_DOTTED, label="range of Salamandra"),
        Patch(**_HATCHED, label="joints or servos cannot follow"),
    ]


def _edges(positions: np.ndarray) -> np.ndarray:
    """Return the borders of cells around places, half way between them."""
    if positions.size == 1:
        return np.array([positions[0] - 0.5, positions[0] + 0.5])
    middle = 0.5 * (positions[1:] + positions[:-1])
    return np.concatenate([[2 * positions[0] - middle[0]], middle, [2 * positions[-1] - middle[-1]]])


def draw_check(record: xr.Dataset) -> Figure:
    """Draw the speed of the checked points by CFD and by the slender-body models.

    Args:
        record: record of the experiment ``swim_sweep``.
    """
    with styled():
        figure, axes = panels(1, 1, width=7.2, height=3.9)
        ax = axes[0, 0]
        positions = np.arange(record.point_speed.size)
        names = [
            f"{float(a):.1f} × (20)\n{float(w):.1f} waves"
            for a, w in zip(record.point_amplitude, record.point_waves, strict=True)
        ]
        bars = [("CFD, 2-D", record.point_speed.values, COLOURS["ours"])]
        colours = (COLOURS["tail"], COLOURS["spine"])
        for model, colour in zip(record.model.values, colours, strict=True):
            bars.append((f"{model} model, round body", record.point_model_speed.sel(model=model).values, colour))
        for k, (label, values, colour) in enumerate(bars):
            ax.bar(positions + 0.27 * (k - 1), values, width=0.25, color=colour, label=label)
        ax.set_xticks(positions, names)
        ax.set_ylabel("speed at 1 Hz [m/s]")
        ax.grid(visible=False, axis="x")
        ax.set_ylim(0.0, 1.45 * float(max(b[1].max() for b in bars)))
        ax.legend(loc="upper left", fontsize=10)
    return captioned(
        figure,
        f"Speed of the checked points: two-dimensional CFD, {record.attrs['cells']} cells per body length at Re "
        f"{record.attrs['reynolds']:.0f}, in cycle {record.attrs['cycles']} from rest, beside what the two models of "
        "the round body reach in the end.",
    )
