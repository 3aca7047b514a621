"""The plan of any body, for its dimension drawing: the shapes of its axis, its limbs, its joints."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Ellipse, FancyBboxPatch

from suchus.design import Layout, LimbPlace, Robot, Rod, layout
from suchus.figures.style import COLOURS
from suchus.skin import bone_rest
from suchus.skin.plain import ends

_BODY, _LIMB = "#C9DCCB", "#4D6B57"
_EDGE: dict[str, Any] = {"edgecolor": _LIMB, "linewidth": 1.2}


def draw_plan(ax: Axes, robot: Robot, *, from_the_side: bool) -> None:
    """Draw a body with all joints at zero, from above, or from the side with its limbs hanging down.

    Args:
        ax: to draw on.
        robot: the design.
        from_the_side: the view.
    """
    place, rest = layout(robot), bone_rest(robot)
    for limb in place.limbs:
        if not from_the_side or limb.side < 0:
            _limb(ax, place, limb, rest, hanging=from_the_side)
    segments = {segment.name: segment for segment in place.robot.axis}
    for body, at in zip(place.bodies, rest, strict=True):
        for shape in segments[body.name].shapes if body.name in segments else ():
            x = at[0] + body.shift
            if isinstance(shape, Rod):
                low, high = sorted((shape.start[0] + x, shape.end[0] + x))
                r = shape.radius
                style = f"round,pad=0,rounding_size={0.9 * r}"
                ax.add_patch(FancyBboxPatch((low - r, -r), high - low + 2 * r, 2 * r, style, facecolor=_BODY, **_EDGE))
            else:
                half = shape.half[2 if from_the_side else 1]
                ax.add_patch(Ellipse((shape.at[0] + x, 0.0), 2 * shape.half[0], 2 * half, facecolor=_BODY, **_EDGE))
        if body.hinges and body.name in segments:
            _joint(ax, at[0], 0.0)
    deepest = min(ax.dataLim.y0, -0.1 * robot.length)
    front, back = ends(place)
    _measure(ax, back, front, deepest - 0.05 * robot.length)
    ax.autoscale_view()


def _limb(ax: Axes, place: Layout, limb: LimbPlace, rest: np.ndarray, *, hanging: bool) -> None:
    links = limb.girdle.limb.links
    first = limb.tip - len(links) + 1
    at = rest[first]
    points = [(at[0], 0.0 if hanging else at[1])]
    for link in links:
        x, y = points[-1]
        points.append((x + link.end[0], y - link.length) if hanging else (x + link.end[0], y + limb.side * link.end[1]))
    line = np.array(points)
    ax.plot(*line.T, color=_LIMB, linewidth=4, solid_capstyle="round", zorder=0.5)
    radius = limb.girdle.limb.foot.radius
    ax.add_patch(Circle(tuple(line[-1]), radius, facecolor=COLOURS["neutral"], zorder=2, **_EDGE))
    for (x, y), body in zip(points, place.bodies[first : limb.tip + 1], strict=False):
        if body.hinges:
            _joint(ax, x, y)


def _joint(ax: Axes, x: float, y: float) -> None:
    ax.plot([x], [y], "o", markersize=5, markerfacecolor="white", markeredgecolor=_LIMB, markeredgewidth=1.2, zorder=3)


def _measure(ax: Axes, start: float, end: float, y: float) -> None:
    arrow = {"arrowstyle": "<->", "color": "#555555", "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (start, y), (end, y), arrowprops=arrow, annotation_clip=False)
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
    ax.text((start + end) / 2, y, f"{1000 * (end - start):.0f}", ha="center", va="center", fontsize=11, bbox=box)
