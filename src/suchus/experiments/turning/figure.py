"""The picture of how curvature follows from bend and asymmetry, and of the radii that are walked."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.figures.style import COLOURS, captioned, panels, styled


def draw_turning(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw curvature against bend and asymmetry, and asked against measured radius."""
    with styled():
        figure, axes = panels(1, 3, width=11.5, height=4.0)
        for ax, name, label, scale in (
            (axes[0, 0], "bend", "curvature offset of the trunk [deg]", 180 / np.pi),
            (axes[0, 1], "asymmetry", "asymmetry of strokes [-]", 1.0),
        ):
            for gait in record.gait.values:
                ax.plot(scale * record[name], record[f"curvature_{name}"].sel(gait=gait), **lines[str(gait)])
            ax.set_xlabel(label)
            ax.set_ylabel("curvature of the path [1/m]")
            ax.set_ylim(-0.1, max(2.8, 1.05 * float(record.curvature_mixture.max())))
        axes[0, 0].legend(loc="upper left")
        ax = axes[0, 2]
        asked = record.asked.values
        ax.fill_between(asked, 0.9 * asked, 1.1 * asked, color="#E3E3E3", zorder=0, label="within 10 %")
        ax.plot(asked, asked, color=COLOURS["neutral"], linewidth=0.9)
        for gait in record.gait.values:
            style = dict(lines[str(gait)]) | {"linestyle": "none", "label": None}
            ax.plot(asked, record.radius.sel(gait=gait), **style)
        ax.set_xlabel("commanded radius [m]")
        ax.set_ylabel("measured radius [m]")
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "How the robot turns: left and middle, curvature of its path with a bent trunk and with unequal strokes; "
        "right, a turn command that mixes both.",
    )
