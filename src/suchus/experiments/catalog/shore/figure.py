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

_POSTURES, _MIN_SPACING = 4, 0.5  # most postures drawn, and their least distance over the robot's length [-]
_POINTS = ("position", "centre_of_mass", "snout", "tail_tip", "foot_position", "foot_force")
_REAR_MARGIN, _FRONT_MARGIN = 0.8, 0.7  # margins of the view behind and ahead of the path, over the robot's length [-]
_VIEW_ASPECT, _AIR_FRACTION = 0.24, 0.58  # height of the view over its width, and its fraction above the water [-]
_AVERAGED_FRACTION = 0.03  # fraction of the run over which the load on the feet is averaged [-]


def levelled(record: xr.Dataset) -> xr.Dataset:
    """Return a run with the surface of its water level and at height 0, the water line at the origin.

    Args:
        record: record of one run on a slope in a lake; its attribute ``line`` says where the water line is [m].
    """
    ground = ground_of(record)
    assert ground is not None
    turn = slope(ground.uphill, ground.sideways)
    origin = rotate(turn, np.array([record.attrs["line"], 0.0, 0.0]))
    variables = {}
    for name in _POINTS:
        values = rotate(turn, record[name].values)
        variables[name] = (record[name].dims, values if name == "foot_force" else values - origin)
    variables["orientation"] = (record.orientation.dims, multiply(turn, record.orientation.values))
    return record.assign(variables)


def draw_ashore(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw a robot from the side as it comes ashore, and the shares of weight on the feet and of volume under water.

    Args:
        robot: the robot of the record.
        record: record of one run (``run`` of size 1) with the paths of all cases; its attribute ``shown`` is the case
            drawn.
    """
    run_record = record.isel(run=0)
    level_record, path = levelled(run_record), record.isel(case=record.attrs["shown"])
    distance, slope_angle, shore_distance = path.ahead.values, float(path.slope), float(record.attrs["beyond"])
    view = (
        float(np.nanmin(distance)) - _REAR_MARGIN * robot.length,
        max(min(float(np.nanmax(distance)), shore_distance) + _FRONT_MARGIN * robot.length, 0.2 * robot.length),
    )
    view_height = _VIEW_ASPECT * (view[1] - view[0])
    with styled():
        figure, axes = panels(2, 1, width=13.0, height=6.4, height_ratios=(1.5, 1.0), sharex=True)
        ax = axes[0, 0]
        _shore(ax, slope_angle, view)
        for time in posture_times(level_record, path, robot.length, shore_distance):
            draw_posture(ax, robot, level_record, time, view="side", support=False, ground=False)
            x_position = float(level_record.centre_of_mass.sel(xyz="x").sel(time=time, method="nearest"))
            ax.annotate(
                f"{time:.0f} s",
                (x_position, 0.0),
                (x_position, 0.7 * _AIR_FRACTION * view_height),
                ha="center",
                color="#333333",
            )
        ax.set_ylabel("height above the water [m]")
        ax.set_ylim((_AIR_FRACTION - 1.0) * view_height, _AIR_FRACTION * view_height)
        ax = axes[1, 0]
        horizontal_distance = distance * np.cos(slope_angle)
        ax.plot(horizontal_distance, path.feet, color=COLOURS["limbs_only"], linewidth=0.8, alpha=0.35)
        window_samples = max(round(_AVERAGED_FRACTION * path.sizes["moment"]), 1)
        window_duration = window_samples * float(path.moment[1] - path.moment[0])
        ax.plot(
            horizontal_distance,
            _smooth(path.feet.values, window_samples),
            color=COLOURS["limbs_only"],
            label="share of the weight on the feet",
        )
        ax.plot(
            horizontal_distance,
            path.under,
            color=COLOURS["coordinated"],
            linestyle=(0, (5, 2)),
            label="share of the volume under water",
        )
        changes = np.flatnonzero(np.diff(path.walks.values) != 0)
        for i in changes:
            ax.axvline(horizontal_distance[i], color=COLOURS["neutral"], linewidth=0.9)
        if changes.size:
            change_distance = horizontal_distance[changes[0]]
            alignment = "right" if change_distance > np.mean(view) else "left"
            ax.annotate(" feels ground, walks ", (change_distance, 1.05), ha=alignment, color=COLOURS["neutral"])
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
        f"A robot between the water and a shore of {np.degrees(slope_angle):.0f} degrees, seen along the shore"
        f"{_obliquely(record.attrs['approach'])}; below, the share of its weight that the feet carry "
        f"(thin; bold: mean over {window_duration:.2g} s) and the share of its volume under water.",
    )


def _obliquely(course: float) -> str:
    """Return a note for the caption that an oblique approach looks shorter from the side."""
    return (
        f" (it approaches obliquely, at {abs(np.degrees(course)):.0f} degrees, and so looks shorter)" if course else ""
    )


def posture_times(level: xr.Dataset, path: xr.Dataset, length: float, shore_distance: float) -> list[float]:
    """Return times at which the robot is drawn, at about equal steps of the distance, its head ahead of its feet [s].

    A limb that reaches forward, or a bend of the trunk towards the viewer, hides the head. Of the times near each step
    the one with the snout farthest ahead of every foot is chosen.

    Args:
        level: level of ``levelled``.
        path: path of the same run, with ``ahead`` over ``moment``.
        length: length of the robot; fewer postures are drawn where they would lie on each other [m].
        shore_distance: distance beyond the water line that counts as ashore; a little more is drawn [m].
    """
    distance, moment = path.ahead.values, path.moment.values
    feet = level.foot_position.sel(xyz="x").max("leg")
    clear = (level.snout.sel(xyz="x") - feet).sel(time=moment, method="nearest").values
    start, end = float(distance[0]) + 0.02 * length, min(float(np.nanmax(distance)), shore_distance + 0.15 * length)
    count = int(np.clip(1 + (end - start) // (_MIN_SPACING * length), 1, _POSTURES))
    steps = np.linspace(start, max(end, start), count)
    tolerance = 0.15 * (steps[1] - steps[0]) if count > 1 else 0.0
    spans = [
        (int(np.argmax(distance >= x - tolerance)), int(np.argmax(distance >= min(x + tolerance, steps[-1]))))
        for x in steps
    ]
    return [
        float(moment[start_index + np.argmax(clear[start_index : end_index + 1])]) for start_index, end_index in spans
    ]


def _shore(ax: Axes, slope_angle: float, view: tuple[float, float]) -> None:
    """Draw water and ground of a slope whose water line is at the origin, from one distance of it to another [m]."""
    x = np.array(view)
    ground = x * np.tan(slope_angle)
    ax.fill_between(x, ground, -3.0, color="#E8DFCB", zorder=0.2)
    ax.plot(x, ground, color=COLOURS["ground"], linewidth=1.4, zorder=0.5, label="_ground")
    water_x = np.array([x[0], min(x[1], 0.0)])
    ax.fill_between(
        water_x, water_x * np.tan(slope_angle), 0.0, color=COLOURS["water"], alpha=0.25, zorder=6, linewidth=0
    )
    ax.plot(water_x, [0.0, 0.0], color=COLOURS["water"], linewidth=1.4, zorder=6.1, label="_water surface")


def _smooth(values: np.ndarray, window_samples: int) -> np.ndarray:
    """Return the moving average over so many samples; values beyond the ends repeat the first and the last one."""
    return np.convolve(
        np.pad(values, (window_samples // 2, window_samples - 1 - window_samples // 2), mode="edge"),
        np.ones(window_samples) / window_samples,
        "valid",
    )


def draw_decides(record: xr.Dataset) -> Figure:
    """Draw the time until ashore over slope and friction, and over air let out and friction on the steepest slope.

    Args:
        record: paths of all cases, with ``kind``, ``slope``, ``grip`` (the friction scale) and ``air_released``.
    """
    is_ashore = record.ahead.values >= record.attrs["beyond"]
    time = np.where(is_ashore.any(axis=1), record.moment.values[is_ashore.argmax(axis=1)], np.nan)
    kind, slopes = record.kind.values, np.degrees(record.slope.values)
    main = kind == "ashore"
    is_steepest = main & np.isclose(slopes, slopes[main].max())
    max_time = float(record.moment[-1])
    maps = [(main, slopes, "slope [deg]", f"{record.attrs['air_released']:.0%} of the air let out")]
    if (kind == "air").any():  # a robot without air has none to let out
        air = 100 * record.air_released.values
        title = f"on a slope of {slopes[main].max():.0f} degrees"
        maps.append((is_steepest | (kind == "air"), air, "air let out while landing [%]", title))
    else:
        maps[0] = (*maps[0][:3], "")
    with styled():
        figure, axes = panels(1, len(maps), width=6.0 * len(maps), height=4.4)
        for ax, (mask, rows, label, title) in zip(axes[0], maps, strict=True):
            image = _map(ax, time[mask], record.grip.values[mask], rows[mask], max_time)
            ax.set(xlabel="friction scale [-]", ylabel=label, title=title)
        if np.isfinite(time[main | (kind == "air")]).any():
            figure.colorbar(image, ax=axes[0, -1], label="time until ashore [s]")
    right = " Right: over the air that is let out and friction scale, on the steepest slope." * (len(maps) > 1)
    return captioned(
        figure,
        f"Mean time until the centre of mass is ashore{'. Left:' * (len(maps) > 1)} over slope and friction "
        f"scale.{right} Each field gives how many of its runs came ashore.",
    )


def _map(ax: Axes, time: np.ndarray, scale: np.ndarray, row: np.ndarray, max_time: float) -> Any:
    """Draw one cell for each friction scale and row, with mean time ashore and number of runs ashore.

    Args:
        ax: axes to draw on.
        time: time ashore of each run, NaN for one that never was [s].
        scale: friction scale of each run [-].
        row: coordinate of each run on the vertical axis.
        max_time: end of the colour scale [s].
    """
    columns, rows = np.unique(scale), np.unique(np.round(row, 6))
    mean_times = np.full((len(rows), len(columns)), np.nan)
    for i, row_coordinate in enumerate(rows):
        for j, friction_scale in enumerate(columns):
            times = time[np.isclose(row, row_coordinate) & (scale == friction_scale)]
            ashore = times[np.isfinite(times)]
            mean_times[i, j] = ashore.mean() if ashore.size else np.nan
            dark = ashore.size > 0 and mean_times[i, j] < 0.6 * max_time
            ax.text(
                j, i, f"{ashore.size} of {times.size}", ha="center", va="center", color="white" if dark else "#333333"
            )
    image = ax.imshow(mean_times, origin="lower", aspect="auto", cmap=SEQUENTIAL, vmin=0.0, vmax=max_time)
    ax.set_xticks(range(len(columns)), [f"{friction_scale:g}" for friction_scale in columns])
    ax.set_yticks(range(len(rows)), [f"{row_coordinate:.0f}" for row_coordinate in rows])
    ax.grid(visible=False)
    return image
