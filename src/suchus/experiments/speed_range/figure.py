"""The picture of every gait over its cycle time."""

from collections.abc import Mapping
from typing import Any

import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from suchus.figures.style import COLOURS, captioned, panels, styled
from suchus.paper.animals import ANIMAL

_THICK, _THIN = 2.0, 0.9
_SERVOS = ("servos of equal torque at any speed", "servos whose torque falls with speed")
_WALKING = ANIMAL["high_walk_speed"]


def draw_speed_range(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw speed, cost, duty factor and Froude number over cycle time, the servos with a speed line thinly."""
    with styled():
        figure, axes = panels(2, 2, width=9.6, height=8.0, sharex=True)
        rows = (
            ("speed", "speed [m/s]", 1.0),
            ("cost", "cost of transport [-]", 1.0),
            ("duty", "duty factor [-]", 1.0),
            ("froude", "Froude number [-]", 1.0),
        )
        for ax, (name, label, scale) in zip(axes.flat, rows, strict=True):
            for gait in record.gait.values:
                for model, width in (("line", _THIN), ("slew", _THICK)):
                    one = record.sel(gait=gait, servo_model=model)
                    style = dict(lines[str(gait)]) | {"linewidth": width, "markersize": 3 if model == "line" else 6}
                    if model == "line":
                        style |= {"label": f"_{style['label']}, {_SERVOS[1]}", "alpha": 0.7}
                    ax.plot(one.period, scale * one[name], **style)
            ax.set_xscale("log")
            ax.set_xticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
            ax.minorticks_off()
            ax.set_ylabel(label)
        band = axes[0, 0].axhspan(_WALKING.low, _WALKING.high, color="#EFE3C8", zorder=0)
        axes[0, 0].set_ylim(0.0, max(0.75, 1.1 * float(record.speed.max())))
        axes[0, 1].set_ylim(0.0, None)
        axes[1, 1].set_yscale("log")
        for ax in axes[1]:
            ax.set_xlabel("cycle time [s]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        models = [Line2D([], [], color=COLOURS["printed"], linewidth=width) for width in (_THICK, _THIN)]
        handles, labels = [*handles, *models, band], [*labels, *_SERVOS, f"{_WALKING.who}, high walk"]
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=11)
    return captioned(
        figure,
        "Every gait over its cycle time. Thin: legs whose servos lose torque with speed, whose cost includes what the "
        f"motor loses. Band: what {_WALKING.who} do in the high walk.",
    )
