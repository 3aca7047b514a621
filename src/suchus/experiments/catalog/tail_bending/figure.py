"""Pictures of the cable-driven tail."""

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from suchus.sim.metrics import tail_joint_spread
from suchus.visual.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled

_MM = 1000.0
_COMPUTED_COLOUR, _PRINTED_COLOUR, _ALARM_COLOUR = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]


def tail_positions(record: xr.Dataset) -> Figure:
    """Draw the tail at several bends, exact with its plates and as printed in (19)."""
    with styled():
        figure, axes = panels(1, 2, height=3.9, sharex=True, sharey=True)
        left_ax, right_ax = axes[0]
        shades = (COLOURS["water"], COLOURS["ours"], "#083B5C")
        for i, (bend, shade) in enumerate(zip(record["shape"].values, shades, strict=False)):
            end, name = _MM * record.end[i].values, f"{np.degrees(bend):.0f}°"
            line = np.vstack([[0, 0], _MM * record.joints_ours[i].values, end])
            _plates(left_ax, line, record, shade)
            left_ax.plot(*line.T, "-o", color=shade, markersize=4, linewidth=1.6, label=f"_bend {name}")
            direction = np.array([np.cos(bend), np.sin(bend)])
            tip, side = end + 36 * direction, ("right", "center", "left")[int(np.rint(direction[0])) + 1]
            left_ax.text(*tip, name, color=shade, ha=side, va="center", weight="bold")
            printed_points = np.vstack([[0, 0], _MM * record.joints_printed[i].values])
            right_ax.plot(*printed_points.T, "-o", color=shade, markersize=4, linewidth=1.6, label=f"_bend {name}")
            right_ax.annotate(
                name, printed_points[-1], (10, -10), textcoords="offset points", color=shade, weight="bold"
            )
        for ax, title in zip(axes[0], ("ours", "as printed, (19)"), strict=True):
            ax.set_aspect("equal")
            ax.set_xlabel("backward [mm]")
            ax.set_title(title)
        left_ax.set_ylabel("to the right [mm]")
        left_ax.margins(0.12)  # both panels have one scale, so that lengths can be compared
    return captioned(
        figure,
        "The cable section of the tail, straight and bent. Left: our joints and end lie in the middle of the gaps "
        "between the plates. Right: the printed (19) repeats the cosine, so that the straight tail points 45 degrees "
        "sideways and the bent one folds onto a line.",
    )


def _plates(ax: Axes, line: np.ndarray, record: xr.Dataset, shade: str) -> None:
    """Draw the plates between the joints; line begins in the middle of the first and ends in that of the last."""
    plate, width = _MM * record.attrs["plate"], 1.1 * _MM * record.attrs["cord_spacing"]
    for i in range(len(line) - 1):
        axial = (line[i + 1] - line[i]) / np.linalg.norm(line[i + 1] - line[i])
        transverse = np.array([-axial[1], axial[0]]) * width / 2
        middle = line[0] if i == 0 else line[-1] if i == len(line) - 2 else (line[i] + line[i + 1]) / 2
        ends = [middle - axial * plate / 2, middle + axial * plate / 2]
        corners = [ends[0] - transverse, ends[1] - transverse, ends[1] + transverse, ends[0] + transverse]
        ax.add_patch(Polygon(corners, facecolor="white", edgecolor=shade, linewidth=1.0))


def tail_cord_error(record: xr.Dataset) -> Figure:
    """Return the error of (17) against the exact (16) over the bend."""
    with styled():
        figure, axes = panels(2, 1, height=5.2, sharex=True)
        upper_ax, lower_ax = axes[:, 0]
        bend = np.degrees(record.bend)
        upper_ax.axhline(0, color=COLOURS["neutral"], linewidth=1)
        upper_ax.plot(
            bend, 100 * record.error_away, color=COLOURS["limbs_only"], linestyle=(0, (5, 2)), label="_cord let out"
        )
        upper_ax.plot(bend, 100 * record.error_toward, color=_COMPUTED_COLOUR, label="_cord pulled in")
        upper_ax.text(
            0.07, 0.82, "cord let out: (17) gives too much", color=COLOURS["limbs_only"], transform=upper_ax.transAxes
        )
        upper_ax.text(
            0.07, 0.12, "cord pulled in: (17) pulls too little", color=_COMPUTED_COLOUR, transform=upper_ax.transAxes
        )
        upper_ax.set_ylabel("error of (17) [%]")
        missing = np.degrees(record.deficit)
        lower_ax.plot(
            bend, missing, color=COLOURS["spine"], linestyle=(0, (5, 1.5, 1, 1.5)), label="bend missing [deg]"
        )
        lower_ax.plot(bend, _MM * record.slack, color=_ALARM_COLOUR, label="cord hanging loose [mm]")
        lower_ax.legend(loc="upper left")
        lower_ax.set_ylabel("missing bend [deg],\nloose cord [mm]")
        lower_ax.set_xlabel("bend of the tail [deg]")
        lower_ax.set_xlim(0, float(bend.max()))
        lower_ax.set_xticks(np.arange(0, float(bend.max()) + 1, 30))
    return captioned(
        figure,
        "What (17) leaves out. Above: its relative error for both cords over the bend; the neglected term is exactly "
        "h/d tan(theta / 4N) of the kept one. Below: the cord that hangs loose because one drive moves both cords "
        "alike, and how much bend is missing when the cord towards it is drawn in by N times (17), as (18) does.",
    )


def tail_cords(record: xr.Dataset) -> Figure:
    """Return cords and servo over the bend."""
    with styled():
        figure, axes = panels(1, 2, height=3.6, width_ratios=[1.2, 1])
        left_ax, right_ax = axes[0]
        bend = np.degrees(record.bend)
        for name, sign in (("toward", -1), ("away", 1)):
            left_ax.plot(
                bend, _MM * record[name], color=_COMPUTED_COLOUR, label="exact, (16) times N" if sign > 0 else None
            )
            label = "shortened, (17) times N" if sign > 0 else None
            left_ax.plot(bend, sign * _MM * record.shortened, color=_PRINTED_COLOUR, linestyle=(0, (4, 2)), label=label)
        left_ax.text(0.95, 0.57, "away", ha="right", color=_COMPUTED_COLOUR, transform=left_ax.transAxes)
        left_ax.text(0.66, 0.1, "toward the bend", ha="right", color=_COMPUTED_COLOUR, transform=left_ax.transAxes)
        left_ax.set_ylabel("change of the cord [mm]")
        left_ax.set_title("cords")
        left_ax.legend(loc="upper left", fontsize=10)
        left_ax.set_ylim(top=1.45 * _MM * float(record.shortened.max()))
        linear = record.servo.attrs["units"] == "m"
        drive = _MM * record.servo if linear else np.degrees(record.servo)
        right_ax.plot(bend, drive, color=COLOURS["tail"])
        right_ax.set_ylabel("travel to one side [mm]" if linear else "pulley angle [deg]")
        right_ax.set_title("linear actuator, X" if linear else "servo, (18)")
        for ax in (left_ax, right_ax):
            ax.set_xlabel("bend of the tail [deg]")
            ax.set_xlim(0, float(bend.max()))
            ax.set_xticks(np.arange(0, float(bend.max()) + 1, 45))
        if not linear:
            right_ax.set_yticks(np.arange(0, float(drive.max()) + 15, 45))
    return captioned(
        figure,
        f"Cords and {'actuator' if linear else 'servo'} of the tail. Left: change in length of both cords over all "
        f"joints, exact and shortened. Right: how far the {'linear actuator moves' if linear else 'pulley turns'}.",
    )


def tail_joints(record: xr.Dataset, tolerance: float) -> Figure:
    """Return the angles of the cable joints over time in both crawls, and how far they differ.

    Args:
        record: ``crawl_angle`` over crawl, time and joint [rad].
        tolerance: joints that differ by no more count as turned alike [rad].
    """
    names = {"gait": "spine and tail", "straight": "trunk straight"}
    count = record.sizes["joint"]
    spread = tail_joint_spread(record.crawl_angle, [str(name) for name in record.joint.values])
    with styled():
        figure, axes = panels(2, 2, width=10.0, height=5.4, sharex=True, sharey="row", height_ratios=[1.6, 1])
        for column, (crawl, name) in zip(axes.T, names.items(), strict=True):
            upper_ax, lower_ax = column
            for i, joint in enumerate(record.joint.values):
                shade = mpl.colormaps[SEQUENTIAL](0.05 + 0.85 * i / max(count - 1, 1))
                angle = np.degrees(record.crawl_angle.sel(crawl=crawl, joint=joint))
                upper_ax.plot(record.time, angle, color=shade, linewidth=1.4, label=f"joint {i + 1}")
            upper_ax.set_title(name)
            lower_ax.plot(record.time, np.degrees(spread.sel(crawl=crawl)), color=_ALARM_COLOUR)
            lower_ax.axhline(np.degrees(tolerance), color=COLOURS["neutral"], linewidth=1.2, linestyle=":")
            lower_ax.set_xlabel("time [s]")
        axes[0, 0].set_ylabel("angle of the joint [deg]")
        axes[1, 0].set_ylabel("difference [deg]")
        axes[1, 0].set_ylim(bottom=0.0)
        if count <= 8:
            figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=count)
    shares = [float((spread.sel(crawl=crawl) > tolerance).mean()) for crawl in names]
    return captioned(
        figure,
        "Whether all joints of the tail turn by the same angle, as the formulas of III.C assume. Above: their angles "
        "in the crawl, from the root (1) to the tip, with spine and tail and with the trunk straight. Below: the "
        f"greatest difference between two of them; it is beyond the dotted {np.degrees(tolerance):.0f} degrees for "
        f"{shares[0]:.0%} and {shares[1]:.0%} of the time.",
    )
