"""The death roll: one roll from the side, what decides its rate, what it costs."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Polygon

from suchus.article.paper.animals import ANIMAL
from suchus.core import rotation
from suchus.robot.design import Robot, layout
from suchus.sim.metrics import peak_torque, roll_angle
from suchus.visual.figures.posture import joined_path, silhouette_at, skeleton
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_BACK, _BELLY, _EDGE = np.array([0.30, 0.45, 0.35]), np.array([0.95, 0.90, 0.76]), "#3B5545"
_ARMS = {
    "c_shape": ("trunk and tail, C", COLOURS["coordinated"], "-"),
    "trunk": ("trunk alone", COLOURS["spine"], (0, (5, 1.5, 1, 1.5))),
    "s_shape": ("trunk and tail, S", COLOURS["limbs_only"], (0, (5, 2))),
    "tail": ("tail alone", COLOURS["tail"], (0, (1, 1.2))),
    "lateral_only": ("one bend alone", COLOURS["neutral"], "-"),
}
_MEDIA = {"vacuum": ("vacuum", "o", "#333333"), "water": ("water", "s", COLOURS["water"])}
_BARS = {
    ("torque", "vacuum"): "#1F4E79",
    ("torque", "water"): "#56B4E9",
    ("speed", "vacuum"): "#8C4A00",
    ("speed", "water"): "#E69F00",
}
_ANIMAL_RATE = ANIMAL["death_roll"].high
_FULL_TURN = 2 * np.pi


def servo_groups(robot: Robot) -> dict[str, tuple[str, ...]]:
    """Return the servos that bend trunk and tail, by the groups for which loads are reported."""
    body_layout = layout(robot)
    groups = {
        "spine_yaw": body_layout.trunk_yaw,
        "spine_pitch": body_layout.trunk_pitch,
        "tail_pitch": body_layout.tail_pitch,
        "tail_yaw": body_layout.tail_yaw,
        "tail_cable": body_layout.cables,
    }
    return {name: tuple(body_layout.servos[i] for i in servos) for name, servos in groups.items() if servos}


def draw_roll(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the robot from its right side while it turns once, in vacuum, bent as a C.

    Args:
        robot: robot whose record it is.
        record: record of the arms.
    """
    run = _run_of(record, "c_shape", "vacuum")
    period = float(run.period)
    start = period
    turns = roll_angle(run, start) / _FULL_TURN
    turns = turns * np.sign(float(turns[-1]) or 1.0)
    full_turn_times = turns.time[turns >= 1.0]
    end = float(full_turn_times[0]) if full_turn_times.size else float(turns.time[-1])
    times = np.linspace(start, end, 6)
    max_momentum = float(abs(run.angular_momentum).max())
    with styled(axes__grid=False):
        figure, axes = panels(2, 3, width=10.5, height=4.6, sharex=True, sharey=True)
        for ax, time in zip(axes.flat, times, strict=True):
            _body(ax, robot, run, float(time))
            turn_count = float(turns.sel(time=time, method="nearest"))
            ax.set_title(f"{time - start:.2f} s, {turn_count:.2f} turns", fontsize=12)
            ax.set_aspect("equal")
            ax.set_axis_off()
    return captioned(
        figure,
        "The roll in vacuum, seen from the right: the bend goes around the body, the body turns the other way. Green "
        "is the back, pale the belly; left limbs are blue, right ones orange. The angular momentum stays within "
        f"{max_momentum:.1g} kg m²/s of zero.",
    )


def draw_rates(record: xr.Dataset) -> Figure:
    """Draw the turned angle over time, and the rate over phase, amplitude and frequency of the bends."""
    with styled():
        figure, axes = panels(2, 2, width=10.5, height=7.2)
        _turns(axes[0, 0], record)
        _by_phase(axes[0, 1], record)
        for ax, name, scale, label in (
            (axes[1, 0], "rate_by_bend", 180 / np.pi, "amplitude of both bends of the trunk [deg]"),
            (axes[1, 1], "rate_by_frequency", 1.0, "frequency of the bends [Hz]"),
        ):
            dimension = record[name].dims[1]
            for medium, (text, marker, colour) in _MEDIA.items():
                values = record[name].sel(fluid=medium)
                ax.plot(scale * record[dimension], values, marker=marker, color=colour, label=f"trunk, {text}")
            ax.set_xlabel(label)
            ax.set_ylabel("rate of roll [turns/s]")
            ax.set_xlim(left=0.0)
            ax.set_ylim(bottom=0.0)
        ax = axes[1, 1]
        _c_points(ax, record)
        ax.axhline(_ANIMAL_RATE, color=COLOURS["alarm"], linewidth=1.2, linestyle=(0, (4, 2)))
        ax.text(0.03, _ANIMAL_RATE - 0.03, ANIMAL["death_roll"].who, color=COLOURS["alarm"], va="top", fontsize=11)
        ax.set_ylim(top=1.1 * _ANIMAL_RATE)
        ax.legend(loc="lower right", fontsize=10)
        axes[1, 0].legend(loc="upper left")
        for ax, letter in zip(axes.flat, "abcd", strict=True):
            ax.set_title(letter, fontweight="bold")
    return captioned(
        figure,
        "What decides the rate. a: turns over time; thick in vacuum, thin in water. b: over the phase lag of "
        "the vertical bend, trunk in vacuum. c, d: amplitude and frequency of the trunk's bends; the triangles are "
        "the C of trunk and tail, and the dashed line is what juvenile alligators do.",
    )


def draw_cost(robot: Robot, record: xr.Dataset, start: float) -> Figure:
    """Draw peak torques and speeds against what the servos can do, and the check of the angular momentum.

    Args:
        robot: robot whose record it is.
        record: record with the arms and the time steps.
        start: start of the measurement [s].
    """
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.0, width_ratios=[1.5, 1])
        _loads(axes[0, 0], robot, record, start)
        ax = axes[0, 1]
        steps = 1e3 * record.timestep
        ax.loglog(steps, record.momentum_by_timestep, "o-", color=COLOURS["ours"], label="left in vacuum")
        third_power = record.momentum_by_timestep.values[0] * (steps / steps[0]) ** 3
        ax.loglog(steps, third_power, color=COLOURS["neutral"], linestyle=(0, (4, 2)), label="third power of the step")
        water = float(abs(record.angular_momentum.isel(run=(record.medium == "water").values)).max())
        ax.axhline(water, color=COLOURS["water"], label="exchanged with water")
        ax.set_xticks(list(steps.values), [f"{s:g}" for s in steps.values])
        ax.minorticks_off()
        ax.set_xlabel("time step [ms]")
        ax.set_ylabel("angular momentum [kg m²/s]")
        ax.legend(loc="center right", fontsize=10)
    return captioned(
        figure,
        "What it costs. Left: greatest torques and speeds of the roll as a C, as parts of what the servos can do. "
        "Right: the angular momentum that the trunk's roll in vacuum leaves by error alone, beside what water takes.",
    )


def _run_of(record: xr.Dataset, arm: str, medium: str) -> xr.Dataset:
    run = int(np.flatnonzero((record.label == arm) & (record.medium == medium))[0])
    return record.isel(run=run)


def _turns(ax: Axes, record: xr.Dataset) -> None:
    """Draw the roll angle over time of each roll, thick in vacuum and thin in water [turn]."""
    for medium, width in (("vacuum", 2.4), ("water", 1.1)):
        for arm, (text, colour, dashes) in _ARMS.items():
            angle = roll_angle(_run_of(record, arm, medium)) / _FULL_TURN
            label = text if medium == "vacuum" else None
            ax.plot(angle.time, angle, color=colour, linestyle=dashes, linewidth=width, label=label)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("turned [turns]")
    ax.set_xlim(0.0, float(record.time[-1]))
    ax.legend(loc="upper left", fontsize=10)


def _by_phase(ax: Axes, record: xr.Dataset) -> None:
    """Draw the rate of roll over the phase lag of the vertical bend, and a sine of the same amplitude."""
    ax.axhline(0.0, color="#999999", linewidth=0.8)
    ax.plot(record.late, record.rate_by_phase, "o", color="#333333", label="measured")
    amplitude = float(abs(record.rate_by_phase).max())
    phase_grid = np.linspace(float(record.late.min()), float(record.late.max()), 100)
    ax.plot(
        phase_grid,
        amplitude * np.sin(_FULL_TURN * phase_grid),
        color=COLOURS["neutral"],
        linestyle=(0, (4, 2)),
        label="sine",
    )
    ax.set_xlabel("phase lag of the vertical bend [cycle]")
    ax.set_ylabel("rate of roll [turns/s]")
    ax.legend(loc="lower right")


def _c_points(ax: Axes, record: xr.Dataset) -> None:
    """Draw the rate of the C-shaped roll at its frequency, one triangle per medium."""
    for medium, (text, _, colour) in _MEDIA.items():
        run = _run_of(record, "c_shape", medium)
        ax.plot(
            1.0 / float(run.period), float(run.rate), "^", color=colour, markersize=9, linestyle="none",
            label=f"C, {text}",
        )  # fmt: skip


def _loads(ax: Axes, robot: Robot, record: xr.Dataset, start: float) -> None:
    """Draw the greatest torque and speed of each group of servos as a fraction of their limits, in both media.

    Args:
        ax: axes to draw on.
        robot: robot whose servos have the limits.
        record: record of the experiment.
        start: start of the measurement [s].
    """
    groups = servo_groups(robot)
    positions = np.arange(len(groups))
    for i, medium in enumerate(_MEDIA):
        run = _run_of(record, "c_shape", medium)
        torque = peak_torque(run, start)
        speed = abs(run.servo_velocity.sel(time=slice(start, None))).max("time")
        for j, (values, field) in enumerate(((torque, "torque"), (speed, "speed"))):
            load_fractions = [
                max(float(values.sel(servo=servo)) / getattr(robot.servo(servo), field) for servo in servos)
                for servos in groups.values()
            ]
            colour = _BARS[field, medium]
            ax.bar(positions + 0.2 * (2 * j + i - 1.5), load_fractions, 0.18, color=colour, label=f"{field}, {medium}")
    ax.axhline(1.0, color=COLOURS["alarm"], linewidth=1.4)
    ax.text(-0.45, 1.02, "limit", color=COLOURS["alarm"], va="bottom")
    ax.set_xticks(positions, [group.replace("spine", "trunk").replace("_", " ") for group in groups])
    ax.set_ylabel("part of the servo's limit")
    ax.set_ylim(0.0, 1.5)
    ax.legend(loc="upper right", ncols=2, fontsize=10)


def _body(ax: Axes, robot: Robot, run: xr.Dataset, time: float) -> None:
    """Draw the body from its right side: the page's right is ahead, and y of the world points into the page.

    Args:
        ax: axes to draw on.
        robot: robot that is drawn.
        run: record of one run.
        time: time of the snapshot [s].
    """
    bones, outline = skeleton(robot, run, time), silhouette_at(robot, run, time, (0, 2))
    snapshot = run.sel(time=time, method="nearest")
    facing = -rotation.matrix(snapshot.orientation.values)[
        1, 2
    ]  # component of the root's dorsal axis towards the viewer at -y
    center_y = bones.trunk[:, 1].mean()
    for limb, points, pieces in zip(layout(robot).limbs, bones.legs, outline.legs, strict=True):
        colour = COLOURS["LF"] if limb.side > 0 else COLOURS["RF"]
        order = 4 if points[:, 1].mean() < center_y else 0
        ax.add_patch(PathPatch(joined_path(pieces), facecolor=colour, edgecolor=colour, zorder=order))
    skin_colour = tuple(_BELLY + (_BACK - _BELLY) * np.clip(0.5 + 0.5 * facing, 0.0, 1.0))
    for piece in (outline.jaw, outline.body):
        if len(piece):
            ax.add_patch(
                Polygon(piece, facecolor=skin_colour, edgecolor=_EDGE, linewidth=1.1, joinstyle="round", zorder=2)
            )
    ax.autoscale_view()
