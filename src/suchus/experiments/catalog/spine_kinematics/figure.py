"""Figures of the spine: its workspace, and the error of the printed formulas."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from suchus.visual.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled

_MM = 1000.0
_COMPUTED_COLOUR, _PRINTED_COLOUR, _ALARM_COLOUR = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]
_OUTLINE = withStroke(linewidth=4.5, foreground="#222222")
_LIMB: dict[str, Any] = {"linewidth": 2.6, "markersize": 4.5, "path_effects": [_OUTLINE]}


def spine_workspace(record: xr.Dataset) -> Figure:
    """Draw the density of joint 5 over random postures, from above and from the side."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, height=4.3, sharey=True, sharex=True)
        views = (
            ("density_top", "top_x", "top_y", "y", ("straight", "left", "right"), "from above", "to the left [mm]"),
            ("density_side", "side_x", "side_z", "z", ("straight", "up", "down"), "from the side", "up [mm]"),
        )
        peak = float(record.density_top.max())
        for ax, (name, x, y, axis, postures, title, label) in zip(axes[0], views, strict=True):
            share = record[name].T.where(record[name].T > 0)
            norm = LogNorm(peak / 100, peak)
            mesh = ax.pcolormesh(_MM * record[x], _MM * record[y], share, cmap=SEQUENTIAL, norm=norm, rasterized=True)
            for posture in postures:
                points = _MM * record.posture_points.sel(posture=posture, axis=["x", axis])
                ax.plot(*points.values.T, "-o", color="#F25C54", label=f"_posture {posture}", **_LIMB)
            ax.plot(0, 0, "s", color=_PRINTED_COLOUR, markersize=9, label="_pelvis")
            ax.annotate("pelvis", (0, 0), (-4, 10), textcoords="offset points")
            ax.set_aspect("equal")
            ax.set_ylabel(label)
            ax.set_xlabel("ahead of the hips [mm]")
            ax.set_title(title)
        reach = _MM * float(record.posture_points.max())
        axes[0, 0].set(xlim=(-0.08 * reach, 1.05 * reach), ylim=(-0.75 * reach, 0.75 * reach))
        figure.colorbar(mesh, ax=axes[0].tolist(), label="share of random postures [-]", shrink=0.8)
    return captioned(
        figure,
        "Where the fifth spine joint gets to when every joint turns at random within its limits, yellow where it "
        "often is. Red: straight, and bent as far as the limits allow to each side, up and down. From straight no "
        "joint moves the end forward or back: the neutral posture is singular.",
    )


def spine_misprint(record: xr.Dataset) -> Figure:
    """Return the end of the spine as printed in (15), while bending and in random postures."""
    with styled():
        figure, axes = panels(1, 2, height=3.7, width_ratios=[1, 1.15])
        left_ax, right_ax = axes[0]
        for name in ("ours", "printed"):
            track = _MM * record[f"track_{name}"]
            left_ax.plot(track.sel(axis="y"), track.sel(axis="x"), **LINES[name])
        for bend in np.radians((-60, 0, 60)):
            ends = [_MM * record[f"track_{n}"].sel(bend=bend, method="nearest") for n in ("ours", "printed")]
            left_ax.plot(
                *[[e.sel(axis=a) for e in ends] for a in "yx"],
                "o-",
                color=_ALARM_COLOUR,
                linewidth=1.3,
                markersize=4,
                label=f"_ours and printed at {np.degrees(bend):.0f} degrees",
            )
        gap = _MM * float(record.track_ours.sel(bend=0)[0] - record.track_printed.sel(bend=0)[0])
        middle = _MM * float(record.track_ours.sel(bend=0)[0]) - gap / 2
        left_ax.annotate(f"{gap:.0f} mm", (0, middle), (6, -4), textcoords="offset points", color=_ALARM_COLOUR)
        left_ax.set_aspect("equal")
        left_ax.invert_xaxis()
        left_ax.set_xlabel("left [mm]")
        left_ax.set_ylabel("ahead of the hips [mm]")
        left_ax.set_title("joint 5 while the trunk bends")
        left_ax.plot(0, 0, "s", color=_PRINTED_COLOUR, markersize=8, label="_pelvis")
        left_ax.annotate("pelvis", (0, 0), (9, -2), textcoords="offset points")
        left_ax.set_ylim(-15, middle + gap)
        left_ax.legend(loc="center", bbox_to_anchor=(0.5, 0.3))
        edges = np.append(record.error, 2 * record.error[-1] - record.error[-2]) * _MM
        right_ax.stairs(100 * record.error_share.values, edges, color=_PRINTED_COLOUR, fill=True, alpha=0.55)
        right_ax.axvline(0, color=_COMPUTED_COLOUR, linewidth=2.4)
        right_ax.text(1.5, 0.92 * 100 * float(record.error_share.max()), "ours", color=_COMPUTED_COLOUR, weight="bold")
        right_ax.set_xlabel("error of (15) [mm]")
        right_ax.set_ylabel("share of the postures [%]")
        right_ax.set_title("joints within 30 deg")
    return captioned(
        figure,
        "Equation (15) as printed has lost a term. Left: joint 5 from above while the three yaw joints share a bend of "
        "90 degrees to either side; red lines join what belongs together. Right: how far off (15) is in random "
        "postures; there is none in which it is right.",
    )


def spine_least_bending(record: xr.Dataset) -> Figure:
    """Draw the postures with the same end and azimuth, and the choice of the least bent one."""
    with styled():
        figure, axes = panels(1, 2, height=3.7, width_ratios=[1, 1.1])
        left_ax, right_ax = axes[0]
        for member in record.family_points:
            left_ax.plot(
                *(_MM * member.sel(axis=["y", "x"])).values.T,
                "-o",
                color=COLOURS["neutral"],
                alpha=0.45,
                lw=1.3,
                label="_posture with the same end",
            )
        best = _MM * record.best_points.sel(axis=["y", "x"])
        left_ax.plot(*best.values.T, "-o", color=_COMPUTED_COLOUR, linewidth=2.8, label="_least bent posture")
        left_ax.plot(*best.values[-2], "o", color=_ALARM_COLOUR, markersize=9, zorder=5, label="_joint 5")
        left_ax.annotate(
            "joint 5", best.values[-2], (-7, 8), textcoords="offset points", color=_ALARM_COLOUR, ha="right"
        )
        left_ax.annotate("snout", best.values[-1], (0, 9), textcoords="offset points", ha="center")
        left_ax.set_aspect("equal")
        left_ax.invert_xaxis()
        left_ax.margins(x=0.2, y=0.16)
        left_ax.set_xlabel("left [mm]")
        left_ax.set_ylabel("ahead of the hips [mm]")
        left_ax.set_title("same place, same azimuth")
        yaw_degrees = np.degrees(record.first_yaw)
        for branch, dashes in ((1, "-"), (-1, (0, (4, 2)))):
            label = "second pitch down" if branch == 1 else "second pitch up"
            right_ax.plot(
                yaw_degrees, record.bending.sel(branch=branch), linestyle=dashes, color=COLOURS["spine"], label=label
            )
        min_bending = float((record.best_angles**2).sum())
        right_ax.plot(
            np.degrees(record.best_angles[0]),
            min_bending,
            "o",
            color=_COMPUTED_COLOUR,
            markersize=9,
            label="_least bending",
        )
        right_ax.annotate(
            "least bending",
            (float(np.degrees(record.best_angles[0])), min_bending),
            (0, -18),
            textcoords="offset points",
            ha="center",
            color=_COMPUTED_COLOUR,
            weight="bold",
        )
        _fit_to_finite(right_ax, yaw_degrees.values, record.bending.values)
        right_ax.set_xlabel("first yaw angle [deg]")
        right_ax.set_ylabel("sum of squared angles [rad²]")
        right_ax.legend(loc="upper center")
    return captioned(
        figure,
        "The spine's inverse leaves one joint free. Left, from above: every grey posture brings joint 5 to the same "
        "point "
        "with the head in the same direction. Right: the sum of the squared joint angles over the free angle, on both "
        "branches; blue is the posture that is taken.",
    )


def _fit_to_finite(ax: Axes, x: np.ndarray, y: np.ndarray) -> None:
    """Fit the axes to the finite values, with margins for a label below and a legend above."""
    finite_x = x[np.isfinite(y).any(axis=0)]
    ax.set_xlim(finite_x.min() - 4, finite_x.max() + 4)
    y_min, y_max = np.nanmin(y), np.nanmax(y)
    ax.set_ylim(y_min - 0.2 * (y_max - y_min), y_max + 0.3 * (y_max - y_min))
