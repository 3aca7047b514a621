"""Pictures of the cable-driven tail."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from suchus.figures.style import COLOURS, captioned, panels, styled

_MM = 1000.0
_OURS, _PRINTED, _ALARM = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]
_PALE = "#CFE3F1"


def tail_positions(record: xr.Dataset) -> Figure:
    """Return the tail at several bends, ours with its plates and as printed in (19)."""
    with styled():
        figure, axes = panels(1, 2, height=3.9, sharex=True, sharey=True)
        for shape, bend in zip(range(record.sizes["shape"]), record["shape"].values, strict=True):
            strength = 0.35 + 0.65 * shape / max(record.sizes["shape"] - 1, 1)
            ours = _MM * record.joints_ours[shape].values
            end = _MM * record.end[shape].values
            line = np.vstack([[0, 0], ours, end])
            axes[0, 0].plot(line[:, 0], line[:, 1], "-o", color=_OURS, alpha=strength, markersize=4, linewidth=1.5)
            _plates(axes[0, 0], line, record, strength)
            tip = end + 26 * np.array([np.cos(bend), np.sin(bend)])
            axes[0, 0].text(*tip, f"{np.degrees(bend):.0f}°", color=_OURS, ha="center", va="center")
            wrong = np.vstack([[0, 0], _MM * record.joints_printed[shape].values])
            axes[0, 1].plot(wrong[:, 0], wrong[:, 1], "-o", color=_PRINTED, alpha=strength, markersize=4, linewidth=1.5)
            away = wrong[-1] + 26 * np.sign(wrong[-1, 0] or 1) * np.array([0.7, 0.7])
            axes[0, 1].text(*away, f"{np.degrees(bend):.0f}°", color=_PRINTED, ha="center", va="center")
        for ax, title in zip(axes[0], ("ours", "as printed, (19)"), strict=True):
            ax.set_aspect("equal")
            ax.set_xlabel("backward [mm]")
            ax.set_title(title)
        axes[0, 0].set_ylabel("to the right [mm]")
    return captioned(
        figure,
        "The cable section of the tail, straight and bent. Left: our joints and end lie in the middle of the gaps "
        "between the plates. Right: the printed (19) repeats the cosine, so that the straight tail points 45 degrees "
        "sideways and the bent one folds onto a line.",
    )


def _plates(ax: Axes, line: np.ndarray, record: xr.Dataset, strength: float) -> None:
    """Draw the plates between the joints; the first and the last begin or end at their middles."""
    plate, width = _MM * record.attrs["plate"], 1.1 * _MM * record.attrs["cord_spacing"]
    for i in range(len(line) - 1):
        along = (line[i + 1] - line[i]) / np.linalg.norm(line[i + 1] - line[i])
        across = np.array([-along[1], along[0]]) * width / 2
        middle = line[0] if i == 0 else line[-1] if i == len(line) - 2 else (line[i] + line[i + 1]) / 2
        ends = [middle - along * plate / 2, middle + along * plate / 2]
        corners = [ends[0] - across, ends[1] - across, ends[1] + across, ends[0] + across]
        ax.add_patch(Polygon(corners, facecolor=_PALE, edgecolor=_OURS, alpha=0.6 * strength, linewidth=0.8))


def tail_cord_error(record: xr.Dataset) -> Figure:
    """Return the error of (17) against the exact (16) over the bend."""
    with styled():
        figure, axes = panels(2, 1, height=5.2, sharex=True)
        above, below = axes[:, 0]
        bend = np.degrees(record.bend)
        above.axhline(0, color=COLOURS["neutral"], linewidth=1)
        above.plot(bend, 100 * record.error_away, color=COLOURS["limbs_only"], linestyle=(0, (5, 2)))
        above.plot(bend, 100 * record.error_toward, color=_OURS)
        above.text(92, 3.0, "cord let out: (17) gives too much", color=COLOURS["limbs_only"], ha="right")
        above.text(92, -3.4, "cord pulled in: (17) pulls too little", color=_OURS, ha="right")
        above.set_ylabel("error of (17) [%]")
        below.plot(bend, _MM * record.slack, color=_ALARM)
        below.text(100, _MM * float(record.slack.max()) * 0.52, "slack [mm]", color=_ALARM, ha="right")
        below.plot(bend, np.degrees(record.deficit), color=COLOURS["spine"], linestyle=(0, (5, 1.5, 1, 1.5)))
        below.text(178, 1.3, "bend missing if (18) drives the cord [deg]", color=COLOURS["spine"], ha="right")
        below.set_ylabel("[mm], [deg]")
        below.set_xlabel("bend of the tail [deg]")
        below.set_xlim(0, float(bend.max()))
        below.set_xticks(np.arange(0, float(bend.max()) + 1, 30))
    return captioned(
        figure,
        "What (17) leaves out. Above: its relative error for both cords over the bend; the neglected term is exactly "
        "h/d tan(theta / 4N) of the kept one. Below: the cord that hangs loose because both cords sit on one wheel, "
        "and "
        "how much bend is missing when the wheel turns by (18).",
    )


def tail_cords(record: xr.Dataset) -> Figure:
    """Return cords and servo over the bend."""
    with styled():
        figure, axes = panels(1, 2, height=3.6, width_ratios=[1.2, 1])
        left, right = axes[0]
        bend = np.degrees(record.bend)
        for name, sign in (("toward", -1), ("away", 1)):
            left.plot(bend, _MM * record[name], color=_OURS, label="exact, (16) times N" if sign > 0 else None)
            label = "shortened, (17) times N" if sign > 0 else None
            left.plot(bend, sign * _MM * record.shortened, color=_PRINTED, linestyle=(0, (4, 2)), label=label)
        left.text(170, 45, "away", ha="right", color=_OURS)
        left.text(120, -70, "toward the bend", ha="right", color=_OURS)
        left.set_ylabel("change of the cord [mm]")
        left.set_title("cords")
        left.legend(loc="upper left", fontsize=10)
        left.set_ylim(top=1.45 * _MM * float(record.shortened.max()))
        right.plot(bend, np.degrees(record.servo), color=COLOURS["tail"])
        right.set_ylabel("wheel angle [deg]")
        right.set_title("servo, (18)")
        for ax in (left, right):
            ax.set_xlabel("bend of the tail [deg]")
            ax.set_xlim(0, float(bend.max()))
            ax.set_xticks(np.arange(0, float(bend.max()) + 1, 45))
        right.set_yticks(np.arange(0, float(np.degrees(record.servo.max())) + 15, 45))
    return captioned(
        figure,
        "Cords and servo of the tail. Left: change in length of both cords over all joints, exact and shortened. "
        "Right: how far the wheel turns.",
    )
