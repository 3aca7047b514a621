"""Legs and feet. At zero posture a leg points straight out to the side; its foot is made for a shank that stands."""

from itertools import pairwise

import numpy as np

from suchus.robot.design import Robot
from suchus.robot.design.measures import LegMeasures
from suchus.visual.skin.mesh import Mesh, curve, ellipsoid, loft, ring, spike
from suchus.visual.skin.paint import CLAW, SOLE, hide_colours, mix_colours, smooth

LEG_AROUND = 16
"""Points around a leg, a multiple of four [-]."""


def left_leg(robot: Robot, girdle: str) -> list[Mesh]:
    """Return the left leg of a girdle, its foot and claws.

    Args:
        robot: the robot.
        girdle: ``F`` front or ``H`` hind.
    """
    front = girdle == "F"
    leg = robot.front_leg if front else robot.hind_leg
    x_offset = robot.spine.length + robot.thorax.shoulder if front else 0.0
    return [_limb(robot, leg, front, x_offset), *_foot(leg, front, x_offset)]


def _limb(robot: Robot, leg: LegMeasures, front: bool, x_offset: float) -> Mesh:
    """Return upper and lower leg as one surface.

    Args:
        robot: the robot.
        leg: lengths and radii of the leg.
        front: whether it is a front leg.
        x_offset: where the leg is attached, ahead of the root [m].
    """
    r, hip, knee = leg.radius, leg.hip_offset, leg.hip_offset + leg.femur
    end = knee + leg.tibia
    girdle = robot.thorax if front else robot.pelvis
    root = 0.45 * min(hip, girdle.width / 2)
    depth = 0.62 * girdle.height / 2
    stout = 1.0 if front else 1.18
    positions = [root, 0.5 * (root + hip), hip, hip + 0.25 * leg.femur, hip + 0.6 * leg.femur, knee - 0.15 * leg.femur,
             knee, knee + 0.15 * leg.tibia, knee + 0.35 * leg.tibia, knee + 0.72 * leg.tibia, end - 0.1 * leg.tibia,
             end + 0.15 * leg.foot_radius]  # fmt: skip
    widths = [
        2.5,
        2.4,
        2.1,
        1.95,
        1.72,
        1.42,
        1.36,
        1.46,
        1.5,
        1.12,
        1.0,
        1.0,
    ]  # half widths along x, over the bone's radius
    heights = [depth / r, depth / r, 1.9, 1.72, 1.5, 1.3, 1.26, 1.34, 1.36, 1.04, 0.95, 0.95]
    scale = [(stout if i < 10 else 1.0) * r for i in range(12)]
    knots = sorted(zip(positions, widths, heights, scale, strict=True))
    distinct_knots = [knots[0]] + [b for a, b in pairwise(knots) if b[0] > a[0] + 1e-6]
    width = curve([(a, b * k) for a, b, _, k in distinct_knots])
    height = curve([(a, b * k) for a, _, b, k in distinct_knots])
    y = np.linspace(distinct_knots[0][0], distinct_knots[-1][0], 34)
    c, s = ring(LEG_AROUND, 2.1)
    points = np.stack(
        [x_offset + width(y)[:, None] * s, np.broadcast_to(y[:, None], (34, LEG_AROUND)), height(y)[:, None] * c],
        axis=-1,
    )
    mesh = loft(points)
    level = np.concatenate([np.broadcast_to(c, (34, LEG_AROUND)).ravel(), [0.0, 0.0]])
    length = robot.length

    def paint(points: np.ndarray) -> np.ndarray:
        colour = hide_colours(
            0.75 * level + 0.15, points[:, 0] / length + 0.6 * points[:, 1] / length, points[:, 1] / length
        )
        return mix_colours(colour, SOLE, 0.5 * smooth(points[:, 1], knee + 0.6 * leg.tibia, end))

    return mesh.painted(paint)


def _foot(leg: LegMeasures, front: bool, x_offset: float) -> list[Mesh]:
    """Return palm, toes and claws; the sole faces along the shank."""
    r = leg.foot_radius
    sole = leg.hip_offset + leg.femur + leg.tibia + r
    size = 1.0 if front else 1.12
    palm = ellipsoid(
        (x_offset + 0.35 * r, sole - 0.62 * r, 0.0), (1.35 * size * r, 0.62 * r, 1.12 * r), point_count=12, rings=8
    )
    meshes = [palm.painted(SOLE)]
    toe_angles = np.radians([-38.0, -12.0, 13.0, 38.0, 66.0] if front else [-26.0, -2.0, 22.0, 46.0])
    for i, angle in enumerate(toe_angles):
        reach = (1.35 if i in (1, 2) else 1.15) * size * r
        meshes += _toe(np.array([x_offset + 0.75 * r, sole - 0.36 * r, 0.0]), float(angle), reach + 0.9 * r, 0.36 * r)
    return meshes


def _toe(root: np.ndarray, angle: float, reach: float, radius: float) -> list[Mesh]:
    """Return a toe and its claw.

    Args:
        root: where the toe begins, (3,) [m].
        angle: angle from the foot's forward axis, positive to the outside of a standing foot [rad].
        reach: length of the toe [m].
        radius: radius at its root [m].
    """
    forward = np.array([np.cos(angle), 0.0, np.sin(angle)])
    lateral = np.array([-np.sin(angle), 0.0, np.cos(angle)])
    outward = np.array([0.0, 1.0, 0.0])
    c, s = ring(8)
    fractions = np.array([0.0, 0.35, 0.7, 0.9, 0.99])
    radii = radius * np.array([1.0, 0.95, 0.8, 0.68, 0.35])
    drop = np.array([0.0, 0.0, 0.15, 0.25, 0.3]) * radius  # toes slope down to their tips
    rings = (
        root
        + (reach * fractions)[:, None, None] * forward
        + radii[:, None, None] * (c[:, None] * lateral + s[:, None] * -outward)[None]
        + drop[:, None, None] * outward
    )
    tip = root + 0.9 * reach * forward
    c, s = ring(4)
    base = tip + 0.42 * radius * (c[:, None] * lateral - s[:, None] * outward)
    claw = spike(base, tip + (0.1 * reach + 1.7 * radius) * forward + 0.55 * radius * outward)
    return [loft(rings).painted(SOLE), claw.painted(CLAW)]
