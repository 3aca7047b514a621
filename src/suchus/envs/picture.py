"""A robot at its task as a picture, drawn as the figures draw it: no OpenGL, and no screen."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float, UInt8
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle

from suchus.design import Robot
from suchus.envs.goals import AnyGoal, Landing
from suchus.figures import COLOURS, new, styled
from suchus.figures.posture import draw_posture
from suchus.robots import beside_article

WIDTH, HEIGHT = 640, 480
"""Of a picture [pixel]."""
_DPI = 100
_PLACES = ((0.12, 0.622, 0.8, 0.333), (0.12, 0.09, 0.8, 0.52))
"""Of the two views, as shares of the picture: left, bottom, width, height."""
_SPAN, _WIDE, _TALL = 1.6, 0.5, 0.75  # [m]; what is seen of the article's robot: along the walk, across it, and up
_BELOW = 0.03  # [m]; what is seen below the ground
_TINT = 0.22  # of the water's colour and the goal's
_EDGE = 0.45  # [-]; of the picture's sides from its middle, where an arrow points to a goal beyond it
_ARROW = 0.06  # [-]; its length, of the picture's width


_SKY = 0.4
"""Share of the view from the side that is above a robot which floats high above the ground [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What a picture shows beside the robot."""

    up: Float[np.ndarray, "3"]
    """Unit vector against gravity."""
    goal: AnyGoal | None = None
    """What the goal is; None where there is none."""
    place: Float[np.ndarray, "2"] | None = None
    """Where it is, forward and left in the world [m]."""


def picture(robot: Robot, record: xr.Dataset, text: str, around: Surroundings) -> UInt8[np.ndarray, "height width 3"]:
    """Return a robot from above and from its right side, with its centre of mass, as red, green and blue.

    Water is blue, its surface a line; the goal is a ring, or a line where it is land, and an arrow at the edge of the
    picture points to one that is beyond it. The view from the side rises with a robot that floats far above the ground.

    Args:
        robot: whose record it is.
        record: of one run, one sample.
        text: what is written above.
        around: gravity and the goal.
    """
    with styled(font__size=9, axes__titlesize=10, xtick__labelsize=8, ytick__labelsize=8, axes__labelsize=9):
        figure = new(width=WIDTH / _DPI, height=HEIGHT / _DPI)
        figure.set_dpi(_DPI)
        figure.set_layout_engine("none")  # finding a layout would take three quarters of the time
        above, side = (figure.add_axes(place) for place in _PLACES)
        above.tick_params(labelbottom=False)
        draw_posture(above, robot, record, 0.0)
        draw_posture(side, robot, record, 0.0, view="side")
        x, y, z = record.centre_of_mass.values[0].tolist()
        span, wide, below, tall = (beside_article(robot).length * part for part in (_SPAN, _WIDE, _BELOW, _TALL))
        low = max(-below, z - (1 - _SKY) * (tall + below))
        above.set(xlim=(x - span / 2, x + span / 2), ylim=(y - wide / 2, y + wide / 2), ylabel="left [m]", title=text)
        side.set(
            xlim=(x - span / 2, x + span / 2), ylim=(low, low + tall + below), xlabel="forward [m]", ylabel="up [m]"
        )
        if "water_level" in record:
            draw_water(above, side, float(record.water_level[0]), around.up, y)
        if around.goal is not None and around.place is not None:
            _draw_goal(above, side, around.goal, around.place)
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()
    return np.array(canvas.buffer_rgba())[..., :3]


def draw_water(above: Axes, side: Axes, level: float, up: Float[np.ndarray, "3"], left: float) -> None:
    """Draw the water of a lake as far as two views reach, its surface as a line.

    Args:
        above: view from above; water is where there is some over the ground.
        side: view from the side.
        level: of the surface above the world's origin, against gravity [m].
        up: unit vector against gravity.
        left: where the view from the side cuts the water [m].
    """
    x, y = np.array(above.get_xlim()), np.array(above.get_ylim())
    depth = level - up[0] * x[None, :] - up[1] * y[:, None]
    if (depth > 0.0).any():
        above.contourf(x, y, depth, levels=[0.0, max(depth.max(), 1e-9)], colors=[COLOURS["water"]], alpha=_TINT)
    line = [(level - up[1] * left) / up[0]] if up[0] else []  # where the surface meets the ground
    ends = np.sort([*x, *(shore for shore in line if x[0] < shore < x[1])])
    for pair in pairwise(ends):
        heights = (level - up[0] * np.array(pair) - up[1] * left) / up[2]
        if heights.mean() > 0.0:
            side.fill_between(pair, 0.0, heights, color=COLOURS["water"], alpha=_TINT, linewidth=0, zorder=0.1)
            side.plot(pair, heights, color=COLOURS["water"], linewidth=1.2, zorder=0.2)


def _draw_goal(above: Axes, side: Axes, goal: AnyGoal, place: Float[np.ndarray, "2"]) -> None:
    (left, right), (low, high) = above.get_xlim(), above.get_ylim()
    colour = COLOURS["limbs_only"]
    if isinstance(goal, Landing):
        for ax in (above, side):
            ax.axvline(float(place[0]), color=colour, linestyle=(0, (4, 2)))
    else:
        above.add_patch(Circle((float(place[0]), float(place[1])), goal.within, facecolor="none", edgecolor=colour))
        side.axvspan(
            float(place[0]) - goal.within, float(place[0]) + goal.within, color=colour, alpha=_TINT, linewidth=0
        )
    centre = np.array([left + right, low + high]) / 2
    towards = place - centre if not isinstance(goal, Landing) else np.array([place[0] - centre[0], 0.0])
    beyond = float((np.abs(towards) / (_EDGE * np.array([right - left, high - low]))).max())
    if beyond > 1.0:
        head = centre + towards / beyond
        tail = head - _ARROW * (right - left) * towards / np.hypot(*towards)
        above.annotate("", tuple(head), tuple(tail), arrowprops={"arrowstyle": "-|>", "color": colour}, zorder=9)
