"""Pictures of legs and spine: where they reach, and what the printed formulas do instead."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.patheffects import withStroke

from suchus.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled

_MM = 1000.0
_OURS, _PRINTED, _ALARM = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]
_EXACT = 1e-9  # [m]
_OUTLINE = withStroke(linewidth=4.5, foreground="#222222")
_LIMB: dict[str, Any] = {"linewidth": 2.6, "markersize": 4.5, "path_effects": [_OUTLINE]}


def leg_inverse(record: xr.Dataset) -> Figure:
    """Return where the printed inverse (14) misses, and by how much, beside ours."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, width=8.2, height=3.9, width_ratios=[1.25, 1])
        figure.set_layout_engine("constrained", wspace=0.08)
        left, right = axes[0]
        miss = record.printed_error.values
        x, z = _MM * record.outward, _MM * record.down
        exact = np.where(miss < _EXACT, 1.0, np.nan)
        left.pcolormesh(x, z, exact, cmap="Blues", vmin=0, vmax=4, rasterized=True)
        wrong = np.where(miss < _EXACT, np.nan, _MM * miss)
        mesh = left.pcolormesh(x, z, wrong, cmap=SEQUENTIAL, vmin=0, vmax=350, rasterized=True)
        figure.colorbar(mesh, ax=left, label="foot lands off by [mm]", shrink=0.85)
        hip = _MM * record.attrs["hip_offset"]
        left.plot(hip, 0, "o", color=_ALARM, markersize=6)
        left.text(
            hip + 350 * record.attrs["far"], 400 * record.attrs["far"], "exact", color=_OURS, ha="center", weight="bold"
        )
        left.annotate("hip", (hip, 0), (8, -13), textcoords="offset points", color=_ALARM)
        _section_axes(left, "as printed, (14)")
        edges = _MM * record.error.values
        right.stairs(100 * record.share_printed.values[:-1], edges, color=_PRINTED, fill=True, alpha=0.5)
        right.stairs(100 * record.share_ours.values[:-1], edges, color=_OURS, linewidth=1.8)
        right.set_xscale("log")
        right.set_xlim(1e-15, 1e3)
        right.set_xticks([1e-15, 1e-10, 1e-5, 1], minor=False)
        right.set_xlabel("foot lands off by [mm]")
        right.set_ylabel("share of the points [%]")
        top = 100 * float(max(record.share_printed.max(), record.share_ours.max()))
        right.text(3e-11, 0.9 * top, "ours", color=_OURS, weight="bold")
        right.text(1e-3, 0.45 * top, "as printed", color=_PRINTED, ha="center", weight="bold")
        right.set_title("all points in reach")
    return captioned(
        figure,
        "The printed inverse of the leg. Left: upright section through the hip; in the blue quarter, outboard of and "
        "below the hip, (14) is exact; elsewhere its arctan is half a turn off. Right: over the whole workspace our "
        "solution lands within rounding, the printed one only in a quarter of it.",
    )


def _section_axes(ax: Axes, title: str) -> None:
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.set_xlabel("outward from the midline [mm]")
    ax.set_ylabel("below the hip [mm]")
    ax.set_title(title)


def leg_workspace(record: xr.Dataset) -> Figure:
    """Return where the foot reaches within the joints' limits, with three postures."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, height=3.7)
        views = (("dexterity_section", "down", "from the front"), ("dexterity_top", "ahead", "from above"))
        for ax, (name, up, title) in zip(axes[0], views, strict=True):
            mesh = ax.pcolormesh(
                _MM * record.outward, _MM * record[up], record[name], cmap=SEQUENTIAL, vmin=0, vmax=0.8, rasterized=True
            )
            _leg_reach(ax, record, record.attrs["floor"] if up == "ahead" else 0.0)
            _section_axes(ax, title)
            drawn = list(zip(("#FFFFFF", "#F7B267", "#F25C54"), record.posture.values, strict=True))
            for colour, posture in drawn[: 1 if up == "ahead" else None]:
                points = _MM * record.posture_points.sel(posture=posture, axis=["outward", up])
                ax.plot(*points.values.T, "-o", color=colour, label=str(posture), **_LIMB)
            ax.set_facecolor("#D9DDE1")
        axes[0, 1].invert_yaxis()
        axes[0, 1].set_ylabel("ahead of the hip [mm]")
        axes[0, 0].axhline(_MM * record.attrs["floor"], color="white", linewidth=0.8, linestyle=":")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3)
        figure.colorbar(mesh, ax=axes[0].tolist(), label="dexterity, |det J| scaled [-]", shrink=0.75)
    return captioned(
        figure,
        "Where the hind foot reaches within the joints' limits, from the front (through the hip) and from above "
        "(in the plane on which a sprawled foot stands, dotted). Grey: out of reach; dashed: the reach without "
        "limits. Dark: the leg is near a singularity, straight, folded or with the foot on the yaw axis. Legs: "
        "sprawled, semi-erect and erect.",
    )


def _leg_reach(ax: Axes, record: xr.Dataset, depth: float) -> None:
    for reach in (record.attrs["near"], record.attrs["far"]):
        if reach > depth:
            radius = _MM * float(np.sqrt(reach**2 - depth**2))
            centre = (_MM * record.attrs["hip_offset"], 0.0)
            ax.add_patch(Circle(centre, radius, fill=False, edgecolor=COLOURS["neutral"], linewidth=1, linestyle="--"))


def leg_misprints(record: xr.Dataset) -> Figure:
    """Return what the denominator of (10) and the labels of Table I do."""
    with styled():
        figure, axes = panels(1, 2, height=3.6)
        left, right = axes[0]
        distance = _MM * record.distance
        left.plot(distance, np.degrees(record.knee_ours), **LINES["ours"])
        left.plot(distance, np.degrees(record.knee_printed), **LINES["printed"])
        nowhere = distance.values[np.isnan(record.knee_printed.values)]
        if nowhere.size:
            left.axvspan(nowhere.min(), nowhere.max(), color=_ALARM, alpha=0.12, linewidth=0)
            left.text(nowhere.mean(), 5, "no value", color=_ALARM, ha="center", rotation=90, va="bottom")
        left.set_xlabel("from hip to foot [mm]")
        left.set_ylabel("knee angle [deg]")
        left.set_yticks(range(0, 181, 30))
        left.set_title("(10): 2 AB AC for 2 AB BC")
        left.legend(loc="lower left", bbox_to_anchor=(0.22, 0.02))
        turn = np.degrees(record.turn)
        right.plot(turn, _MM * record.path_ours.sel(axis="down"), **LINES["ours"])
        right.plot(turn, _MM * record.path_by_label.sel(axis="down"), **LINES["printed"])
        right.set_xlabel("second joint [deg]")
        right.set_ylabel("foot below the hip [mm]")
        right.set_xticks(range(-60, 91, 30))
        right.invert_yaxis()
        right.set_title("Table I under its labels")
    return captioned(
        figure,
        "Two misprints of the leg. Left: the knee angle by the printed denominator of (10) agrees with ours at "
        "two distances only and has no value near the hip. Right: fed to (1) under its printed labels, Table I "
        "turns the second joint into another yaw joint: the foot never leaves the level of the hip.",
    )


def spine_workspace(record: xr.Dataset) -> Figure:
    """Return how often joint 5 of a random posture is where, from above and from the side."""
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
                ax.plot(*points.values.T, "-o", color="#F25C54", **_LIMB)
            ax.plot(0, 0, "s", color=_PRINTED, markersize=9)
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
        left, right = axes[0]
        for name in ("ours", "printed"):
            track = _MM * record[f"track_{name}"]
            left.plot(track.sel(axis="y"), track.sel(axis="x"), **LINES[name])
        for bend in np.radians((-60, 0, 60)):
            ends = [_MM * record[f"track_{n}"].sel(bend=bend, method="nearest") for n in ("ours", "printed")]
            left.plot(*[[e.sel(axis=a) for e in ends] for a in "yx"], "o-", color=_ALARM, linewidth=1.3, markersize=4)
        gap = _MM * float(record.track_ours.sel(bend=0)[0] - record.track_printed.sel(bend=0)[0])
        middle = _MM * float(record.track_ours.sel(bend=0)[0]) - gap / 2
        left.annotate(f"{gap:.0f} mm", (0, middle), (6, -4), textcoords="offset points", color=_ALARM)
        left.set_aspect("equal")
        left.invert_xaxis()
        left.set_xlabel("left [mm]")
        left.set_ylabel("ahead of the hips [mm]")
        left.set_title("joint 5 while the trunk bends")
        left.plot(0, 0, "s", color=_PRINTED, markersize=8)
        left.annotate("pelvis", (0, 0), (9, -2), textcoords="offset points")
        left.set_ylim(-15, middle + gap)
        left.legend(loc="center", bbox_to_anchor=(0.5, 0.3))
        edges = np.append(record.error, 2 * record.error[-1] - record.error[-2]) * _MM
        right.stairs(100 * record.error_share.values, edges, color=_PRINTED, fill=True, alpha=0.55)
        right.axvline(0, color=_OURS, linewidth=2.4)
        right.text(1.5, 0.92 * 100 * float(record.error_share.max()), "ours", color=_OURS, weight="bold")
        right.set_xlabel("error of (15) [mm]")
        right.set_ylabel("share of the postures [%]")
        right.set_title("joints within 30 deg")
    return captioned(
        figure,
        "Equation (15) as printed has lost a term. Left: joint 5 from above while the three yaw joints share a bend of "
        "90 degrees to either side; red lines join what belongs together. Right: how far off (15) is in random "
        "postures; there is none in which it is right.",
    )


def spine_least_bending(record: xr.Dataset) -> Figure:
    """Return the postures that do the same, and how the least bent one is chosen."""
    with styled():
        figure, axes = panels(1, 2, height=3.7, width_ratios=[1, 1.1])
        left, right = axes[0]
        for member in record.family_points:
            left.plot(*(_MM * member.sel(axis=["y", "x"])).values.T, "-o", color=COLOURS["neutral"], alpha=0.45, lw=1.3)
        best = _MM * record.best_points.sel(axis=["y", "x"])
        left.plot(*best.values.T, "-o", color=_OURS, linewidth=2.8)
        left.plot(*best.values[-2], "o", color=_ALARM, markersize=9, zorder=5)
        left.annotate("joint 5", best.values[-2], (-7, 8), textcoords="offset points", color=_ALARM, ha="right")
        left.annotate("snout", best.values[-1], (0, 9), textcoords="offset points", ha="center")
        left.set_aspect("equal")
        left.invert_xaxis()
        left.margins(x=0.2, y=0.16)
        left.set_xlabel("left [mm]")
        left.set_ylabel("ahead of the hips [mm]")
        left.set_title("same place, same azimuth")
        first = np.degrees(record.first_yaw)
        for branch, dashes in ((1, "-"), (-1, (0, (4, 2)))):
            label = "second pitch down" if branch == 1 else "second pitch up"
            right.plot(first, record.bending.sel(branch=branch), linestyle=dashes, color=COLOURS["spine"], label=label)
        least = float((record.best_angles**2).sum())
        right.plot(np.degrees(record.best_angles[0]), least, "o", color=_OURS, markersize=9)
        right.annotate(
            "least bending",
            (float(np.degrees(record.best_angles[0])), least),
            (0, -18),
            textcoords="offset points",
            ha="center",
            color=_OURS,
            weight="bold",
        )
        _fit_to_finite(right, first.values, record.bending.values)
        right.set_xlabel("first yaw angle [deg]")
        right.set_ylabel("sum of squared angles [rad²]")
        right.legend(loc="upper center")
    return captioned(
        figure,
        "The spine's inverse leaves one joint free. Left, from above: every grey posture brings joint 5 to the same "
        "point "
        "with the head in the same direction. Right: the sum of the squared joint angles over the free angle, on both "
        "branches; blue is the posture that is taken.",
    )


def _fit_to_finite(ax: Axes, x: np.ndarray, y: np.ndarray) -> None:
    """Fit the axes to what has a value, with room for a label below and a legend above."""
    there = x[np.isfinite(y).any(axis=0)]
    ax.set_xlim(there.min() - 4, there.max() + 4)
    low, high = np.nanmin(y), np.nanmax(y)
    ax.set_ylim(low - 0.2 * (high - low), high + 0.3 * (high - low))
