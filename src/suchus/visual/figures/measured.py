"""What was measured of a walk: stride by stride, and the curvature of the midline over the cycle."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, DIVERGING, captioned, panels, styled

_MARKERS = {"LF": "o", "RF": "s", "LH": "^", "RH": "D"}
_MARK_SPACING = 0.08  # [stride]; by which the feet's marks stand beside each other


def strides_figure(data: xr.Dataset) -> Figure:
    """Return the strides of a walk one by one, with their intervals.

    Args:
        data: data as ``capture.tables`` returns it.
    """
    rows = [name for name in ("stride_length", "speed", "turning") if name in data]
    feet = [name for name in ("duty", "limb_phase") if name in data]
    with styled():
        figure, axes = panels(len(rows) + len(feet), 1, height=1.6 + 1.75 * (len(rows) + len(feet)), sharex=True)
        for ax, name in zip(axes[:, 0], rows, strict=False):
            _marks(ax, data, name, data[name].values, "", COLOURS["ours"], "o", 0.0)
            ax.set_ylabel(_axis_label(data, name))
        for ax, name in zip(axes[len(rows) :, 0], feet, strict=True):
            for j, leg in enumerate(data.leg.values):
                mark_offset = (j - (data.sizes["leg"] - 1) / 2) * _MARK_SPACING
                _marks(ax, data.sel(leg=leg), name, data[name].sel(leg=leg).values, str(leg), COLOURS[str(leg)],
                       _MARKERS[str(leg)], mark_offset)  # fmt: skip
            ax.set_ylabel(_axis_label(data, name))
        if feet:
            axes[len(rows), 0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, frameon=False)
        axes[-1, 0].set_xlabel("stride")
        axes[-1, 0].set_xticks(data.stride.values)
    return captioned(
        figure,
        f"{data.attrs['title']}: {data.sizes['stride']} strides one by one. Bars are intervals that hold the truth in "
        "95 of 100 cases, from the noise of the keypoints and what frames leave open.",
    )


def curvature_figure(data: xr.Dataset) -> Figure:
    """Return the curvature along the midline over the phase of the mean cycle.

    Args:
        data: data as ``capture.tables`` returns it, with ``curvature``.
    """
    size = float(np.nanmax(np.abs(data.curvature.values)))
    with styled():
        figure, axes = panels(1, 1, height=4.4)
        ax = axes[0, 0]
        cells = (data.phase.values, data.place.values, data.curvature.values)
        mesh = ax.pcolormesh(*cells, cmap=DIVERGING, vmin=-size, vmax=size, shading="nearest")
        keypoint_positions = zip(data.keypoint.values, data.place.values, strict=True)
        ax.set_yticks(
            data.place.values, [f"{name}  {position:.2f}" for name, position in keypoint_positions], fontsize=9
        )
        ax.set_ylabel("place along the midline, 0 in front")
        ax.set_xlabel("phase [cycle]")
        ax.invert_yaxis()
        ax.grid(False)
        figure.colorbar(mesh, ax=ax, label=_axis_label(data, "curvature"))
    return captioned(
        figure,
        f"{data.attrs['title']}: curvature at each keypoint of the midline over the mean of {data.attrs['cycles']:.1f} "
        f"cycles; {data.curvature.attrs['long_name']}. Upright stripes are a standing wave, slanting ones travel.",
    )


def _axis_label(data: xr.Dataset, name: str) -> str:
    unit = str(data[name].attrs.get("units", "1"))
    title = {"duty": "duty factor", "limb_phase": "limb phase"}.get(name, name.replace("_", " "))
    return f"{title}\n[{'-' if unit == '1' else unit}]"


def _marks(
    ax: Axes, data: xr.Dataset, name: str, value: np.ndarray, label: str, colour: str, marker: str, offset: float
) -> None:
    """Draw the values of strides with their intervals.

    Args:
        ax: axes to draw on.
        data: holds the ends of the intervals, ``NAME_low`` and ``NAME_high``.
        name: name of the quantity.
        value: one for each stride, (stride,).
        label: label in the legend; empty: none.
        colour: colour of marks and bars.
        marker: shape of the marks.
        offset: offset of the marks along the axis of strides [stride].
    """
    lower_bound, upper_bound = data[f"{name}_low"].values, data[f"{name}_high"].values
    style: dict[str, Any] = {"color": colour, "marker": marker, "linestyle": "none", "markersize": 4, "elinewidth": 1.1}
    ax.errorbar(
        data.stride.values + offset, value, [value - lower_bound, upper_bound - value], label=label or None, **style
    )
