"""A robot that swims in and walks out: side views with the water line, loads over distance, and times ashore."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.core.rotation import multiply, rotate
from suchus.robot.design import Robot
from suchus.robot.design.ground import slope
from suchus.sim.record import ground_of
from suchus.visual.figures.posture import draw_posture
from suchus.visual.figures.style import COLOURS, SEQUENTIAL, captioned, panels, styled

_POSTURES, _APART = 4, 0.5  # of the robot, at most, and the least distance between them over its length [-]
_POINTS = ("position", "centre_of_mass", "snout", "tail_tip", "foot_position", "foot_force")
_BEHIND, _AHEAD = 0.8, 0.7  # what is shown beyond the ends of the path, over the robot's length [-]
_HIGH, _ABOVE = 0.24, 0.58  # height of the view over its width, and the part of it above the water [-]
_MEAN = 0.03  # of the run, over which the load on the feet is averaged [-]


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
    ahead, steep, beyond = path.ahead.values, float(path.slope), float(record.attrs["beyond"])
    view = (
        float(np.nanmin(ahead)) - _BEHIND * robot.length,
        max(min(float(np.nanmax(ahead)), beyond) + _AHEAD * robot.length, 0.2 * robot.length),
    )
    high = _HIGH * (view[1] - view[0])
    with styled():
        figure, axes = panels(2, 1, width=13.0, height=6.4, height_ratios=(1.5, 1.0), sharex=True)
        ax = axes[0, 0]
        _shore(ax, steep, view)
        for time in posture_times(one, path, robot.length, beyond):
            draw_posture(ax, robot, one, time, view="side", support=False, ground=False)
            here = float(one.centre_of_mass.sel(xyz="x").sel(time=time, method="nearest"))
            ax.annotate(f"{time:.0f} s", (here, 0.0), (here, 0.7 * _ABOVE * high), ha="center", color="#333333")
        ax.set_ylabel("height above the water [m]")
        ax.set_ylim((_ABOVE - 1.0) * high, _ABOVE * high)
        ax = axes[1, 0]
        across = ahead * np.cos(steep)
        ax.plot(across, path.feet, color=COLOURS["limbs_only"], linewidth=0.8, alpha=0.35)
        wide = max(round(_MEAN * path.sizes["moment"]), 1)
        over = wide * float(path.moment[1] - path.moment[0])
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
            at = across[changes[0]]
            beside = "right" if at > np.mean(view) else "left"
            ax.annotate(" feels ground, walks ", (at, 1.05), ha=beside, color=COLOURS["neutral"])
        ax.axvline(0.0, color=COLOURS["water"], linewidth=0.9)
        ax.set(
            xlabel="horizontal distance of the centre of mass beyond the water line [m]",
            ylabel="share [-]",
            ylim=(-0.05, 1.2),
        )
        ax.set_xlim(*view)
        ax.legend(loc="center left")
    return captioned(
        figure,
        f"A robot between the water and a shore of {np.degrees(steep):.0f} degrees, seen along the shore"
        f"{_obliquely(record.attrs['approach'])}; below, the share of its weight that the feet carry "
        f"(thin; bold: mean over {over:.2g} s) and the share of its volume under water.",
    )


def _obliquely(course: float) -> str:
    """Return what a view from the side shows of an oblique approach, in words."""
    return (
        f" (it approaches obliquely, at {abs(np.degrees(course)):.0f} degrees, and so looks shorter)" if course else ""
    )


def posture_times(level: xr.Dataset, path: xr.Dataset, length: float, beyond: float) -> list[float]:
    """Return times at which the robot is drawn, at about equal steps of the distance, its head ahead of its feet [s].

    A limb that reaches forward, or a bend of the trunk towards the viewer, hides the head; so of the times near each
    step the one is taken at which the snout is farthest ahead of every foot.

    Args:
        level: of ``levelled``.
        path: of the same run, with ``ahead`` over ``moment``.
        length: of the robot, of which fewer are drawn where they would lie on each other [m].
        beyond: distance beyond the water line that counts as ashore; a little more is drawn [m].
    """
    ahead, moment = path.ahead.values, path.moment.values
    feet = level.foot_position.sel(xyz="x").max("leg")
    clear = (level.snout.sel(xyz="x") - feet).sel(time=moment, method="nearest").values
    start, end = float(ahead[0]) + 0.02 * length, min(float(np.nanmax(ahead)), beyond + 0.15 * length)
    count = int(np.clip(1 + (end - start) // (_APART * length), 1, _POSTURES))
    steps = np.linspace(start, max(end, start), count)
    near = 0.15 * (steps[1] - steps[0]) if count > 1 else 0.0
    spans = [(int(np.argmax(ahead >= x - near)), int(np.argmax(ahead >= min(x + near, steps[-1])))) for x in steps]
    return [float(moment[first + np.argmax(clear[first : last + 1])]) for first, last in spans]


def _shore(ax: Axes, steep: float, view: tuple[float, float]) -> None:
    """Draw water and ground of a slope whose water line is at the origin, from one distance of it to another [m]."""
    x = np.array(view)
    ground = x * np.tan(steep)
    ax.fill_between(x, ground, -3.0, color="#E8DFCB", zorder=0.2)
    ax.plot(x, ground, color=COLOURS["ground"], linewidth=1.4, zorder=0.5)
    wet = np.array([x[0], min(x[1], 0.0)])
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
    maps = [(main, slopes, "slope [deg]", f"{record.attrs['air_released']:.0%} of the air let out")]
    if (kind == "air").any():  # a robot without air has none to let out
        air = 100 * record.air_released.values
        title = f"on a slope of {slopes[main].max():.0f} degrees"
        maps.append((steep | (kind == "air"), air, "air let out while landing [%]", title))
    else:
        maps[0] = (*maps[0][:3], "")
    with styled():
        figure, axes = panels(1, len(maps), width=6.0 * len(maps), height=4.4)
        for ax, (mine, rows, label, title) in zip(axes[0], maps, strict=True):
            image = _map(ax, time[mine], record.grip.values[mine], rows[mine], most)
            ax.set(xlabel="friction scale [-]", ylabel=label, title=title)
        if np.isfinite(time[main | (kind == "air")]).any():
            figure.colorbar(image, ax=axes[0, -1], label="time until ashore [s]")
    right = " Right: over the air that is let out and friction scale, on the steepest slope." * (len(maps) > 1)
    return captioned(
        figure,
        f"Mean time until the centre of mass is ashore{'. Left:' * (len(maps) > 1)} over slope and friction "
        f"scale.{right} Each field gives how many of its runs came ashore.",
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
