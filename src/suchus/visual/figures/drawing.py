"""The dimension drawing of a robot: seen from above and from the side, standing with its knees bent."""

from math import cos, radians, sin
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Ellipse, FancyBboxPatch, Polygon

from suchus.robot.design import MEASURED, Layout, LimbPlace, Robot, Rod, behind_hips, lacking, layout
from suchus.robot.design.measures import LegMeasures
from suchus.visual.figures.style import COLOURS, captioned, panels, styled
from suchus.visual.skin import bone_rest
from suchus.visual.skin.plain import ends

_TILT = radians(20)  # outward tilt of the shank, in the drawing only
_BODY, _FIN, _LIMB = "#C9DCCB", "#E4EEE5", "#4D6B57"
_EDGE: dict[str, Any] = {"edgecolor": _LIMB, "linewidth": 1.2}
_TITLE = 0.45  # height of a view's title with the space around it [inch]
_MAX_ASPECT = 1.3  # greatest height of the drawing over its width [-]


def dimension_drawing(robot: Robot) -> Figure:
    """Return a robot from above and from the side with its main dimensions [mm]."""
    measured = not lacking(robot, MEASURED)
    with styled(axes__grid=False):
        figure, axes = panels(2, 1, sharex=True)
        if measured:
            _draw_top_view(axes[0, 0], robot)
            _draw_side_view(axes[1, 0], robot)
        else:
            for ax, is_side in zip(axes[:, 0], (False, True), strict=True):
                _plan(ax, robot, from_the_side=is_side)
        for ax, title in zip(axes[:, 0], ("from above", "from the side"), strict=True):
            ax.set_aspect("equal")
            ax.set_axis_off()
            ax.set_title(title, color=COLOURS["neutral"])
        _to_one_scale(figure, axes[:, 0])
    tail = "" if lacking(robot, ("limbs", "tail_yaw")) else f"{_mm(behind_hips(robot))} mm of it tail, "
    return captioned(
        figure,
        f"The robot {robot.name} from above and from the side: {_mm(robot.length)} mm long, "
        f"{tail}{robot.mass:.3g} kg, {len(layout(robot).servos)} servos. "
        f"Circles are joints{'; the pale end of the tail is passive' if measured else ''}. Dimensions in mm.",
    )


def _to_one_scale(figure: Figure, views: np.ndarray) -> None:
    """Let views that share their x axis have room for as much as each shows, so that all have one scale."""
    heights = [float(np.ptp(ax.get_ylim())) for ax in views]
    views[0].get_gridspec().set_height_ratios(heights)
    width = figure.get_figwidth()
    height = len(views) * _TITLE + width * sum(heights) / float(np.ptp(views[0].get_xlim()))
    figure.set_figheight(min(height, _MAX_ASPECT * width))


def _plan(ax: Axes, robot: Robot, *, from_the_side: bool) -> None:
    """Draw the shapes of any body with all joints at zero, from above, or from the side with its limbs hanging down."""
    robot_layout, origins = layout(robot), bone_rest(robot)
    for limb in robot_layout.limbs:
        if not from_the_side or limb.side < 0:
            _chain(ax, robot_layout, limb, origins, hanging=from_the_side)
    segments = {segment.name: segment for segment in robot_layout.robot.axis}
    for body, origin in zip(robot_layout.bodies, origins, strict=True):
        for shape in segments[body.name].shapes if body.name in segments else ():
            x = origin[0] + body.shift
            if isinstance(shape, Rod):
                x_start, x_end = sorted((shape.start[0] + x, shape.end[0] + x))
                r = shape.radius
                style = f"round,pad=0,rounding_size={0.9 * r}"
                ax.add_patch(
                    FancyBboxPatch((x_start - r, -r), x_end - x_start + 2 * r, 2 * r, style, facecolor=_BODY, **_EDGE)
                )
            else:
                half = shape.half[2 if from_the_side else 1]
                ax.add_patch(Ellipse((shape.at[0] + x, 0.0), 2 * shape.half[0], 2 * half, facecolor=_BODY, **_EDGE))
        if body.hinges and body.name in segments:
            _joint(ax, origin[0], 0.0)
    front, back = ends(robot_layout)
    _measure(ax, back, front, ax.dataLim.y0 - 0.05 * robot.length)


def _chain(ax: Axes, robot_layout: Layout, limb: LimbPlace, origins: np.ndarray, *, hanging: bool) -> None:
    """Draw the links, joints and foot of a limb, seen from above or hanging down."""
    links = limb.girdle.limb.links
    first_body = limb.tip - len(links) + 1
    origin = origins[first_body]
    points = [(origin[0], 0.0 if hanging else origin[1])]
    for link in links:
        x, y = points[-1]
        points.append((x + link.end[0], y - link.length) if hanging else (x + link.end[0], y + limb.side * link.end[1]))
    line = np.array(points)
    ax.plot(*line.T, color=_LIMB, linewidth=4, solid_capstyle="round", zorder=0.5)
    radius = limb.girdle.limb.foot.radius
    ax.add_patch(Circle(tuple(line[-1]), radius, facecolor=COLOURS["neutral"], zorder=2, **_EDGE))
    for (x, y), body in zip(points, robot_layout.bodies[first_body : limb.tip + 1], strict=False):
        if body.hinges:
            _joint(ax, x, y)


def _draw_top_view(ax: Axes, robot: Robot) -> None:
    """Draw the article's robot from above with its length and the distance of its girdles."""
    front = robot.spine.length + robot.thorax.shoulder
    for x, leg in ((0.0, robot.hind_leg), (front, robot.front_leg)):
        for side in (1, -1):
            _leg(ax, x, leg, side)
    _tail(ax, robot, 0.0, 0.0)
    width = robot.spine.radius
    _box(ax, 0.0, robot.spine.length, width)
    _box(ax, -robot.tail.offset, robot.pelvis.length / 2, robot.pelvis.width / 2)
    _head(ax, robot, robot.head.width / 2, 0.0)
    _box(ax, robot.spine.length, front + 0.02, robot.thorax.width / 2)
    for i in range(robot.spine.joints):
        _joint(ax, robot.spine.base + i * robot.spine.link, 0.0)
    lateral_extent = -max(
        leg.hip_offset + leg.femur + leg.tibia * sin(_TILT) for leg in (robot.hind_leg, robot.front_leg)
    )
    nose = robot.spine.length + robot.head.snout
    _measure(ax, -robot.tail.length, nose, lateral_extent - 0.03)
    _measure(ax, 0.0, front, -lateral_extent + 0.025)


def _draw_side_view(ax: Axes, robot: Robot) -> None:
    """Draw the article's robot from the side, standing, with the lengths of tail, trunk and head."""
    height = _stance(robot.hind_leg)
    front = robot.spine.length + robot.thorax.shoulder
    nose = robot.spine.length + robot.head.snout
    ax.axhline(0.0, color=COLOURS["ground"], linewidth=1.2)
    _tail(ax, robot, height, robot.tail.radius_tip)
    _box(ax, 0.0, robot.spine.length, robot.spine.radius, height)
    _box(ax, -robot.tail.offset, robot.pelvis.length / 2, robot.pelvis.height / 2, height)
    _head(ax, robot, robot.head.height / 2, height)
    _box(ax, robot.spine.length, front + 0.02, robot.thorax.height / 2, height)
    for x, leg in ((0.0, robot.hind_leg), (front, robot.front_leg)):
        foot = leg.foot_radius
        ax.plot([x, x], [height, foot], color=_LIMB, linewidth=5, solid_capstyle="round")
        ax.add_patch(Circle((x, foot), foot, facecolor=COLOURS["neutral"], **_EDGE))
        _joint(ax, x, height)
    _measure(ax, -robot.tail.length, 0.0, -0.045)
    _measure(ax, 0.0, front, -0.045)
    _measure(ax, front, nose, -0.045)


def _stance(leg: LegMeasures) -> float:
    return leg.tibia * cos(_TILT) + leg.foot_radius


def _leg(ax: Axes, x: float, leg: LegMeasures, side: int) -> None:
    """Draw a leg from above, to the left (side 1) or to the right (side -1)."""
    knee = leg.hip_offset + leg.femur
    foot = knee + leg.tibia * sin(_TILT)
    ax.plot([x, x], [0.0, side * foot], color=_LIMB, linewidth=5, solid_capstyle="round", zorder=0.5)
    ax.add_patch(Circle((x, side * foot), leg.foot_radius, facecolor=COLOURS["neutral"], zorder=2, **_EDGE))
    for y in (leg.hip_offset, knee):
        _joint(ax, x, side * y)


def _tail(ax: Axes, robot: Robot, height: float, tip_height: float) -> None:
    """Draw the tail: its driven part, a line for each joint, and the passive end in a paler tint.

    Args:
        ax: axes to draw on.
        robot: robot whose tail is meant.
        height: height of the tail's root [m].
        tip_height: height of its tip [m].
    """
    tail = robot.tail
    total = tail.length - tail.offset

    def section(distance: float) -> tuple[float, float, float]:
        fraction = distance / total
        radius = tail.radius_root + (tail.radius_tip - tail.radius_root) * fraction
        return -tail.offset - distance, height + (tip_height - height) * fraction, radius

    driven_length = tail.root + tail.joints * tail.pitch
    for start, end, colour in ((0.0, driven_length, _BODY), (driven_length, total, _FIN)):
        (x0, y0, r0), (x1, y1, r1) = section(start), section(end)
        ax.add_patch(Polygon([(x0, y0 + r0), (x1, y1 + r1), (x1, y1 - r1), (x0, y0 - r0)], facecolor=colour, **_EDGE))
    for i in range(tail.joints):
        x, y, radius = section(tail.root + i * tail.pitch)
        ax.plot([x, x], [y - radius, y + radius], color=_LIMB, linewidth=1.0)
    _joint(ax, -tail.offset, height)


def _box(ax: Axes, start: float, end: float, half_height: float, height: float = 0.0) -> None:
    corners = [
        (start, height - half_height),
        (end, height - half_height),
        (end, height + half_height),
        (start, height + half_height),
    ]
    ax.add_patch(Polygon(corners, facecolor=_BODY, joinstyle="round", **_EDGE))


def _head(ax: Axes, robot: Robot, half_height: float, height: float) -> None:
    """Draw the head as a polygon that narrows to the snout."""
    start = robot.spine.length + robot.thorax.shoulder
    end = robot.spine.length + robot.head.snout
    jaw = start + 0.35 * (end - start)
    outline = [
        (start, half_height * 0.8),
        (jaw, half_height),
        (end, half_height * 0.35),
        (end, -half_height * 0.35),
        (jaw, -half_height),
        (start, -half_height * 0.8),
    ]
    ax.add_patch(Polygon([(x, y + height) for x, y in outline], facecolor=_BODY, joinstyle="round", **_EDGE))


def _joint(ax: Axes, x: float, y: float) -> None:
    ax.plot(
        [x], [y], "o", markersize=5.5, markerfacecolor="white", markeredgecolor=_LIMB, markeredgewidth=1.3, zorder=3
    )


def _measure(ax: Axes, start: float, end: float, y: float) -> None:
    """Draw a dimension arrow at height y with its length in millimetres."""
    arrow = {"arrowstyle": "<->", "color": "#555555", "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (start, y), (end, y), arrowprops=arrow, annotation_clip=False)
    ax.update_datalim([(start, y), (end, y)])
    ax.autoscale_view()
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
    ax.text((start + end) / 2, y, _mm(end - start), ha="center", va="center", fontsize=11, bbox=box)


def _mm(length: float) -> str:
    return f"{1000 * length:.0f}"
