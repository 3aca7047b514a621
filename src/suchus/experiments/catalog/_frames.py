"""The frames of a D-H chain as a drawing, in the manner of the article's Figs 6 and 8."""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.article.paper.tables import Chain
from suchus.robot.kinematics import dh
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_AZIMUTH, _ELEVATION = -0.32 * pi, 0.16 * pi
"""From where the chain is seen: about the vertical from straight ahead, and above the level [rad]."""
_ARROW = 0.12
"""Length of an axis, over the length of the chain [-]."""
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


def draw_frames(record: xr.Dataset, names: Sequence[str], said: str) -> Figure:
    """Draw the frames of a record with their axes X and Z, and Y of frame 0.

    Args:
        record: record with what ``frames_of`` returns.
        names: names of the joint or point at each frame.
        said: what the chain is, for the caption.
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
        for i, name in enumerate(names):
            first = next(k for k in range(len(names)) if np.allclose(origins[k], origins[i]))
            if name and first == i:
                ax.annotate(name, origins[i], (6, -16), textcoords="offset points", ha="center", va="top", fontsize=10)
        tips = np.concatenate([origins, (origins[:, None] + 1.6 * size * axes).reshape(-1, 2)])
        ax.set(xlim=(tips[:, 0].min(), tips[:, 0].max()), ylim=(tips[:, 1].min(), tips[:, 1].max()))
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set(xlabel="across the picture [mm]", ylabel="up in the picture [mm]")
    return captioned(figure, f"{said} Each joint turns about its Z; X points along the link that follows.")
