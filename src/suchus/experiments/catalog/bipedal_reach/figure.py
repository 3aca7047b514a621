"""Standing up on hind legs and tail: postures and angles, how high it reaches, what limits it, and what topples it."""

from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from suchus.article.paper import CLAIMS
from suchus.core import rotation
from suchus.robot.design import Robot, layout
from suchus.sim.metrics import stance, tilt
from suchus.visual.figures.gait_diagram import intervals
from suchus.visual.figures.posture import draw_posture, skeleton
from suchus.visual.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled

_FEEDBACK = {"on": COLOURS["ours"], "off": COLOURS["limbs_only"]}


def draw_heights(record: xr.Dataset, hold: float) -> Figure:
    """Draw the height that the robot reaches over time, with robots as built and the article's two heights.

    Args:
        record: record of the experiment.
        hold: how long it stands [s].
    """
    _, rise_time, upright_time, leave_time, _, end_time = record.attrs["stages"]
    with styled():
        figure, axes = panels(1, 3, width=12.5, height=4.6, width_ratios=[1, 1.35, 1])
        rising_ax, run_ax, standing_ax = axes[0]
        for ax, begin, stop in ((rising_ax, rise_time - 2.0, upright_time + 2.0), (run_ax, 0.0, end_time)):
            _plot_heights(ax, record, begin, stop)
            for key in ("height_crawl", "height_standing"):
                ax.axhline(CLAIMS[key].value or 0.0, **LINES["printed"])
            ax.set_ylim(0.0, 1.1 * max(float(record.attrs["stretched"]), CLAIMS["height_standing"].value or 0.0))
        settled_time = upright_time + 0.02 * (leave_time - upright_time)
        _plot_heights(standing_ax, record, settled_time, leave_time)  # magnified, to show the scatter
        for ax in axes[0]:
            ax.set_ylabel("height of the highest point [m]")
        run_ax.yaxis.label.set_visible(False)  # the left panel shows it; the figure's table needs the name
        for ax, title in zip(axes[0], ("standing up", "the whole run", "standing, magnified"), strict=True):
            ax.set_title(title)
            ax.set_xlabel("time [s]")
        handles, labels = run_ax.get_legend_handles_labels()
        entries = dict(zip(labels, handles, strict=True))  # both heights of the article are one entry
        figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=4, fontsize=11)
    return captioned(
        figure,
        f"Height of the highest point of head and trunk. The robot crawls, stands for {hold:.0f} s, sits down and "
        "crawls on. Dashed: the article's two heights, "
        + " and ".join(f"{CLAIMS[key].value or 0.0:.2f} m" for key in ("height_crawl", "height_standing"))
        + ". Bands: robots built of the design.",
    )


def _plot_heights(ax: Axes, record: xr.Dataset, begin: float, stop: float) -> None:
    """Draw the height of the robot as designed, and the range of heights of the repeats, within a time interval.

    Args:
        ax: axes to draw on.
        record: record of the experiment.
        begin: start of the interval [s].
        stop: end of the interval [s].
    """
    repeat_heights = record.repeat_reach.sel(repeat_time=slice(begin, stop))
    for feedback in repeat_heights.feedback.values:
        colour = _FEEDBACK[str(feedback)]
        band = repeat_heights.sel(feedback=feedback)
        label = f"noisy servos, feedback {feedback}"
        ax.fill_between(
            band.repeat_time, band.min("repeat"), band.max("repeat"), color=colour, alpha=0.3, linewidth=0, label=label
        )
    heights = record.reach.isel(run=0).sel(time=slice(begin, stop))
    ax.plot(heights.time, heights, color=COLOURS["ours"], label="as designed")
    ax.set_xlim(begin, stop)


def draw_limits(robot: Robot, record: xr.Dataset, min_reach: float) -> Figure:
    """Draw which robots stand up, over the torque of the trunk's servos and the mass of the forebody.

    Args:
        robot: the robot of the other figures, marked by a star.
        record: record of the experiment.
        min_reach: reach from which a robot counts as standing [m].
    """
    reach = record.map_reach
    masses, torques = reach.forebody.values, reach.torque.values
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=7.6, height=4.8)
        ax = axes[0, 0]
        max_reach = max(0.7, float(reach.max()))
        mesh = ax.pcolormesh(masses, torques, reach, cmap=SEQUENTIAL, vmin=0.0, vmax=max_reach, shading="nearest")
        for j, torque in enumerate(torques):
            for i, mass in enumerate(masses):
                cell_reach = float(reach[j, i])
                colour = "black" if cell_reach > 0.57 * max_reach else "white"
                weight = "bold" if cell_reach > min_reach else "normal"
                ax.text(mass, torque, f"{cell_reach:.2f}", ha="center", va="center", color=colour, fontweight=weight)
        mass_grid = np.linspace(masses[0] - 0.1, masses[-1] + 0.1, 50)
        line = np.poly1d(np.polyfit(masses, record.map_cantilever, 1))(mass_grid)
        ax.plot(
            mass_grid, line, color=COLOURS["limbs_only"], linewidth=2.6, label="torque that lifts the level forebody"
        )
        forebody_mass = robot.thorax.mass + robot.head.mass
        ax.plot(
            forebody_mass + 0.37 * np.diff(masses).min(),
            robot.spine.pitch_servo.torque,
            "*",
            color="white",
            markeredgecolor="black",
            markersize=15,
        )
        half_step = (np.diff(masses).min() / 2, np.diff(torques).min() / 2)
        ax.set_xlim(masses[0] - half_step[0], masses[-1] + half_step[0])
        ax.set_ylim(torques[0] - half_step[1], torques[-1] + half_step[1])
        ax.set_xlabel("mass of thorax and head [kg]")
        ax.set_ylabel("torque of the trunk's pitch servos [N m]")
        ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
        figure.colorbar(mesh, ax=ax, label="reach after standing up [m]")
    return captioned(
        figure,
        "Who stands up: the height that robots with other trunk servos and other forebodies reach; the pelvis makes up "
        "for the mass. Line: what it takes to lift the level forebody off the ground. Star: the robot of the other "
        "figures.",
    )


def draw_ceiling(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the lengths that add up to the greatest reach, and the reach over the distance behind the feet.

    Args:
        robot: robot whose lengths are drawn.
        record: record of the experiment.
    """
    leg = robot.hind_leg
    lengths = (
        ("sole", leg.foot_radius, COLOURS["neutral"]),
        ("hind leg", leg.femur + leg.tibia, COLOURS["LH"]),
        ("spine", robot.spine.length, COLOURS["spine"]),
        ("head", robot.head.snout, COLOURS["RH"]),
    )
    printed_height = CLAIMS["height_standing"].value or 0.0
    with styled():
        figure, axes = panels(1, 2, width=10.0, height=4.6, width_ratios=[1, 1.6])
        ax = axes[0, 0]
        bottom = 0.0
        for name, length, colour in lengths:
            style: dict[str, Any] = {"facecolor": colour, "edgecolor": "white", "alpha": 0.75, "label": name}
            ax.add_patch(Rectangle((-0.3, bottom), 0.6, length, **style))
            ax.text(0.36, max(bottom + length / 2, 0.02), f"{name}  {1000 * length:.1f} mm", va="center")
            bottom += length
        ax.axhline(printed_height, **(dict(LINES["printed"]) | {"label": None}))
        ax.text(1.55, printed_height - 0.012, f"as printed: {printed_height:.2f} m", ha="right", va="top")
        straight_length = sum(length for name, length, _ in lengths if name != "sole")
        ax.text(-0.3, bottom + 0.012, f"{straight_length:.3f} m, with the sole {bottom:.3f} m", fontsize=11)
        ax.set_xlim(-0.4, 1.6)
        ax.set_ylim(0.0, 1.1 * max(bottom, printed_height))
        ax.set_xticks([])
        ax.set_ylabel("height above the ground [m]")
        ax.set_title("lengths in one line")
        ax = axes[0, 1]
        ax.plot(1000 * record.behind, record.ceiling, color=COLOURS["neutral"], label="no posture reaches higher")
        ax.axhline(printed_height, **LINES["printed"])
        ax.plot(
            1000 * record.lead_found, record.lead_reach, "o", color=COLOURS["ours"], markersize=7, label="simulated"
        )
        ax.set_xlabel("centre of mass behind the feet [mm]")
        ax.set_ylabel("reach [m]")
        plotted_heights = [
            printed_height,
            *record.ceiling.values,
            *record.lead_reach.values[np.isfinite(record.lead_reach.values)],
        ]
        ax.set_ylim(min(plotted_heights) - 0.01, max(plotted_heights) + 0.01)
        ax.set_title("what a safe stand costs")
        ax.legend(loc="lower left")
    head_text = (
        "; the head, which the article does not give, was chosen so that they sum up to the printed "
        f"{printed_height:g} m"
        if abs(straight_length - printed_height) <= CLAIMS["height_standing"].rounding
        else f", {straight_length:.3f} m without the sole; dashed, the printed {printed_height:g} m"
    )
    return captioned(
        figure,
        f"What the height is made of. Left: hind leg, spine and head in one line{head_text}; the bar stands on the "
        f"sole, which makes it {bottom:.3f} m. Right: the greatest height of the snout over the distance of "
        "the centre of mass behind the feet, torques aside, and what is simulated.",
    )


def draw_pushes(record: xr.Dataset, commanded: float) -> Figure:
    """Draw the smallest pushes that topple the standing robot, with feedback and without, and over its lead.

    Args:
        record: record of the experiment.
        commanded: lead of the stand of the other figures [m].
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=4.3)
        ax = axes[0, 0]
        directions = [str(w) for w in record.direction.values]
        stand_pushes = record.push.isel(commanded=int(np.argmin(np.abs(record.commanded.values - commanded))))
        for offset, feedback in ((-0.2, "off"), (0.2, "on")):
            forces = stand_pushes.sel(feedback=feedback).values
            heights = np.where(np.isfinite(forces), forces, 0.0)
            colour = _FEEDBACK[feedback]
            bars = ax.bar(
                np.arange(len(directions)) + offset, heights, 0.36, color=colour, label=f"feedback {feedback}"
            )
            ax.bar_label(bars, [f"{f:.1f}" if np.isfinite(f) else "none" for f in forces], padding=2)
        ax.set_xticks(range(len(directions)), directions)
        ax.grid(axis="x", visible=False)
        ax.set_ylabel("smallest push that topples [N]")
        ax.set_title("push of 0.2 s on the thorax")
        ax.margins(y=0.18)
        ax.legend(loc="upper left")
        ax = axes[0, 1]
        for direction, marker in zip(directions, "osD", strict=False):
            for feedback, colour in _FEEDBACK.items():
                pushes = record.push.sel(direction=direction, feedback=feedback)
                dashes = (0, (3, 1.5)) if feedback == "off" else "-"
                label = f"{direction}, feedback {feedback}"
                ax.plot(
                    1000 * record.lead_found,
                    pushes.where(np.isfinite(pushes)),
                    color=colour,
                    linestyle=dashes,
                    marker=marker,
                    markersize=6,
                    label=label,
                )
        ax.set_xlabel("centre of mass behind the feet [mm]")
        ax.set_ylabel("smallest push that topples [N]")
        ax.set_title("pushes over the distance behind the feet")
        ax.set_ylim(bottom=0.0)
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=10)
    return captioned(
        figure,
        "The smallest push of 0.2 s on the thorax that topples the standing robot, with feedback of pitch and tail "
        "load and without. Left: in the stand of the other figures. Right: over the distance of the centre of mass "
        "behind the feet, dashed without feedback.",
    )


_MIN_SUPPORT_FORCE = 0.5  # [N]; less is no support
_DASHES = ((0, (4, 1.5)), (0, (1, 1.2)))  # for the trunk's second and later pitch joints
_SPACING = 0.06  # [m]; between two robots of the strip


def draw_side_views(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the robot from its right side at five times while it rises, with mass, support and reach.

    Args:
        robot: robot whose record it is.
        record: record of the experiment; its first run and its ``stages`` are used.
    """
    start, rise_time, upright_time, leave_time, *_ = record.attrs["stages"]
    rise_duration = upright_time - rise_time
    times = {
        "crawling": start + 0.25,
        "feet ahead": rise_time + 0.33 * rise_duration,
        "trunk up": rise_time + 0.555 * rise_duration,
        "half up": rise_time + 0.72 * rise_duration,
        "standing": min(upright_time + 2.0, (upright_time + leave_time) / 2),
    }
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=13.0, height=3.5)
        ax = axes[0, 0]
        edge = 0.0
        for name, time in times.items():
            snapshot = record.isel(run=0).sel(time=[time], method="nearest")
            if name != "crawling":  # in the crawl the pelvis swings, and the robot walks along x
                snapshot = _facing_right(snapshot)
            rear_extent, front_extent = _extent(robot, snapshot, time)
            x = edge + rear_extent
            edge = x + front_extent + _SPACING
            shifted_snapshot = snapshot.assign(
                {n: snapshot[n] + _hind_feet_shift(snapshot, x) for n in _POSITION_FIELDS}
            )
            draw_posture(ax, robot, shifted_snapshot, time, view="side")
            _mark_support(ax, shifted_snapshot.isel(time=0))
            ax.text(x, -0.045, name, ha="center", va="top")
            ax.text(x, -0.125, f"{time - rise_time:+.1f} s", ha="center", va="top", color=COLOURS["neutral"])
            height = float(snapshot.reach[0])
            ax.plot([x - 0.16, x + _HEIGHT_LINE_LENGTH], [height, height], **_REACH_LINE)
            ax.text(
                x + _HEIGHT_LINE_LENGTH,
                height + 0.008,
                f"{height:.2f} m",
                color=COLOURS["ours"],
                va="bottom",
                ha="right",
            )
        ax.set_xlim(-_SPACING, edge)
        ax.set_ylim(-0.2, 0.74)
        ax.set_yticks(np.arange(0.0, 0.71, 0.1))
        ax.set_ylabel("height above the ground [m]")
        ax.set_xticks([])
        ax.set_xlabel("place along the strip [m]", visible=False)  # for the table of the figure
        ax.spines["bottom"].set_visible(False)
    return captioned(
        figure,
        "From the crawl to standing on hind legs and tail, from the right side; times since the crawl stopped. Red: "
        "the centre of mass and its projection. Triangles: what carries the robot. Blue: the height of its highest "
        "point.",
    )


_LABEL_WIDTH = 0.34  # [m]; width of the label under a robot
_HEIGHT_LINE_LENGTH = 0.2  # [m]; length of the height line ahead of the hind feet
_POSITION_FIELDS = ("position", "centre_of_mass", "foot_position", "tail_tip")
_REACH_LINE: dict[str, Any] = {
    "color": COLOURS["ours"],
    "linewidth": 1.6,
    "linestyle": (0, (5, 2)),
    "zorder": 6,
    "label": "_reach",
}


def _hind_feet_shift(record: xr.Dataset, x: float) -> xr.DataArray:
    """Return the horizontal shift that moves the mean of the hind feet to x; heights do not change [m]."""
    hind_feet_x = record.foot_position.sel(leg=["LH", "RH"], xyz="x").mean(("leg", "time"))
    return xr.DataArray([x - float(hind_feet_x), 0.0, 0.0], dims="xyz", coords={"xyz": record.xyz})


def _extent(robot: Robot, record: xr.Dataset, time: float) -> tuple[float, float]:
    """Return how far the robot extends behind and ahead of the mean of its hind feet [m].

    Args:
        robot: robot that is drawn.
        record: snapshot of its record.
        time: time of the snapshot [s].
    """
    bones = skeleton(robot, record, time)
    x = np.concatenate([points[:, 0] for points in (bones.trunk, bones.tail, *bones.legs)])
    center = float(record.foot_position.sel(leg=["LH", "RH"], xyz="x").mean())
    min_extent = _LABEL_WIDTH / 2  # the label may be wider than the robot
    return max(center - float(x.min()), min_extent), max(float(x.max()) - center, _HEIGHT_LINE_LENGTH, min_extent)


def _facing_right(record: xr.Dataset) -> xr.Dataset:
    """Return a snapshot rotated about the vertical axis such that the pelvis faces along x."""
    quaternion = record.orientation.isel(time=0).values.astype(float)
    left_axis = rotation.matrix(quaternion)[:, 1]  # level in every posture
    yaw = float(np.arctan2(left_axis[0], left_axis[1]))
    c, s = np.cos(yaw), np.sin(yaw)
    R = xr.DataArray([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], dims=("to", "xyz"), coords={"xyz": record.xyz})
    rotated = {n: (R * record[n]).sum("xyz").rename(to="xyz").assign_coords(xyz=record.xyz) for n in _POSITION_FIELDS}
    q = rotation.multiply(rotation.from_axis_angle(np.array([0.0, 0.0, 1.0]), yaw), quaternion)
    return record.assign(rotated).assign(orientation=(("time", "wxyz"), [q]))


def _mark_support(ax: Axes, snapshot: xr.Dataset) -> None:
    """Draw a triangle below each foot and the tail tip that carries load."""
    points = [
        snapshot.foot_position.sel(leg=leg, xyz="x")
        for leg in snapshot.leg
        if snapshot.foot_force.sel(leg=leg, xyz="z") > _MIN_SUPPORT_FORCE
    ]
    if float(snapshot.tail_force.sel(xyz="z")) > _MIN_SUPPORT_FORCE:
        points.append(snapshot.tail_tip.sel(xyz="x"))
    x = [float(p) for p in points]
    ax.plot(x, [-0.012] * len(x), "^", color="#B8860B", markersize=7, zorder=6, clip_on=False, label="_support")


def draw_angles(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the angles of pelvis, trunk and tail over time, down positive, and which feet stand, up and down again.

    Args:
        robot: robot that stands up.
        record: record of the experiment; its first run and its ``stages`` are used.
    """
    _, rise_time, upright_time, leave_time, down_time, _ = record.attrs["stages"]
    run = record.isel(run=0)
    body_layout = layout(robot)
    first_servo, *other_servos = body_layout.trunk_pitch
    lines: list[tuple[str, xr.DataArray, dict[str, Any]]] = [
        ("pelvis against the ground", tilt(run)["pitch"], {"color": COLOURS["ours"]}),
        ("trunk, first pitch joint", run.servo_angle[:, first_servo], {"color": COLOURS["spine"]}),
    ]
    for number, (servo, dashes) in enumerate(zip(other_servos, cycle(_DASHES), strict=False), 2):
        ordinal = {2: "second", 3: "third"}.get(number, f"{number}th")
        style = {"color": COLOURS["spine"], "linestyle": dashes}
        lines.append((f"trunk, {ordinal} pitch joint", run.servo_angle[:, servo], style))
    lines.append(("tail, pitch joint", run.servo_angle[:, body_layout.tail_pitch[0]], {"color": COLOURS["tail"]}))
    with styled():
        figure, axes = panels(2, 2, width=10.0, height=5.4, sharex="col", sharey="row", height_ratios=[3.4, 1.0])
        for ax, stance_ax, begin, end, time_origin, title, time_label in (
            (
                *axes[:, 0],
                rise_time - 0.5,
                upright_time + 2.0,
                rise_time,
                "standing up",
                "time since the crawl stopped [s]",
            ),
            (
                *axes[:, 1],
                leave_time - 2.0,
                down_time + 0.5,
                leave_time,
                "sitting down",
                "time since the stand ended [s]",
            ),
        ):
            for label, values, style in lines:
                window = values.sel(time=slice(begin, end))
                ax.plot(window.time - time_origin, np.degrees(window), label=label, **style)
            ax.set_title(title)
            ax.set_xlim(begin - time_origin, end - time_origin)
            _draw_stances(stance_ax, run.sel(time=slice(begin, end)), time_origin)
            stance_ax.set_xlabel(time_label)
        axes[0, 0].set_ylabel("angle, front end or tip down [deg]")
        axes[0, 1].legend(loc="upper right", bbox_to_anchor=(1.0, min(0.93 + 0.07 * (len(lines) - 4), 1.0)))
    return captioned(
        figure,
        "Angles of pelvis, trunk and tail while standing up (left) and sitting down (right), up negative as in the "
        "article. The trunk bends up first, "
        "then the pelvis pitches up while the trunk straightens; the tail's joint makes room for the pelvis. Bars: a "
        "foot stands. The article took its angles and foot phases from a film of an animal; no such film is published "
        "as numbers, so that none stands beside.",
    )


def _draw_stances(ax: Axes, record: xr.Dataset, time_origin: float) -> None:
    """Draw a bar for each interval in which a foot carries load.

    Args:
        ax: axes to draw on, one row per leg.
        record: record of one run.
        time_origin: time that is drawn as zero [s].
    """
    legs = [str(leg) for leg in record.leg.values]
    for row, stands in enumerate(stance(record).transpose("leg", "time").values):
        spans = [(begin, end - begin) for begin, end in intervals(record.time.values - time_origin, stands)]
        ax.broken_barh(spans, (row - 0.36, 0.72), facecolor=COLOURS["neutral"])
    ax.set_yticks(range(len(legs)), legs)
    ax.set_ylim(len(legs) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.grid(False)
