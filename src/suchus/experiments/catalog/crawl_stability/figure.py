"""How steadily the body is carried: heights, snapshots with their support, variations."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.experiments.catalog._two_groups import of_robots, robots_built
from suchus.robot.design import Robot
from suchus.robot.motion import START
from suchus.sim.metrics import height_peak_to_peak, time_window
from suchus.visual.figures.posture import draw_posture
from suchus.visual.figures.style import COLOURS, LINES, captioned, panels, styled
from suchus.visual.figures.timeseries import draw_lines, mark_cycles


def draw_heights(record: xr.Dataset, names: Sequence[str]) -> Figure:
    """Draw the height of the centre of mass about its mean: at equal commands, then at equal displacement.

    Args:
        record: record of one run per condition, then the legs alone at equal displacement.
        names: names of the conditions, roles of ``style.LINES``; with spine and tail first, limbs only second.
    """
    walk = time_window(record)
    height = walk.centre_of_mass.sel(xyz="z")
    height = height - height.mean("time")
    with styled():
        figure, axes = panels(2, 1, height=7.0, sharex=True, sharey=True)
        upper_ax, lower_ax = axes[:, 0]
        draw_lines(upper_ax, height.isel(run=slice(0, len(names))), names, scale=1000.0)
        upper_ax.set_title("equal commands to the legs")
        draw_lines(lower_ax, height.isel(run=[0, len(names)]), (names[0], names[1]), scale=1000.0)
        lower_ax.set_title("equal displacement: longer strokes for the legs alone")
        for ax in (upper_ax, lower_ax):
            ax.set_ylabel("height of centre of mass\nless its mean [mm]")
            mark_cycles(ax, list(np.arange(START, float(walk.time[-1]) + 0.01, float(walk.period[0]))))
        upper_ax.set_xlabel("")
        upper_ax.legend(ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.02), frameon=False)
    return captioned(
        figure,
        "Height of the centre of mass about its mean. Above: all conditions with identical leg commands. Below: the "
        "legs alone with strokes long enough to get as far as spine and tail do, or with their longest. Dotted lines: "
        "beginnings of cycles.",
    )


def draw_spreads(record: xr.Dataset, names: Sequence[str]) -> Figure:
    """Draw the fluctuation of the height in every condition, of the robots as built and of the design.

    Args:
        record: record with one run per condition and the fluctuation of the robots as built.
        names: conditions, roles of ``style.LINES``.
    """
    fluctuation = 1000 * height_peak_to_peak(record)
    with styled():
        figure, axes = panels(1, 1, height=4.0)
        ax = axes[0, 0]
        for i, name in enumerate(names):
            (heights,), row = of_robots(record, "com_height_pp", name), len(names) - i
            repeat_fluctuations = 1000 * heights
            labels = [
                ("" if i == 0 else "_") + label for label in ("each robot as built", "their middle", "as designed")
            ]
            ax.plot(
                repeat_fluctuations,
                [row] * repeat_fluctuations.size,
                "|",
                color=COLOURS[name],
                markersize=13,
                alpha=0.6,
                label=labels[0],
            )
            ax.plot(float(repeat_fluctuations.median()), row, "o", color=COLOURS[name], markersize=9, label=labels[1])
            ax.plot(float(fluctuation[i]), row, "x", color=COLOURS["neutral"], markersize=7, label=labels[2])
        ax.legend(loc="lower left")
        ax.set_yticks(range(len(names), 0, -1), [str(LINES[name]["label"]) for name in names])
        ax.set_ylim(0.4, len(names) + 0.6)
        ax.set_xlim(left=0.0)
        ax.set_xlabel("height of the centre of mass, highest − lowest [mm]")
    return captioned(
        figure,
        "Fluctuation of the height of the centre of mass in every condition: of "
        f"{robots_built(record)}, whose servos' zeros, play, masses and friction differ "
        "from it within their tolerances, and of the design itself.",
    )


def draw_snapshots(robot: Robot, record: xr.Dataset, arms: Mapping[str, int], times: Sequence[float]) -> Figure:
    """Draw postures from above with support and projected centre of mass.

    Args:
        robot: robot whose record it is.
        record: record with the dimension ``run``.
        arms: role and run of each row.
        times: times of the columns [s].
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
        "Postures from above at the article's three times. Filled feet stand; the yellow line or area is the "
        "support by feet and tail, the red mark the centre of mass projected onto the ground.",
    )
