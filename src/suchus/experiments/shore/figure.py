"""A robot that swims in and walks out: side views with the water line, loads over distance, and times ashore."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.design import Robot
from suchus.design.ground import slope
from suchus.figures.posture import draw_posture
from suchus.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled
from suchus.record import ground_of
from suchus.rotation import multiply, rotate

_POSTURES = 4
_POINTS = ("position", "centre_of_mass", "snout", "tail_tip", "foot_position", "foot_force")
_VIEW = (-2.6, 1.7)


def levelled(record: xr.Dataset) -> xr.Dataset:
    """Return a run with the surface of its water level and at height 0, the water line at the origin.

    Args:
        record: record of one run on a slope in a lake; its attribute ``line`` says where the water line is [m].
    """
    ground = ground_of(record)
    assert ground is not None
    turn = slope(ground.uphill, ground.sideways)
    origin = rotate(turn, np.array([record.attrs["line"], 0.0, 0.0]))
    found = {}
    for name in _POINTS:
        values = rotate(turn, record[name].values)
        found[name] = (record[name].dims, values if name == "foot_force" else values - origin)
    found["orientation"] = (record.orientation.dims, multiply(turn, record.orientation.values))
    return record.assign(found)


def draw_ashore(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw a robot from the side as it comes ashore, and the shares of weight on the feet and of volume under water.

    Args:
        robot: the robot of the record.
        record: record of one run (``run`` of size 1) with the paths of all cases; its attribute ``shown`` is the case
            drawn.
    """
    whole = record.isel(run=0)
    one, path = levelled(whole), record.isel(case=record.attrs["shown"])
    ahead, steep = path.ahead.values, float(path.slope)
    with styled():
        figure, axes = panels(2, 1, width=13.0, height=6.4, height_ratios=(1.5, 1.0), sharex=True)
        ax = axes[0, 0]
        _shore(ax, steep)
        for time in posture_times(one, path):
            draw_posture(ax, robot, one, time, view="side", support=False, ground=False)
            here = float(one.centre_of_mass.sel(xyz="x").sel(time=time, method="nearest"))
            ax.annotate(f"{time:.0f} s", (here, 0.0), (here, 0.42), ha="center", color="#333333")
        ax.set_ylabel("height above the water [m]")
        ax.set_ylim(-0.42, 0.6)
        ax = axes[1, 0]
        across = ahead * np.cos(steep)
        ax.plot(across, path.feet, color=COLOURS["limbs_only"], linewidth=0.8, alpha=0.35)
        wide = max(round(1.5 / float(path.moment[1] - path.moment[0])), 1)
        ax.plot(
            across,
            _smooth(path.feet.values, wide),
            color=COLOURS["limbs_only"],
            label="share of the weight on the feet",
        )
        ax.plot(
            across,
            path.under,
            color=COLOURS["coordinated"],
            linestyle=(0, (5, 2)),
            label="share of the volume under water",
        )
        changes = np.flatnonzero(np.diff(path.walks.values) != 0)
        for i in changes:
            ax.axvline(across[i], color=COLOURS["neutral"], linewidth=0.9)
        if changes.size:
            ax.annotate("feels ground, walks", (across[changes[0]], 1.05), ha="right", color=COLOURS["neutral"])
        ax.axvline(0.0, color=COLOURS["water"], linewidth=0.9)
        ax.set(
            xlabel="horizontal distance of the centre of mass beyond the water line [m]",
            ylabel="share [-]",
            ylim=(-0.05, 1.2),
        )
        ax.set_xlim(*_VIEW)
        ax.legend(loc="center left")
    return captioned(
        figure,
        f"A robot between the water and a shore of {np.degrees(steep):.0f} degrees, seen along the shore"
        f"{_obliquely(record.attrs['approach'])}; below, the share of its weight that the feet carry "
        "(thin; bold: mean over 1.5 s) and the share of its volume under water.",
    )


def _obliquely(course: float) -> str:
    """Return what a view from the side shows of an oblique approach, in words."""
    return (
        f" (it approaches obliquely, at {abs(np.degrees(course)):.0f} degrees, and so looks shorter)" if course else ""
    )


def posture_times(level: xr.Dataset, path: xr.Dataset) -> list[float]:
    """Return times at which the robot is drawn, at about equal steps of the distance, its head ahead of its feet [s].

    A limb that reaches forward, or a bend of the trunk towards the viewer, hides the head; so of the times near each
    step the one is taken at which the snout is farthest ahead of every foot.

    Args:
        level: of ``levelled``.
        path: of the same run, with ``ahead`` over ``moment``.
    """
    ahead, moment = path.ahead.values, path.moment.values
    feet = level.foot_position.sel(xyz="x").max("leg")
    clear = (level.snout.sel(xyz="x") - feet).sel(time=moment, method="nearest").values
    steps = np.linspace(float(ahead[0]) + 0.02, min(float(np.nanmax(ahead)), _VIEW[1] - 0.55), _POSTURES)
    near = 0.15 * (steps[1] - steps[0])
    spans = [(int(np.argmax(ahead >= x - near)), int(np.argmax(ahead >= min(x + near, steps[-1])))) for x in steps]
    return [float(moment[first + np.argmax(clear[first : last + 1])]) for first, last in spans]


def _shore(ax: Axes, steep: float) -> None:
    """Draw water and ground of a slope whose water line is at the origin."""
    x = np.array(_VIEW)
    ground = x * np.tan(steep)
    ax.fill_between(x, ground, -3.0, color="#E8DFCB", zorder=0.2)
    ax.plot(x, ground, color=COLOURS["ground"], linewidth=1.4, zorder=0.5)
    wet = np.array([x[0], 0.0])
    ax.fill_between(wet, wet * np.tan(steep), 0.0, color=COLOURS["water"], alpha=0.25, zorder=6, linewidth=0)
    ax.plot(wet, [0.0, 0.0], color=COLOURS["water"], linewidth=1.4, zorder=6.1)


def _smooth(values: np.ndarray, wide: int) -> np.ndarray:
    return np.convolve(np.pad(values, (wide // 2, wide - 1 - wide // 2), mode="edge"), np.ones(wide) / wide, "valid")


def draw_decides(record: xr.Dataset) -> Figure:
    """Draw the time until ashore over slope and friction, and over air let out and friction on the steepest slope.

    Args:
        record: paths of all cases, with ``kind``, ``slope``, ``grip`` (the friction scale) and ``air_released``.
    """
    reached = record.ahead.values >= record.attrs["beyond"]
    time = np.where(reached.any(axis=1), record.moment.values[reached.argmax(axis=1)], np.nan)
    kind, slopes = record.kind.values, np.degrees(record.slope.values)
    main = kind == "ashore"
    steep = main & np.isclose(slopes, slopes[main].max())
    most = float(record.moment[-1])
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.4)
        for ax, mine, rows, label in (
            (axes[0, 0], main, slopes, "slope [deg]"),
            (axes[0, 1], steep | (kind == "air"), 100 * record.air_released.values, "air let out while landing [%]"),
        ):
            image = _map(ax, time[mine], record.grip.values[mine], rows[mine], most)
            ax.set(xlabel="friction scale [-]", ylabel=label)
        axes[0, 1].set_title(f"on a slope of {slopes[main].max():.0f} degrees")
        axes[0, 0].set_title(f"{record.attrs['air_released']:.0%} of the air let out")
        figure.colorbar(image, ax=axes[0, 1], label="time until ashore [s]")
    return captioned(
        figure,
        "Mean time until the centre of mass is ashore. Left: over slope and friction scale. Right: over the "
        "air that is let out and friction scale, on the steepest slope. Each field gives how many of its runs came "
        "ashore.",
    )


def _map(ax: Axes, time: np.ndarray, scale: np.ndarray, row: np.ndarray, most: float) -> Any:
    """Draw a field for each pair of friction scale and row, with its mean time and how many of its runs came ashore."""
    columns, rows = np.unique(scale), np.unique(np.round(row, 6))
    shown = np.full((len(rows), len(columns)), np.nan)
    for i, one in enumerate(rows):
        for j, other in enumerate(columns):
            here = time[np.isclose(row, one) & (scale == other)]
            ashore = here[np.isfinite(here)]
            shown[i, j] = ashore.mean() if ashore.size else np.nan
            dark = ashore.size > 0 and shown[i, j] < 0.6 * most
            ax.text(
                j, i, f"{ashore.size} of {here.size}", ha="center", va="center", color="white" if dark else "#333333"
            )
    image = ax.imshow(shown, origin="lower", aspect="auto", cmap=SEQUENTIAL, vmin=0.0, vmax=most)
    ax.set_xticks(range(len(columns)), [f"{one:g}" for one in columns])
    ax.set_yticks(range(len(rows)), [f"{one:.0f}" for one in rows])
    ax.grid(visible=False)
    return image
