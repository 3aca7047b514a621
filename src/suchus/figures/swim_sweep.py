"""Maps of swimming over frequency, amplitude and wavelength, and how far the cheap models are off."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from suchus.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled

_SALAMANDRA = (0.9, 1.3)  # frequencies at which its CPG swims [Hz]


def draw_maps(record: xr.Dataset, model: str) -> Figure:
    """Draw speed and efficiency over frequency and amplitude, and over wavelength and amplitude.

    Args:
        record: of the experiment ``swim_sweep``.
        model: which of the cheap models.
    """
    chosen = record.sel(model=model)
    with styled(axes__grid=False):
        figure, axes = panels(2, 2, width=10.5, height=8.0, sharey=True)
        for row, (name, label) in zip(axes, (("speed", "speed [m/s]"), ("efficiency", "efficiency")), strict=True):
            values = [chosen[f"{name}_by_{axis}"].values for axis in ("frequency", "waves")]
            low, high = min(v.min() for v in values), max(v.max() for v in values)
            levels = MaxNLocator(10).tick_values(low, high)
            for ax, axis in zip(row, ("frequency", "waves"), strict=True):
                drawn = _map(ax, chosen, name, axis, levels)
            figure.colorbar(drawn, ax=row, label=label, shrink=0.9)
            row[0].set_ylabel("amplitude over that of (20)")
        for ax, text in zip(axes[1], ("frequency [Hz]", "waves per body"), strict=True):
            ax.set_xlabel(text)
        axes[0, 0].set_title("one wave per body")
        axes[0, 1].set_title("1 Hz; dots: checked in the resolved flow")
    return captioned(
        figure,
        f"Free swimming by the {model} model, left over the frequency, right over the wavelength; white lines of equal "
        "Strouhal number, dashed ones of equal slip. Hatched: joints or servos cannot follow. Between the dotted lines "
        "swims Salamandra.",
    )


def _map(ax: Axes, record: xr.Dataset, name: str, axis: str, levels: Sequence[float]) -> ScalarMappable:
    x, y = record[axis].values, record.amplitude.values
    ax.grid(visible=False)
    drawn = ax.contourf(x, y, record[f"{name}_by_{axis}"].values, levels=levels, cmap=SEQUENTIAL)
    possible = record[f"possible_by_{axis}"].values.astype(float)
    if possible.min() < 0.5:
        hatched = ax.contourf(x, y, possible, levels=[-1.0, 0.5], colors="none", hatches=["////"])
        hatched.set_edgecolor("#FFFFFF")
    for what, dashes in (("strouhal", "solid"), ("slip", "dashed")):
        values = record[f"{what}_by_{axis}"].values
        if np.isfinite(values).all() and np.ptp(values) > 1e-9:
            lines = ax.contour(x, y, values, levels=4, colors="white", linewidths=0.9, linestyles=dashes)
            ax.clabel(lines, fontsize=9, fmt=f"{'St' if what == 'strouhal' else 'slip'} %.2g")
    if axis == "frequency":
        for edge in _SALAMANDRA:
            if x[0] <= edge <= x[-1]:
                ax.axvline(edge, color="white", linewidth=1.4, linestyle=(0, (1, 1.5)))
    else:
        ax.plot(record.point_waves, record.point_amplitude, "o", color="white", markeredgecolor="black", clip_on=False)
    return drawn


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
        "Speed of the checked points: the resolved two-dimensional flow beside the two models of the round body.",
    )
