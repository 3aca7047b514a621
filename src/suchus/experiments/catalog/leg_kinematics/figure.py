"""Figures of the leg: its reach, and the errors of the printed formulas."""

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
_SOLUTION_COLOUR, _PRINTED_COLOUR, _ALARM_COLOUR = COLOURS["ours"], COLOURS["printed"], COLOURS["alarm"]
_EXACT_TOLERANCE = 1e-9  # [m]
_OUTLINE = withStroke(linewidth=4.5, foreground="#222222")
_LIMB: dict[str, Any] = {"linewidth": 2.6, "markersize": 4.5, "path_effects": [_OUTLINE]}


def leg_inverse(record: xr.Dataset) -> Figure:
    """Draw the foot error of the printed inverse (14) on a section, and the histograms of both solutions."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, width=8.2, height=3.9, width_ratios=[1.25, 1])
        engine = figure.get_layout_engine()
        assert isinstance(engine, ConstrainedLayoutEngine)
        engine.set(wspace=0.08)
        left_ax, right_ax = axes[0]
        printed_error = record.printed_error.values
        x, z = _MM * record.outward, _MM * record.down
        exact = np.where(printed_error < _EXACT_TOLERANCE, 1.0, np.nan)
        left_ax.pcolormesh(x, z, exact, cmap="Blues", vmin=0, vmax=4, rasterized=True)
        error_mm = np.where(printed_error < _EXACT_TOLERANCE, np.nan, _MM * printed_error)
        max_error = max(350.0, float(np.max(error_mm, where=np.isfinite(error_mm), initial=0.0)))
        mesh = left_ax.pcolormesh(x, z, error_mm, cmap=SEQUENTIAL, vmin=0, vmax=max_error, rasterized=True)
        figure.colorbar(mesh, ax=left_ax, label="foot lands off by [mm]", shrink=0.85)
        hip = _MM * record.attrs["hip_offset"]
        left_ax.plot(hip, 0, "o", color=_ALARM_COLOUR, markersize=6)
        left_ax.text(
            hip + 350 * record.attrs["far"],
            400 * record.attrs["far"],
            "exact",
            color=_SOLUTION_COLOUR,
            ha="center",
            weight="bold",
        )
        left_ax.annotate("hip", (hip, 0), (8, -13), textcoords="offset points", color=_ALARM_COLOUR)
        _section_axes(left_ax, "as printed, (14)")
        edges = _MM * record.error.values
        right_ax.stairs(100 * record.share_printed.values[:-1], edges, color=_PRINTED_COLOUR, fill=True, alpha=0.5)
        right_ax.stairs(100 * record.share_ours.values[:-1], edges, color=_SOLUTION_COLOUR, linewidth=1.8)
        right_ax.set_xscale("log")
        right_ax.set_xlim(1e-15, 1e3)
        right_ax.set_xticks([1e-15, 1e-10, 1e-5, 1], minor=False)
        right_ax.set_xlabel("foot lands off by [mm]")
        right_ax.set_ylabel("share of the points [%]")
        top = 100 * float(max(record.share_printed.max(), record.share_ours.max()))
        right_ax.text(3e-11, 0.9 * top, "ours", color=_SOLUTION_COLOUR, weight="bold")
        right_ax.text(1e-3, 0.45 * top, "as printed", color=_PRINTED_COLOUR, ha="center", weight="bold")
        right_ax.set_title("all points in reach")
    return captioned(
        figure,
        "The printed inverse of the leg. Left: upright section through the hip; in the blue quarter, outboard of and "
        "below the hip, (14) is exact; elsewhere its arctan is half a turn off. Right: over the whole workspace our "
        "solution lands within rounding, the printed one only in a quarter of it.",
    )


def _section_axes(ax: Axes, title: str) -> None:
    """Set labels, title and scale of a map whose vertical axis points down."""
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.set_xlabel("outward from the midline [mm]")
    ax.set_ylabel("below the hip [mm]")
    ax.set_title(title)


def leg_workspace(record: xr.Dataset) -> Figure:
    """Draw the dexterity of the foot positions within the joint limits, with three postures."""
    with styled(axes__grid=False):
        figure, axes = panels(1, 2, height=3.7)
        views = (("dexterity_section", "down", "from the front"), ("dexterity_top", "ahead", "from above"))
        for ax, (name, vertical_dim, title) in zip(axes[0], views, strict=True):
            mesh = ax.pcolormesh(
                _MM * record.outward,
                _MM * record[vertical_dim],
                record[name],
                cmap=SEQUENTIAL,
                vmin=0,
                vmax=0.8,
                rasterized=True,
            )
            _leg_reach(ax, record, record.attrs["floor"] if vertical_dim == "ahead" else 0.0)
            _section_axes(ax, title)
            postures = list(zip(("#FFFFFF", "#F7B267", "#F25C54"), record.posture.values, strict=True))
            for colour, posture in postures[: 1 if vertical_dim == "ahead" else None]:
                points = _MM * record.posture_points.sel(posture=posture, axis=["outward", vertical_dim])
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
    """Draw the inner and outer reach of the foot on a plane at a distance from the hip.

    Args:
        ax: axes to draw on.
        record: record of the experiment.
        depth: distance of the plane from the hip [m].
    """
    for reach in (record.attrs["near"], record.attrs["far"]):
        if reach > depth:
            radius = _MM * float(np.sqrt(reach**2 - depth**2))
            centre = (_MM * record.attrs["hip_offset"], 0.0)
            ax.add_patch(Circle(centre, radius, fill=False, edgecolor=COLOURS["neutral"], linewidth=1, linestyle="--"))


def leg_misprints(record: xr.Dataset) -> Figure:
    """Draw the effect of the denominator of (10) on the knee angle, and of the labels of Table I on the foot."""
    with styled():
        figure, axes = panels(1, 2, height=3.6)
        left_ax, right_ax = axes[0]
        distance = _MM * record.distance
        left_ax.plot(distance, np.degrees(record.knee_ours), **LINES["ours"])
        left_ax.plot(distance, np.degrees(record.knee_printed), **LINES["printed"])
        undefined_distances = distance.values[np.isnan(record.knee_printed.values)]
        if undefined_distances.size:
            left_ax.axvspan(
                undefined_distances.min(), undefined_distances.max(), color=_ALARM_COLOUR, alpha=0.12, linewidth=0
            )
            left_ax.text(
                undefined_distances.mean(), 5, "no value", color=_ALARM_COLOUR, ha="center", rotation=90, va="bottom"
            )
        left_ax.set_xlabel("from hip to foot [mm]")
        left_ax.set_ylabel("knee angle [deg]")
        left_ax.set_yticks(range(0, 181, 30))
        left_ax.set_title("(10): 2 AB AC for 2 AB BC")
        left_ax.legend(loc="lower left", bbox_to_anchor=(0.22, 0.02))
        turn = np.degrees(record.turn)
        right_ax.plot(turn, _MM * record.path_ours.sel(axis="down"), **LINES["ours"])
        right_ax.plot(turn, _MM * record.path_by_label.sel(axis="down"), **LINES["printed"])
        right_ax.set_xlabel("second joint [deg]")
        right_ax.set_ylabel("foot below the hip [mm]")
        right_ax.set_xticks(range(-60, 91, 30))
        right_ax.invert_yaxis()
        right_ax.set_title("Table I under its labels")
    return captioned(
        figure,
        "Two misprints of the leg. Left: the knee angle by the printed denominator of (10) agrees with ours at "
        "two distances only and has no value near the hip. Right: fed to (1) under its printed labels, Table I "
        "turns the second joint into another yaw joint: the foot never leaves the level of the hip.",
    )
