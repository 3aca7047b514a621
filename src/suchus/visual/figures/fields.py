"""Fields of a flow around a body: colours with two sides, the outline, the midline, streamlines."""

from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from scipy.ndimage import zoom

from suchus.visual.figures.data import carry

if TYPE_CHECKING:
    import xarray as xr

SKIN, EDGE = "#C9DCCB", "#2F4737"
"""Colours of a body seen from above."""
VORTICITY, PRESSURE = "RdBu_r", "PuOr"
"""Colour maps with a meaningful zero: vorticity red counter-clockwise, pressure purple where it is high."""

_STEPS = 41
"""Steps of colour [-]."""
_PIXELS = 700
"""About how many pixels a field is wide [-]."""


def span(values: np.ndarray, share: float) -> float:
    """Return the end of a two-sided scale: the size that a share of the values stays below."""
    return float(max(np.quantile(np.abs(values), share), 1e-9))


def draw_field(
    ax: Axes, record: "xr.Dataset", name: str, field_name: str, index: int, limit: float, cmap: str
) -> AxesImage:
    """Draw one instant of a field as a picture in even steps of colour, which stays small in an SVG.

    Args:
        ax: where.
        record: record of the experiment ``swimming``.
        name: prefix of the swim in the record.
        field_name: which field.
        index: which instant.
        limit: end of the scale to both sides.
        cmap: colour map.
    """
    x, y = record[f"{name}_x"].values, record[f"{name}_y"].values
    half_cell = 0.5 * (x[1] - x[0])
    values = record[f"{name}_{field_name}"].values[index]
    ax.grid(visible=False)
    image = ax.imshow(
        smooth(values),
        origin="lower",
        extent=(x[0] - half_cell, x[-1] + half_cell, y[0] - half_cell, y[-1] + half_cell),
        cmap=colormaps[cmap].resampled(_STEPS),
        vmin=-limit,
        vmax=limit,
        interpolation="none",
        aspect="equal",
    )
    carry(image, values)
    return image


def smooth(values: np.ndarray, pixels: int = _PIXELS) -> np.ndarray:
    """Return a field on a finer grid of about ``pixels`` along x, so that its cells do not show."""
    return np.asarray(zoom(values, max(1, round(pixels / values.shape[1])), order=1, grid_mode=True, mode="nearest"))


def outline(record: "xr.Dataset", name: str, index: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the outline and the midline of a body at one instant, each of shape (point, 2) [m].

    Args:
        record: record of the experiment ``swimming``.
        name: prefix of the swim in the record.
        index: which instant.
    """
    x, y, heading, half_width = (
        record[f"{name}_midline_{quantity}"].values[index] for quantity in ("x", "y", "heading", "half_width")
    )
    half_width_vector = np.column_stack([-np.sin(heading), np.cos(heading)]) * half_width[:, None]
    line = np.column_stack([x, y])
    return np.vstack([line + half_width_vector, (line - half_width_vector)[::-1]]), line


def draw_body(ax: Axes, record: "xr.Dataset", name: str, index: int) -> tuple[Polygon, Line2D]:
    """Draw a body and its midline; return both artists, which a film moves."""
    edge, line = outline(record, name, index)
    body = Polygon(edge, facecolor=SKIN, edgecolor=EDGE, linewidth=1.0, zorder=3)
    ax.add_patch(body)
    (midline,) = ax.plot(*line.T, color=EDGE, linewidth=0.8, linestyle=(0, (4, 2)), zorder=4, label="_midline")
    return body, midline


def move_body(artists: tuple[Polygon, Line2D], record: "xr.Dataset", name: str, index: int) -> None:
    """Move the artists of ``draw_body`` to another instant."""
    edge, line = outline(record, name, index)
    artists[0].set_xy(edge)
    artists[1].set_data(line[:, 0], line[:, 1])


def draw_streamlines(ax: Axes, record: "xr.Dataset", name: str, index: int) -> None:
    """Draw the streamlines of the water at one instant."""
    x, y = record[f"{name}_x"].values, record[f"{name}_y"].values
    even_axes = (
        np.linspace(x[0], x[-1], x.size),
        np.linspace(y[0], y[-1], y.size),
    )  # streamplot wants exactly even steps
    ax.streamplot(
        *even_axes,
        record[f"{name}_u"].values[index],
        record[f"{name}_v"].values[index],
        density=(0.9, 0.45),
        color="#3A3A3A",
        linewidth=0.6,
        arrowsize=0.6,
        zorder=2,
    )
