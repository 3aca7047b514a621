"""Legs and feet. At zero posture a leg points straight out to the side; its foot is made for a shank that stands."""

from itertools import pairwise

import numpy as np

from suchus.robot.design import Robot
from suchus.robot.design.measures import LegMeasures
from suchus.visual.skin.mesh import Mesh, curve, ellipsoid, loft, ring, spike
from suchus.visual.skin.paint import CLAW, SOLE, mixed, shaded, smooth

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
    ahead = robot.spine.length + robot.thorax.shoulder if front else 0.0
    return [_limb(robot, leg, front, ahead), *_foot(leg, front, ahead)]


def _limb(robot: Robot, leg: LegMeasures, front: bool, ahead: float) -> Mesh:
    r, hip, knee = leg.radius, leg.hip_offset, leg.hip_offset + leg.femur
    end = knee + leg.tibia
    girdle = robot.thorax if front else robot.pelvis
    root = 0.45 * min(hip, girdle.width / 2)
    deep = 0.62 * girdle.height / 2
    stout = 1.0 if front else 1.18
    along = [root, 0.5 * (root + hip), hip, hip + 0.25 * leg.femur, hip + 0.6 * leg.femur, knee - 0.15 * leg.femur,
             knee, knee + 0.15 * leg.tibia, knee + 0.35 * leg.tibia, knee + 0.72 * leg.tibia, end - 0.1 * leg.tibia,
             end + 0.15 * leg.foot_radius]  # fmt: skip
    long = [2.5, 2.4, 2.1, 1.95, 1.72, 1.42, 1.36, 1.46, 1.5, 1.12, 1.0, 1.0]  # forward, over the bone's radius
    tall = [deep / r, deep / r, 1.9, 1.72, 1.5, 1.3, 1.26, 1.34, 1.36, 1.04, 0.95, 0.95]
    scale = [(stout if i < 10 else 1.0) * r for i in range(12)]
    knots = sorted(zip(along, long, tall, scale, strict=True))
    kept = [knots[0]] + [b for a, b in pairwise(knots) if b[0] > a[0] + 1e-6]
    width = curve([(a, b * k) for a, b, _, k in kept])
    height = curve([(a, b * k) for a, _, b, k in kept])
    y = np.linspace(kept[0][0], kept[-1][0], 34)
    c, s = ring(LEG_AROUND, 2.1)
    points = np.stack(
        [ahead + width(y)[:, None] * s, np.broadcast_to(y[:, None], (34, LEG_AROUND)), height(y)[:, None] * c], axis=-1
    )
    mesh = loft(points)
    level = np.concatenate([np.broadcast_to(c, (34, LEG_AROUND)).ravel(), [0.0, 0.0]])
    length = robot.length

    def paint(points: np.ndarray) -> np.ndarray:
        colour = shaded(0.75 * level + 0.15, points[:, 0] / length + 0.6 * points[:, 1] / length, points[:, 1] / length)
        return mixed(colour, SOLE, 0.5 * smooth(points[:, 1], knee + 0.6 * leg.tibia, end))

    return mesh.painted(paint)


def _foot(leg: LegMeasures, front: bool, ahead: float) -> list[Mesh]:
    """Return palm, toes and claws; the sole faces along the shank."""
    r = leg.foot_radius
    sole = leg.hip_offset + leg.femur + leg.tibia + r
    size = 1.0 if front else 1.12
    palm = ellipsoid(
        (ahead + 0.35 * r, sole - 0.62 * r, 0.0), (1.35 * size * r, 0.62 * r, 1.12 * r), around=12, rings=8
    )
    found = [palm.painted(SOLE)]
    spread = np.radians([-38.0, -12.0, 13.0, 38.0, 66.0] if front else [-26.0, -2.0, 22.0, 46.0])
    for i, angle in enumerate(spread):
        reach = (1.35 if i in (1, 2) else 1.15) * size * r
        found += _toe(np.array([ahead + 0.75 * r, sole - 0.36 * r, 0.0]), float(angle), reach + 0.9 * r, 0.36 * r)
    return found


def _toe(root: np.ndarray, angle: float, reach: float, radius: float) -> list[Mesh]:
    ahead = np.array([np.cos(angle), 0.0, np.sin(angle)])
    aside = np.array([-np.sin(angle), 0.0, np.cos(angle)])
    out = np.array([0.0, 1.0, 0.0])
    c, s = ring(8)
    share = np.array([0.0, 0.35, 0.7, 0.9, 0.99])
    thick = radius * np.array([1.0, 0.95, 0.8, 0.68, 0.35])
    drop = np.array([0.0, 0.0, 0.15, 0.25, 0.3]) * radius  # toes slope down to their tips
    rings = (
        root
        + (reach * share)[:, None, None] * ahead
        + thick[:, None, None] * (c[:, None] * aside + s[:, None] * -out)[None]
        + drop[:, None, None] * out
    )
    tip = root + 0.9 * reach * ahead
    c, s = ring(4)
    base = tip + 0.42 * radius * (c[:, None] * aside - s[:, None] * out)
    claw = spike(base, tip + (0.1 * reach + 1.7 * radius) * ahead + 0.55 * radius * out)
    return [loft(rings).painted(SOLE), claw.painted(CLAW)]
