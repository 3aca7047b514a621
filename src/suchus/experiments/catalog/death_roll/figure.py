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
from suchus.visual.figures.posture import silhouette_at, skeleton, united
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
_ANIMAL = ANIMAL["death_roll"].high
_TURN = 2 * np.pi


def servo_groups(robot: Robot) -> dict[str, tuple[str, ...]]:
    """Return the servos that bend trunk and tail, in the groups of which loads are told."""
    place = layout(robot)
    groups = {
        "spine_yaw": place.trunk_yaw,
        "spine_pitch": place.trunk_pitch,
        "tail_pitch": place.tail_pitch,
        "tail_yaw": place.tail_yaw,
        "tail_cable": place.cables,
    }
    return {name: tuple(place.servos[i] for i in servos) for name, servos in groups.items() if servos}


def draw_roll(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the robot from its right side while it turns once, in vacuum, bent as a C.

    Args:
        robot: whose record it is.
        record: of the arms.
    """
    run = _one(record, "c_shape", "vacuum")
    period = float(run.period)
    start = period
    turned = roll_angle(run, start) / _TURN
    turned = turned * np.sign(float(turned[-1]) or 1.0)
    once = turned.time[turned >= 1.0]
    end = float(once[0]) if once.size else float(turned.time[-1])
    times = np.linspace(start, end, 6)
    left = float(abs(run.angular_momentum).max())
    with styled(axes__grid=False):
        figure, axes = panels(2, 3, width=10.5, height=4.6, sharex=True, sharey=True)
        for ax, time in zip(axes.flat, times, strict=True):
            _body(ax, robot, run, float(time))
            done = float(turned.sel(time=time, method="nearest"))
            ax.set_title(f"{time - start:.2f} s, {done:.2f} turns", fontsize=12)
            ax.set_aspect("equal")
            ax.set_axis_off()
    return captioned(
        figure,
        "The roll in vacuum, seen from the right: the bend goes around the body, the body turns the other way. Green "
        "is the back, pale the belly; left limbs are blue, right ones orange. The angular momentum stays within "
        f"{left:.1g} kg m²/s of zero.",
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
            along = record[name].dims[1]
            for medium, (text, marker, colour) in _MEDIA.items():
                values = record[name].sel(fluid=medium)
                ax.plot(scale * record[along], values, marker=marker, color=colour, label=f"trunk, {text}")
            ax.set_xlabel(label)
            ax.set_ylabel("rate of roll [turns/s]")
            ax.set_xlim(left=0.0)
            ax.set_ylim(bottom=0.0)
        ax = axes[1, 1]
        _c_points(ax, record)
        ax.axhline(_ANIMAL, color=COLOURS["alarm"], linewidth=1.2, linestyle=(0, (4, 2)))
        ax.text(0.03, _ANIMAL - 0.03, ANIMAL["death_roll"].who, color=COLOURS["alarm"], va="top", fontsize=11)
        ax.set_ylim(top=1.1 * _ANIMAL)
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
        robot: whose record it is.
        record: with the arms and the time steps.
        start: of the measurement [s].
    """
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.0, width_ratios=[1.5, 1])
        _loads(axes[0, 0], robot, record, start)
        ax = axes[0, 1]
        steps = 1e3 * record.timestep
        ax.loglog(steps, record.momentum_by_timestep, "o-", color=COLOURS["ours"], label="left in vacuum")
        fourth = record.momentum_by_timestep.values[0] * (steps / steps[0]) ** 3
        ax.loglog(steps, fourth, color=COLOURS["neutral"], linestyle=(0, (4, 2)), label="third power of the step")
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


def _one(record: xr.Dataset, arm: str, medium: str) -> xr.Dataset:
    run = int(np.flatnonzero((record.label == arm) & (record.medium == medium))[0])
    return record.isel(run=run)


def _turns(ax: Axes, record: xr.Dataset) -> None:
    for medium, width in (("vacuum", 2.4), ("water", 1.1)):
        for arm, (text, colour, dashes) in _ARMS.items():
            angle = roll_angle(_one(record, arm, medium)) / _TURN
            label = text if medium == "vacuum" else None
            ax.plot(angle.time, angle, color=colour, linestyle=dashes, linewidth=width, label=label)
    ax.set_xlabel("time [s]")
    ax.set_ylabel("turned [turns]")
    ax.set_xlim(0.0, float(record.time[-1]))
    ax.legend(loc="upper left", fontsize=10)


def _by_phase(ax: Axes, record: xr.Dataset) -> None:
    ax.axhline(0.0, color="#999999", linewidth=0.8)
    ax.plot(record.late, record.rate_by_phase, "o", color="#333333", label="measured")
    amplitude = float(abs(record.rate_by_phase).max())
    fine = np.linspace(float(record.late.min()), float(record.late.max()), 100)
    ax.plot(fine, amplitude * np.sin(_TURN * fine), color=COLOURS["neutral"], linestyle=(0, (4, 2)), label="sine")
    ax.set_xlabel("phase lag of the vertical bend [cycle]")
    ax.set_ylabel("rate of roll [turns/s]")
    ax.legend(loc="lower right")


def _c_points(ax: Axes, record: xr.Dataset) -> None:
    for medium, (text, _, colour) in _MEDIA.items():
        run = _one(record, "c_shape", medium)
        ax.plot(
            1.0 / float(run.period), float(run.rate), "^", color=colour, markersize=9, linestyle="none",
            label=f"C, {text}",
        )  # fmt: skip


def _loads(ax: Axes, robot: Robot, record: xr.Dataset, start: float) -> None:
    groups = servo_groups(robot)
    place = np.arange(len(groups))
    for i, medium in enumerate(_MEDIA):
        run = _one(record, "c_shape", medium)
        torque = peak_torque(run, start)
        speed = abs(run.servo_velocity.sel(time=slice(start, None))).max("time")
        for j, (values, field) in enumerate(((torque, "torque"), (speed, "speed"))):
            share = [
                max(float(values.sel(servo=servo)) / getattr(robot.servo(servo), field) for servo in servos)
                for servos in groups.values()
            ]
            colour = _BARS[field, medium]
            ax.bar(place + 0.2 * (2 * j + i - 1.5), share, 0.18, color=colour, label=f"{field}, {medium}")
    ax.axhline(1.0, color=COLOURS["alarm"], linewidth=1.4)
    ax.text(-0.45, 1.02, "limit", color=COLOURS["alarm"], va="bottom")
    ax.set_xticks(place, [group.replace("spine", "trunk").replace("_", " ") for group in groups])
    ax.set_ylabel("part of the servo's limit")
    ax.set_ylim(0.0, 1.5)
    ax.legend(loc="upper right", ncols=2, fontsize=10)


def _body(ax: Axes, robot: Robot, run: xr.Dataset, time: float) -> None:
    """Draw the body from its side, right of the page being ahead; y of the world points into the page."""
    bones, seen = skeleton(robot, run, time), silhouette_at(robot, run, time, (0, 2))
    now = run.sel(time=time, method="nearest")
    facing = -rotation.matrix(now.orientation.values)[1, 2]  # of the root's back, towards the viewer at -y
    middle = bones.trunk[:, 1].mean()
    for limb, points, pieces in zip(layout(robot).limbs, bones.legs, seen.legs, strict=True):
        colour = COLOURS["LF"] if limb.side > 0 else COLOURS["RF"]
        order = 4 if points[:, 1].mean() < middle else 0
        ax.add_patch(PathPatch(united(pieces), facecolor=colour, edgecolor=colour, zorder=order))
    hide = tuple(_BELLY + (_BACK - _BELLY) * np.clip(0.5 + 0.5 * facing, 0.0, 1.0))
    for piece in (seen.jaw, seen.body):
        if len(piece):
            ax.add_patch(Polygon(piece, facecolor=hide, edgecolor=_EDGE, linewidth=1.1, joinstyle="round", zorder=2))
    ax.autoscale_view()
