"""How steadily the body is carried: heights, snapshots with their support, variations."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.design import Crocodile
from suchus.figures.posture import draw_posture
from suchus.figures.style import COLOURS, LINES, captioned, panels, styled
from suchus.figures.timeseries import draw_lines, mark_cycles
from suchus.metrics import between
from suchus.motion import START


def draw_heights(record: xr.Dataset, arms: Sequence[str]) -> Figure:
    """Draw the height of the centre of mass about its mean: at equal commands, then at equal displacement.

    Args:
        record: of one run per arm, then the legs alone at equal displacement.
        arms: roles of the first runs.
    """
    part = between(record)
    height = part.centre_of_mass.sel(xyz="z")
    height = height - height.mean("time")
    with styled():
        figure, axes = panels(2, 1, height=6.4, sharex=True, sharey=True)
        upper, lower = axes[:, 0]
        draw_lines(upper, height.isel(run=slice(0, len(arms))), arms, scale=1000.0)
        upper.set_title("equal commands to the legs")
        draw_lines(lower, height.isel(run=[0, len(arms)]), (arms[0], arms[-1]), scale=1000.0)
        lower.set_title("equal displacement: longer strokes for the legs alone")
        for ax in (upper, lower):
            ax.set_ylabel("height − mean [mm]")
            mark_cycles(ax, list(np.arange(START, float(part.time[-1]) + 0.01, float(part.period[0]))))
        upper.set_xlabel("")
        upper.legend(ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.02), frameon=False)
    return captioned(
        figure,
        "Height of the centre of mass about its mean. Above: the four arms with identical leg commands. Below: the "
        "legs alone with strokes long enough to get as far as spine and tail do. Dotted lines: beginnings of cycles.",
    )


def draw_snapshots(robot: Crocodile, record: xr.Dataset, arms: Mapping[str, int], times: Sequence[float]) -> Figure:
    """Draw postures from above with support and projected centre of mass.

    Args:
        robot: whose record it is.
        record: with the dimension ``run``.
        arms: role and run of each row.
        times: of the columns [s].
    """
    with styled(axes__grid=False):
        figure, axes = panels(len(arms), len(times), width=10.5, height=1.9 * len(arms), sharex="row", sharey="row")
        for row, (role, run) in zip(axes, arms.items(), strict=True):
            for ax, time in zip(row, times, strict=True):
                draw_posture(ax, robot, record.isel(run=run), time)
                ax.set_axis_off()
            row[0].set_title(f"{LINES[role]['label']}, {times[0]:g} s", color=COLOURS[role])
            for ax, time in list(zip(row, times, strict=True))[1:]:
                ax.set_title(f"{time:g} s", color=COLOURS[role])
    return captioned(
        figure,
        "Postures from above at the article's three times. Filled feet stand; the yellow line or area is what they "
        "support, the red mark the centre of mass projected onto the ground.",
    )


def draw_variations(record: xr.Dataset) -> Figure:
    """Draw the fluctuation of varied crawls against that of the legs alone."""
    with styled():
        figure, axes = panels(1, 1, width=5.6, height=5.0)
        ax = axes[0, 0]
        alone = 1000 * record.varied_std.sel(arm="limbs_only")
        top = 1.08 * 1000 * float(record.varied_std.max())
        ax.fill_between([0, top], [0, top], color="#F1F1F1", zorder=0)
        ax.plot([0, top], [0, top], color=COLOURS["neutral"], linewidth=1.0)
        for role, marker in (("coordinated", "o"), ("tail_drag", "s")):
            ax.plot(
                alone,
                1000 * record.varied_std.sel(arm=role),
                marker,
                color=COLOURS[role],
                markeredgecolor="white",
                markersize=8,
                label=LINES[role]["label"],
            )
        ax.set_xlim(0, top)
        ax.set_ylim(0, top)
        ax.set_aspect("equal")
        ax.text(0.97 * top, 0.05 * top, "steadier than legs alone", ha="right", color=COLOURS["printed"])
        ax.set_xlabel("std of height, limbs only [mm]")
        ax.set_ylabel("std of height [mm]")
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "Fluctuation of the centre of mass's height in crawls with other strokes, bends, lifts, duty factors and grip, "
        "against that of the legs alone with the same legs on the same ground. Below the line is steadier.",
    )
