"""Pictures of the leg: where it reaches, and what the printed formulas do instead."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Circle
from matplotlib.patheffects import withStroke

from suchus.visual.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled

_MM = 1000.0
_OURS, _PRINTED, _ALARM = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]
_EXACT = 1e-9  # [m]
_OUTLINE = withStroke(linewidth=4.5, foreground="#222222")
_LIMB: dict[str, Any] = {"linewidth": 2.6, "markersize": 4.5, "path_effects": [_OUTLINE]}


def leg_inverse(record: xr.Dataset) -> Figure:
    """Return where the printed inverse (14) misses, and by how much, beside ours."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, width=8.2, height=3.9, width_ratios=[1.25, 1])
        engine = figure.get_layout_engine()
        assert isinstance(engine, ConstrainedLayoutEngine)
        engine.set(wspace=0.08)
        left, right = axes[0]
        miss = record.printed_error.values
        x, z = _MM * record.outward, _MM * record.down
        exact = np.where(miss < _EXACT, 1.0, np.nan)
        left.pcolormesh(x, z, exact, cmap="Blues", vmin=0, vmax=4, rasterized=True)
        wrong = np.where(miss < _EXACT, np.nan, _MM * miss)
        most = max(350.0, float(np.max(wrong, where=np.isfinite(wrong), initial=0.0)))
        mesh = left.pcolormesh(x, z, wrong, cmap=SEQUENTIAL, vmin=0, vmax=most, rasterized=True)
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
