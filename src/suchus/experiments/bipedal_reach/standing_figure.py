"""Standing up on hind legs and tail: postures and angles."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus import rotation
from suchus.design import Robot, layout
from suchus.figures.posture import draw_posture, skeleton
from suchus.figures.style import COLOURS, captioned, panels, styled
from suchus.metrics import tilt

_TOUCHES = 0.5  # [N]; less is no support
_GAP = 0.06  # [m] between two robots of the strip


def draw_side_views(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the robot from its right side at five times while it rises, with mass, support and reach.

    Args:
        robot: whose record it is.
        record: of the experiment; its first run and its ``stages`` are used.
    """
    start, at, up, leave, *_ = record.attrs["stages"]
    rise = up - at
    times = {
        "crawling": start + 0.25,
        "feet ahead": at + 0.33 * rise,
        "trunk up": at + 0.555 * rise,
        "half up": at + 0.72 * rise,
        "standing": min(up + 2.0, (up + leave) / 2),
    }
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=13.0, height=3.5)
        ax = axes[0, 0]
        edge = 0.0
        for name, time in times.items():
            one = record.isel(run=0).sel(time=[time], method="nearest")
            if name != "crawling":  # in the crawl the pelvis swings, and the robot walks along x
                one = _facing_right(one)
            behind, ahead = _extent(robot, one, time)
            x = edge + behind
            edge = x + ahead + _GAP
            here = one.assign({n: one[n] + _shift(one, x) for n in _PLACES})
            draw_posture(ax, robot, here, time, view="side")
            _mark_support(ax, here.isel(time=0))
            ax.text(x, -0.045, name, ha="center", va="top")
            ax.text(x, -0.125, f"{time - at:+.1f} s", ha="center", va="top", color=COLOURS["neutral"])
            height = float(one.reach[0])
            ax.plot([x - 0.16, x + _REACHED], [height, height], **_REACH)
            ax.text(x + _REACHED, height + 0.008, f"{height:.2f} m", color=COLOURS["ours"], va="bottom", ha="right")
        ax.set_xlim(-_GAP, edge)
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


_LABEL = 0.34  # [m] width of the words under a robot
_REACHED = 0.2  # [m] length of the line of the height, ahead of the hind feet
_PLACES = ("position", "centre_of_mass", "foot_position", "tail_tip")
_REACH: dict[str, Any] = {"color": COLOURS["ours"], "linewidth": 1.6, "linestyle": (0, (5, 2)), "zorder": 6}


def _shift(record: xr.Dataset, x: float) -> xr.DataArray:
    """Return what brings the hind feet's middle to a place and keeps heights."""
    now = record.foot_position.sel(leg=["LH", "RH"], xyz="x").mean(("leg", "time"))
    return xr.DataArray([x - float(now), 0.0, 0.0], dims="xyz", coords={"xyz": record.xyz})


def _extent(robot: Robot, record: xr.Dataset, time: float) -> tuple[float, float]:
    """Return how far the robot extends behind and ahead of the middle of its hind feet [m]."""
    bones = skeleton(robot, record, time)
    x = np.concatenate([part[:, 0] for part in (bones.trunk, bones.tail, *bones.legs)])
    middle = float(record.foot_position.sel(leg=["LH", "RH"], xyz="x").mean())
    label = _LABEL / 2  # the words under a robot that is narrower than they are
    return max(middle - float(x.min()), label), max(float(x.max()) - middle, _REACHED, label)


def _facing_right(record: xr.Dataset) -> xr.Dataset:
    """Return a moment of a record turned about the vertical, so that the pelvis faces along x."""
    now = record.orientation.isel(time=0).values.astype(float)
    left = rotation.matrix(now)[:, 1]  # which stays level
    turn = float(np.arctan2(left[0], left[1]))
    c, s = np.cos(turn), np.sin(turn)
    R = xr.DataArray([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], dims=("to", "xyz"), coords={"xyz": record.xyz})
    turned = {n: (R * record[n]).sum("xyz").rename(to="xyz").assign_coords(xyz=record.xyz) for n in _PLACES}
    q = rotation.multiply(rotation.about(np.array([0.0, 0.0, 1.0]), turn), now)
    return record.assign(turned).assign(orientation=(("time", "wxyz"), [q]))


def _mark_support(ax: Axes, now: xr.Dataset) -> None:
    points = [
        now.foot_position.sel(leg=leg, xyz="x") for leg in now.leg if now.foot_force.sel(leg=leg, xyz="z") > _TOUCHES
    ]
    if float(now.tail_force.sel(xyz="z")) > _TOUCHES:
        points.append(now.tail_tip.sel(xyz="x"))
    x = [float(p) for p in points]
    ax.plot(x, [-0.012] * len(x), "^", color="#B8860B", markersize=7, zorder=6, clip_on=False)


def draw_angles(robot: Robot, record: xr.Dataset) -> Figure:
    """Draw the angles of pelvis, trunk and tail over time, up positive, while it rises and while it lies down.

    Args:
        robot: who stands up.
        record: of the experiment; its first run and its ``stages`` are used.
    """
    _, at, up, leave, down, _ = record.attrs["stages"]
    one = record.isel(run=0)
    (first, second), (tail,) = layout(robot).trunk_pitch, layout(robot).tail_pitch
    lines = (
        ("pelvis against the ground", -tilt(one)["pitch"], {"color": COLOURS["ours"]}),
        ("trunk, first pitch joint", -one.servo_angle[:, first], {"color": COLOURS["spine"]}),
        (
            "trunk, second pitch joint",
            -one.servo_angle[:, second],
            {"color": COLOURS["spine"], "linestyle": (0, (4, 1.5))},
        ),
        ("tail, pitch joint", -one.servo_angle[:, tail], {"color": COLOURS["tail"]}),
    )
    with styled():
        figure, axes = panels(1, 2, width=10.0, height=4.4, sharey=True)
        for ax, begin, end, zero, title, since in (
            (axes[0, 0], at - 0.5, up + 2.0, at, "standing up", "time since the crawl stopped [s]"),
            (axes[0, 1], leave - 2.0, down + 0.5, leave, "sitting down", "time since the stand ended [s]"),
        ):
            for label, values, style in lines:
                part = values.sel(time=slice(begin, end))
                ax.plot(part.time - zero, np.degrees(part), label=label, **style)
            ax.set_title(title)
            ax.set_xlabel(since)
            ax.set_xlim(begin - zero, end - zero)
        axes[0, 0].set_ylabel("angle, front end or tip up [deg]")
        axes[0, 1].legend(loc="upper right", bbox_to_anchor=(1.0, 0.93))
    return captioned(
        figure,
        "Angles of pelvis, trunk and tail while standing up (left) and sitting down (right). The trunk bends up first, "
        "then the pelvis pitches up while the trunk straightens; the tail's joint makes room for the pelvis.",
    )
