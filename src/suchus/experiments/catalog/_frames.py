"""The frames of a D-H chain as a drawing, in the manner of the article's Figs 6 and 8."""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.article.paper.tables import Chain
from suchus.robot.kinematics import dh
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_AZIMUTH, _ELEVATION = -0.32 * pi, 0.16 * pi
"""From where the chain is seen: about the vertical from straight ahead, and above the level [rad]."""
_ARROW = 0.12
"""Length of an axis, over the length of the chain [-]."""
_ARC = 1.6
"""Radius of the arc of an angle, over the length of an axis [-]."""
_FLAT_ARC = 1.3
"""The same where the links lie nearly in one line [-]."""
_LEAST_ANGLE = 1e-6
"""Angle below which none is drawn [rad]."""
_LEAST_LENGTH = 1e-6
"""Length of a link in the picture below which none is written [mm]."""
_COLOURS = {"X": COLOURS["limbs_only"], "Y": COLOURS["tail_drag"], "Z": COLOURS["ours"]}


def frames_of(chain: Chain, angles: Sequence[float], world: np.ndarray) -> xr.Dataset:
    """Return origins and axes of all frames of a chain, from frame 0 on, as seen by one who stands beside the robot.

    Args:
        chain: the links.
        angles: one for each [rad].
        world: forward, left and up in the coordinates of frame 0, (3, 3).
    """
    T = np.concatenate([np.eye(4)[None], dh.frames(chain, np.array(angles))])
    return xr.Dataset(
        {
            "frame_origin": (("frame", "world"), T[:, :3, 3] @ world.T, {"units": "m", "long_name": "origin"}),
            "frame_axis": (
                ("frame", "along", "world"),
                np.swapaxes(T[:, :3, :3], 1, 2) @ world.T,
                {"units": "1", "long_name": "axis"},
            ),
        },
        coords={"along": list(_COLOURS), "world": ["forward", "left", "up"]},
    )


def draw_frames(record: xr.Dataset, names: Sequence[str], said: str, *, is_flat: bool = False) -> Figure:
    """Draw the frames of a record with their axes X and Z, Y of frame 0, the lengths a and the angles theta.

    Args:
        record: record with what ``frames_of`` returns.
        names: names of the joint or point at each frame.
        said: what the chain is, for the caption.
        is_flat: whether the links lie nearly in one line; lengths are then written above them and angles below.
    """
    across = np.array([-sin(_AZIMUTH), cos(_AZIMUTH), 0.0])
    upward = np.array([-sin(_ELEVATION) * cos(_AZIMUTH), -sin(_ELEVATION) * sin(_AZIMUTH), cos(_ELEVATION)])
    seen = 1000 * np.stack([across, upward], axis=-1)
    origins, axes = record.frame_origin.values @ seen, record.frame_axis.values @ seen
    size = _ARROW * float(np.linalg.norm(np.diff(record.frame_origin, axis=0), axis=1).sum())
    with styled(axes__grid=False):
        figure, panel = panels(1, 1, width=8.2, height=4.6)
        ax = panel[0, 0]
        ax.plot(*origins.T, "-", color="#C9CDC4", linewidth=9, solid_capstyle="round", label="_links", zorder=1)
        ax.plot(*origins.T, "o", color="white", markeredgecolor=COLOURS["printed"], label="_origins", zorder=4)
        for i, (origin, turned) in enumerate(zip(origins, axes, strict=True)):
            for name, along in zip(_COLOURS, turned, strict=True):
                if name == "Y" and i > 0:
                    continue
                tip = origin + size * along
                ax.annotate("", tip, origin, arrowprops={"arrowstyle": "-|>", "color": _COLOURS[name], "lw": 1.8})
                aside = (0, 11) if name == "X" else (0, 0)  # off the link along which it points
                ax.annotate(f"${name}_{i}$", origin + 1.2 * size * along, aside, textcoords="offset points",
                            color=_COLOURS[name], ha="center", va="center")  # fmt: skip
        for i in range(1, len(origins)):
            _draw_length(ax, i - 1, origins, is_flat=is_flat)
            _draw_angle(
                ax,
                i,
                origins[i],
                record.frame_axis.values,
                seen,
                (_FLAT_ARC if is_flat else _ARC) * size,
                is_flat=is_flat,
            )
        for i, name in enumerate(names):
            first = next(k for k in range(len(names)) if np.allclose(origins[k], origins[i]))
            if name and first == i:
                ax.annotate(name, origins[i], (6, -16), textcoords="offset points", ha="center", va="top", fontsize=10)
        tips = np.concatenate([origins, (origins[:, None] + 1.6 * size * axes).reshape(-1, 2)])
        ax.set(xlim=(tips[:, 0].min(), tips[:, 0].max()), ylim=(tips[:, 1].min(), tips[:, 1].max()))
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set(xlabel="across the picture [mm]", ylabel="up in the picture [mm]")
    return captioned(figure, f"{said} Joint i turns by $\\theta_i$ about its Z, from the dashed "
                     "direction of the X before; link i is $a_i$ long and lies along X.")  # fmt: skip


def _draw_length(ax: Axes, i: int, origins: np.ndarray, *, is_flat: bool) -> None:
    """Write a_i beside the link from frame i to the next one; nothing where both have one origin.

    Args:
        ax: axes of the drawing.
        i: number of the frame.
        origins: origins of the frames in the picture, shape (frame, 2) [mm].
        is_flat: whether all but the first stand above their link, near its end; else below its middle.
    """
    link = origins[i + 1] - origins[i]
    length = float(np.hypot(*link))
    if length < _LEAST_LENGTH:
        return
    below = np.array([link[1], -link[0]]) / length
    aside = 15.0 * (below if (below[1] <= 0) != is_flat else -below)
    ax.annotate(
        f"$a_{i}$",
        origins[i] + (0.88 if is_flat else 0.55) * link,
        tuple(aside),
        textcoords="offset points",
        ha="center",
        va="center",
    )


def _draw_angle(
    ax: Axes, i: int, origin: np.ndarray, axes: np.ndarray, seen: np.ndarray, radius: float, *, is_flat: bool
) -> None:
    """Draw theta_i about Z of frame i: an arc from the direction of the X before to X; nothing of a joint at rest.

    Args:
        ax: axes of the drawing.
        i: number of the frame, 1 or more.
        origin: its origin in the picture [mm].
        axes: axes of all frames in the world, shape (frame, along, world).
        seen: the picture's two directions, shape (world, 2) [mm/m].
        radius: radius of the arc [m].
        is_flat: whether its name stands below the dashed line; else beyond the arc.
    """
    before, x, z = axes[i - 1, 0], axes[i, 0], axes[i, 2]
    side = np.cross(z, before)
    theta = float(np.arctan2(x @ side, x @ before))
    if abs(theta) < _LEAST_ANGLE:
        return

    def direction(angle: float) -> np.ndarray:
        """Return a direction in the plane in which the joint turns, in the picture [mm/m]."""
        turned: np.ndarray = (np.cos(angle) * before + np.sin(angle) * side) @ seen
        return turned

    arc = np.array([origin + radius * direction(angle) for angle in np.linspace(0.0, theta, 30)])
    line = np.array([origin, origin + 1.1 * radius * direction(0.0)])
    ax.plot(*line.T, "--", color=COLOURS["printed"], linewidth=1.0, label=f"_before_{i}", zorder=2)
    ax.plot(*arc.T, "-", color=COLOURS["printed"], linewidth=1.4, label=f"_theta_{i}", zorder=3)
    middle = direction(0.5 * theta)
    place, aside = origin + radius * middle, 14.0 * middle / np.hypot(*middle)
    if is_flat:
        place, aside = origin + radius * direction(0.0), np.array([0.0, -12.0])
    ax.annotate(f"$\\theta_{i}$", tuple(place), tuple(aside), textcoords="offset points", ha="center", va="center")
