"""Maps of swimming over frequency, amplitude and wavelength, and how far the cheap models are off."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy.interpolate import RectBivariateSpline

from suchus.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled

_SALAMANDRA = (0.9, 1.3)
"""Frequencies between which its CPG swims [Hz]."""
_AXES = ("frequency", "waves")
_ROWS: tuple[tuple[str, str, str | None], ...] = (
    ("speed", "speed [m/s]", "strouhal"),
    ("efficiency", "efficiency", "slip"),
    ("cost_of_transport", "cost of transport", None),
)
"""Rows of the maps: quantity, label, and whose lines are drawn over it."""


def draw_maps(record: xr.Dataset, model: str) -> Figure:
    """Draw speed, efficiency and cost over frequency and amplitude, and over wavelength and amplitude.

    Args:
        record: of the experiment ``swim_sweep``.
        model: which of the cheap models.
    """
    chosen = record.sel(model=model)
    with styled(axes__grid=False):
        figure, axes = panels(len(_ROWS), 2, width=10.5, height=10.2, sharex="col", sharey=True)
        for row, (name, label, lines) in zip(axes, _ROWS, strict=True):
            levels = _levels(chosen, name)
            for ax, axis in zip(row, _AXES, strict=True):
                drawn = _map(ax, chosen, name, axis, levels)
                _lines(ax, chosen, axis, lines)
            figure.colorbar(drawn, ax=row, label=label, shrink=0.9)
            row[0].set_ylabel("amplitude over that of (20)")
        for ax, text in zip(axes[-1], ("frequency [Hz]", "waves per body"), strict=True):
            ax.set_xlabel(text)
        axes[0, 0].set_title("one wave per body")
        axes[0, 1].set_title("1 Hz; circles: checked in the resolved flow")
    return captioned(
        figure,
        f"Free swimming by the {model} model, left over the frequency, right over the wavelength. Small dots are the "
        "motions that were worked out, colours between them are interpolated. White lines: equal Strouhal number "
        "above, equal slip in the middle. Hatched: joints or servos cannot follow. Between the dotted lines swims "
        "Salamandra.",
    )


def _levels(record: xr.Dataset, name: str) -> Sequence[float]:
    """Return even steps of colour over what the robot can do in both maps of a quantity."""
    values = np.concatenate(
        [record[f"{name}_by_{axis}"].where(record[f"possible_by_{axis}"]).values.ravel() for axis in _AXES]
    )
    return list(MaxNLocator(9).tick_values(np.nanmin(values), np.nanmax(values)))


def _map(ax: Axes, record: xr.Dataset, name: str, axis: str, levels: Sequence[float]) -> ScalarMappable:
    x, y = record[axis].values, record.amplitude.values
    drawn = ax.contourf(*_fine(x, y, record[f"{name}_by_{axis}"].values), levels=levels, cmap=SEQUENTIAL, extend="both")
    most = np.minimum(record[f"most_amplitude_by_{axis}"].values, y[-1])
    ax.fill_between(x, most, y[-1], facecolor="#EDEDED", edgecolor="#B5B5B5", hatch="////", linewidth=0.0, zorder=4)
    ax.plot(x, most, color="#555555", linewidth=1.2, zorder=4)
    ax.plot(*(side.ravel() for side in np.meshgrid(x, y)), ".", color="#111111", markersize=2.5, zorder=5)
    if axis == "frequency":
        for edge in _SALAMANDRA:
            if x[0] <= edge <= x[-1]:
                ax.axvline(edge, color="white", linewidth=1.4, linestyle=(0, (1, 1.5)), zorder=4)
    else:
        ax.plot(record.point_waves, record.point_amplitude, "o", color="white", markeredgecolor="black", zorder=5)
    return drawn


def _lines(ax: Axes, record: xr.Dataset, axis: str, what: str | None) -> None:
    """Draw a few lines of equal Strouhal number or slip, where they exist everywhere."""
    values = record[f"{what}_by_{axis}"].values if what else np.array([np.nan])
    if not np.isfinite(values).all() or np.ptp(values) < 1e-9:
        return
    x, y, fine = _fine(record[axis].values, record.amplitude.values, values)
    most = np.interp(x, record[axis].values, record[f"most_amplitude_by_{axis}"].values)
    lines = ax.contour(x, y, np.ma.array(fine, mask=y[:, None] > most), levels=3, colors="white", linewidths=0.9)
    ax.clabel(lines, fontsize=9, fmt=f"{'St' if what == 'strouhal' else 'slip'} %.2g")


def _fine(x: np.ndarray, y: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a map on a fine grid, through every sample; as it is where some have no value."""
    if not np.isfinite(values).all():
        return x, y, np.ma.masked_invalid(values)
    kx, ky = (min(2, side.size - 1) for side in (x, y))
    fine = np.linspace(x[0], x[-1], 81), np.linspace(y[0], y[-1], 81)
    return *fine, RectBivariateSpline(y, x, values, kx=ky, ky=kx)(fine[1], fine[0])


def draw_check(record: xr.Dataset) -> Figure:
    """Draw the speed of the checked points in the resolved flow and by the cheap models.

    Args:
        record: of the experiment ``swim_sweep``.
    """
    with styled():
        figure, axes = panels(1, 1, width=7.2, height=3.9)
        ax = axes[0, 0]
        place = np.arange(record.point_speed.size)
        names = [
            f"{float(a):.1f} x (20)\n{float(w):.1f} waves"
            for a, w in zip(record.point_amplitude, record.point_waves, strict=True)
        ]
        bars = [("resolved flow, a slice", record.point_speed.values, COLOURS["ours"])]
        colours = (COLOURS["tail"], COLOURS["spine"])
        for model, colour in zip(record.model.values, colours, strict=True):
            bars.append((f"{model} model, round body", record.point_model_speed.sel(model=model).values, colour))
        for k, (label, values, colour) in enumerate(bars):
            ax.bar(place + 0.27 * (k - 1), values, width=0.25, color=colour, label=label)
        ax.set_xticks(place, names)
        ax.set_ylabel("speed at 1 Hz [m/s]")
        ax.grid(visible=False, axis="x")
        ax.set_ylim(0.0, 1.45 * float(max(b[1].max() for b in bars)))
        ax.legend(loc="upper left", fontsize=10)
    return captioned(
        figure,
        f"Speed of the checked points: the resolved two-dimensional flow, {record.attrs['cells']} cells a length at Re "
        f"{record.attrs['reynolds']:.0f}, in cycle {record.attrs['cycles']} from rest, beside what the two models of "
        "the round body reach in the end.",
    )
