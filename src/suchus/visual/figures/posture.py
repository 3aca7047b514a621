"""A posture as a vector drawing: from above or from the side, with support and centre of mass."""

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex, to_rgb
from matplotlib.patches import Circle, PathPatch, Polygon
from matplotlib.path import Path

from suchus.core import rotation
from suchus.robot.design import GRAVITY, Layout, LimbPlace, Robot, layout
from suchus.robot.kinematics.tree import BodyFrames, frames, landmarks
from suchus.sim.metrics import loaded, support_polygon
from suchus.sim.metrics.gait import LOADED_SHARE
from suchus.visual.figures.silhouette import Silhouette, silhouette
from suchus.visual.figures.style import COLOURS
from suchus.visual.skin import poses, skin

View = Literal["above", "side"]
_BODY, _EDGE, _FAR_COLOUR, _PALE_COLOUR, _PLATE = "#C9DCCB", "#4D6B57", "#E3EBE3", "#E6EEE2", "#A8C6AE"


class Skeleton(NamedTuple):
    """Points of the body in the world."""

    trunk: np.ndarray
    """Points from the first joint of the tail over the root and the joints ahead of it to front girdle and snout
    [m]."""
    joints: np.ndarray
    """Those of them that are joints ahead of the root, (joint, 3) [m]."""
    tail: np.ndarray
    """Points from its first joint to the tip, (point, 3) [m]."""
    legs: tuple[np.ndarray, ...]
    """Midline, hip, joints and foot of each limb, (point, 3) [m]."""


def skeleton(robot: Robot, record: xr.Dataset, time: float) -> Skeleton:
    """Return the body's points in the world at one time.

    Args:
        robot: robot whose record it is.
        record: record of one run.
        time: [s].
    """
    state, robot_layout = record.sel(time=time, method="nearest"), layout(robot)
    angles = state.joint_angle.values.astype(float)
    R, root_position = rotation.matrix(state.orientation.values.astype(float)), state.position.values.astype(float)
    body_frames, marks = frames(robot, angles), landmarks(robot, angles)
    names = [body.name for body in robot_layout.bodies]
    front_joints = body_frames.positions[[names.index(name) for name in robot_layout.trunk[1:]]].reshape(-1, 3)
    tail_joints = body_frames.positions[[names.index(name) for name in robot_layout.tail]].reshape(-1, 3)
    legs = [_leg(robot_layout, limb, body_frames, marks.feet[i]) for i, limb in enumerate(robot_layout.limbs)]
    shoulders = [leg[0] for leg in legs[:1]]
    trunk = np.array([*tail_joints[:1], np.zeros(3), *front_joints, *shoulders, marks.snout])
    tail = np.array([*tail_joints, marks.tail])
    return Skeleton(
        trunk=root_position + trunk @ R.T,
        joints=root_position + front_joints @ R.T,
        tail=root_position + tail @ R.T,
        legs=tuple(root_position + points @ R.T for points in legs),
    )


def _leg(robot_layout: Layout, limb: LimbPlace, body_frames: BodyFrames, foot: np.ndarray) -> np.ndarray:
    """Return midline, hip, joints and foot of a limb in the frame of the root, (point, 3) [m]."""
    first_body = limb.tip - len(limb.girdle.limb.links) + 1
    parent = robot_layout.bodies[first_body].parent
    x, _, z = robot_layout.bodies[first_body].offset
    midline = body_frames.positions[parent] + body_frames.turns[parent] @ np.array([x, 0.0, z])
    return np.array([midline, *body_frames.positions[first_body : limb.tip + 1], foot])


def silhouette_at(robot: Robot, record: xr.Dataset, time: float, axes: tuple[int, int]) -> Silhouette:
    """Return the silhouette of a robot in the world at one time.

    Args:
        robot: robot whose record it is.
        record: record of one run.
        time: [s].
        axes: which two coordinates are drawn: (0, 1) from above, (0, 2) from the side.
    """
    state = record.sel(time=time, method="nearest")
    pose = (state[name].values.astype(float) for name in ("position", "orientation", "joint_angle"))
    return silhouette(robot, skin(robot).posed(*poses(robot, *pose)), axes)


def draw_posture(
    ax: Axes,
    robot: Robot,
    record: xr.Dataset,
    time: float,
    *,
    view: View = "above",
    support: bool = True,
    ground: bool = True,
    strength: float = 1.0,
) -> None:
    """Draw a posture, feet that stand filled, the support polygon and the centre of mass projected.

    Args:
        ax: axes to draw on; their aspect becomes equal.
        robot: robot whose record it is.
        record: record of one run.
        time: [s].
        view: from above (x to the right, y up) or from the robot's left side is seen from its right (x right, z up).
        support: whether to draw support and centre of mass.
        ground: whether to draw even ground in a view from the side.
        strength: strength of the colours; below one they fade to white, and the scutes are left out.
    """
    rows = [0, 1] if view == "above" else [0, 2]
    bones = skeleton(robot, record, time)
    load_threshold = LOADED_SHARE * robot.mass * GRAVITY
    stands = loaded(record.sel(time=time, method="nearest"), load_threshold).values
    if view == "side" and ground:
        ax.axhline(0.0, color=COLOURS["ground"], linewidth=1.2, zorder=0)
    if support and view == "above":
        _support(ax, record, time, load_threshold)
    for limb, points, standing in zip(layout(robot).limbs, bones.legs, stands, strict=True):
        is_far = view == "side" and limb.side > 0
        edge, radius = _paler(_EDGE, strength), limb.girdle.limb.foot.radius
        foot = Circle(tuple(points[-1, rows]), radius, facecolor=edge if standing else "white", edgecolor=edge)
        foot.set_zorder(0.9 if is_far else 4)
        ax.add_patch(foot)
    _draw_skin(ax, layout(robot), silhouette_at(robot, record, time, (rows[0], rows[1])), view, strength)
    joints = bones.joints[:, rows]
    ax.plot(
        *joints.T,
        "o",
        markersize=3.2,
        markerfacecolor="white",
        markeredgecolor=_paler(_EDGE, strength),
        markeredgewidth=0.9,
        zorder=3,
        label="_joints",
    )
    if support:
        com = record.centre_of_mass.sel(time=time, method="nearest").values.astype(float)[rows]
        _mark_mass(ax, com, view)
    ax.set_aspect("equal")


def draw_strip(
    ax: Axes, robot: Robot, record: xr.Dataset, times: Sequence[float], *, role: str, lateral_offset: float = 0.0
) -> None:
    """Draw a robot from above at several times, the earlier ones paler, with the track of its centre of mass.

    Args:
        ax: axes to draw on; their aspect becomes equal.
        robot: robot whose record it is.
        record: record of one run.
        times: increasing [s].
        role: role of ``style.COLOURS``, for the track.
        lateral_offset: how far to the left of its place it is drawn [m].
    """
    shifted_record = record.assign(
        {
            name: record[name] + _lateral_shift(record, lateral_offset)
            for name in ("position", "centre_of_mass", "foot_position")
        }
    )
    for i, time in enumerate(times):
        earlier_artists = set(ax.get_children())
        fade = 0.25 + 0.75 * (i / max(len(times) - 1, 1)) ** 3 if len(times) > 1 else 1.0
        draw_posture(ax, robot, shifted_record, time, support=False, strength=fade)
        for artist in set(ax.get_children()) - earlier_artists:
            artist.set_zorder(artist.get_zorder() + 10 * i)
    track = shifted_record.centre_of_mass.sel(time=slice(times[0], times[-1]))
    x, y = (track.sel(xyz=axis).values for axis in "xy")
    ax.plot(x, y, color=COLOURS[role], linewidth=2.4, zorder=10 * len(times) + 9, label="_path of the centre of mass")
    ax.plot(
        x[[0, -1]],
        y[[0, -1]],
        "o",
        color=COLOURS[role],
        markersize=7,
        zorder=10 * len(times) + 9,
        label="_ends of the path",
    )


def _lateral_shift(record: xr.Dataset, lateral_offset: float) -> xr.DataArray:
    return xr.DataArray([0.0, lateral_offset, 0.0], dims="xyz", coords={"xyz": record.xyz})


def _draw_skin(ax: Axes, robot_layout: Layout, outline: Silhouette, view: View, strength: float) -> None:
    """Draw the skin; from the side the left legs lie behind the body and the right legs in front of it.

    Args:
        ax: axes to draw on.
        robot_layout: layout of the robot.
        outline: silhouette in the view.
        view: from above or from the side.
        strength: strength of the colours; below one they fade to white.
    """
    edge, body, far_leg, pale_face, plate = (
        _paler(c, strength) for c in (_EDGE, _BODY, _FAR_COLOUR, _PALE_COLOUR, _PLATE)
    )
    for limb, pieces in zip(robot_layout.limbs, outline.legs, strict=True):
        is_near = view == "side" and limb.side < 0
        is_far = view == "side" and not is_near
        face, order = (far_leg, 0.8) if is_far else (body, 2.6) if is_near else (body, 1.0)
        # strokes first, then fillings: only the common outline of all pieces remains
        leg_path = joined_path(pieces)
        ax.add_artist(
            PathPatch(leg_path, facecolor=edge, edgecolor=edge, linewidth=1.8, joinstyle="round", zorder=order)
        )
        ax.add_artist(PathPatch(leg_path, facecolor=face, edgecolor=face, linewidth=0.2, zorder=order + 0.01))
        ax.update_datalim(leg_path.vertices)  # faster than add_patch, which searches the extremes of every edge
    for piece, face, order in ((outline.jaw, pale_face, 1.9), (outline.body, body, 2.0)):
        if not len(piece):
            continue
        ax.add_patch(Polygon(piece, facecolor=face, edgecolor=edge, linewidth=0.9, joinstyle="round", zorder=order))
    for eye in outline.eyes if view == "above" else outline.eyes[1:]:
        ax.add_patch(Polygon(eye, facecolor=edge, edgecolor="none", zorder=2.4))
    if strength == 1.0 and outline.scutes:
        plates = joined_path(outline.scutes)
        ax.add_artist(PathPatch(plates, facecolor=plate, edgecolor=edge, linewidth=0.35, zorder=2.2))
        ax.update_datalim(plates.vertices)


def joined_path(pieces: Sequence[np.ndarray]) -> Path:
    """Return polygons as one path: a single element of a vector file, a third of the size."""
    return Path.make_compound_path(*(Path(np.vstack([piece, piece[:1]]), closed=True) for piece in pieces))


def _paler(colour: str, strength: float) -> str:
    red, green, blue = (1.0 - strength * (1.0 - component) for component in to_rgb(colour))
    return to_hex((red, green, blue))


def _support(ax: Axes, record: xr.Dataset, time: float, load_threshold: float) -> None:
    """Draw the support polygon, or the line between two standing feet."""
    corners = support_polygon(record, time, load_threshold)
    if len(corners) >= 3:
        ax.add_patch(Polygon(corners, facecolor="#F2C46D", alpha=0.45, edgecolor="#B8860B", linewidth=1.4, zorder=0.5))
    elif len(corners) == 2:
        ax.add_collection(LineCollection([corners], colors="#B8860B", linewidths=3.0, zorder=0.5))


def _mark_mass(ax: Axes, com: np.ndarray, view: View) -> None:
    """Mark the projected centre of mass; from the side with a line down to the ground."""
    style: dict[str, Any] = {"color": COLOURS["alarm"], "zorder": 5, "label": "_centre of mass"}
    ax.plot(com[0], com[1], "o", markersize=7, markerfacecolor="white", markeredgewidth=1.8, **style)
    ax.plot(com[0], com[1], "+", markersize=7, markeredgewidth=1.4, **style)
    if view == "side":
        ax.plot([com[0], com[0]], [0.0, com[1]], linewidth=1.0, linestyle=(0, (2, 2)), **style)
