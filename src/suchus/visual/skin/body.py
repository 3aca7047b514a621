"""Snout to tail tip: the shape of head, neck, trunk and tail."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from suchus.robot.design import Robot
from suchus.visual.skin.head import Knot, head_knots
from suchus.visual.skin.look import Proportions
from suchus.visual.skin.mesh import Mesh, curve, loft, ring
from suchus.visual.skin.paint import hide


@dataclass(frozen=True, slots=True)
class BodyShape:
    """Half width, height above and depth below the axis at a place x of the straight body [m]."""

    back: float
    """x of the tail's tip [m]."""
    front: float
    """x of the snout's tip [m]."""
    width: Callable[[np.ndarray], np.ndarray]
    """Half width over x."""
    top: Callable[[np.ndarray], np.ndarray]
    """Height above the axis over x."""
    bottom: Callable[[np.ndarray], np.ndarray]
    """Depth below the axis over x."""


def shape(robot: Robot, proportions: Proportions) -> BodyShape:
    """Return the outline of a robot's body; on the head it is that of the skull without the lower jaw."""
    knots = [*_tail_knots(robot, proportions), *_trunk_knots(robot, proportions), *head_knots(robot, proportions)]
    knots = [knot for i, knot in enumerate(knots) if i == 0 or knot[0] > max(k[0] for k in knots[:i]) + 1e-6]
    x = [knot[0] for knot in knots]
    width, top, bottom = (curve([(knot[0], knot[i]) for knot in knots]) for i in (1, 2, 3))
    return BodyShape(x[0], x[-1], width, top, bottom)


def _tail_knots(robot: Robot, proportions: Proportions) -> list[Knot]:
    """Return (x, half width, top, bottom) from the tip to the root; it encloses the segments beneath."""
    tail = robot.tail
    tip = -tail.length
    lengths, radii = tail.lengths, tail.radii
    starts = -tail.offset - np.cumsum([0.0, *lengths[:-1]])
    tail_radius = curve(sorted((float(x), float(r)) for x, r in zip(starts, radii, strict=True)))
    height_factor = curve(
        [(0.0, proportions.fin), (0.12, proportions.fin), (0.45, 1.6), (0.8, 1.15), (1.0, proportions.margin)]
    )
    width_factor = curve([(0.0, 1.0), (0.5, proportions.margin), (0.85, 1.15), (1.0, 1.3)])
    knots = []
    for fraction in (0.0, 0.004, 0.015, 0.05, 0.12, 0.25, 0.4, 0.55, 0.7, 0.82, 0.9, 0.96):
        x = tip + fraction * (-tail.offset - tip)
        r = float(tail_radius(np.array(x))) * proportions.margin
        point = min(1.0, float(np.sqrt(fraction / 0.12)) + 0.02)
        knots.append(
            (
                x,
                r * point * float(width_factor(np.array(fraction))),
                r * point * float(height_factor(np.array(fraction))),
                r * point,
            )
        )
    return knots


def _trunk_knots(robot: Robot, proportions: Proportions) -> list[Knot]:
    """Return (x, half width, top, bottom) of the trunk from the pelvis to the shoulders [m]."""
    pelvis, thorax, spine, tail = robot.pelvis, robot.thorax, robot.spine, robot.tail
    m = proportions.margin
    radius = m * spine.radius
    flank = max(proportions.flank * (pelvis.width + thorax.width) / 4, radius)
    mean = max((pelvis.height + thorax.height) / 4 * m, radius)
    rump = max(0.62 * pelvis.width / 2, 1.25 * m * tail.radius_root)
    half = pelvis.length / 2
    chest = spine.length + thorax.shoulder
    return [
        (-max(half, tail.offset), rump, max(0.9 * pelvis.height / 2, m * tail.radius_root), m * tail.radius_root),
        (-0.45 * half, 0.98 * m * pelvis.width / 2, m * pelvis.height / 2, 0.97 * m * pelvis.height / 2),
        (0.3 * half, 1.02 * m * pelvis.width / 2, m * pelvis.height / 2, m * pelvis.height / 2),
        (0.30 * spine.length, flank, 1.02 * mean, 1.0 * mean),
        (0.55 * spine.length, 1.04 * flank, 1.03 * mean, 1.08 * mean),
        (0.82 * spine.length, flank, mean, mean),
        (chest - 0.7 * thorax.shoulder, m * thorax.width / 2, m * thorax.height / 2, m * thorax.height / 2),
        (chest - 0.25 * thorax.shoulder, 1.02 * m * thorax.width / 2, m * thorax.height / 2, m * thorax.height / 2),
    ]


def body(robot: Robot, proportions: Proportions) -> Mesh:
    """Return snout to tail tip in one piece, without the lower jaw."""
    outline = shape(robot, proportions)
    length = outline.front - outline.back
    count = int(np.clip(length / (proportions.step * max(length, 1.0)), 40, 400))
    # finer at both ends, where it closes, and on the head, where there is more to see
    uniform = np.linspace(0.0, 1.0, count)
    x = outline.back + length * curve([(0.0, 0.0), (0.02, 0.006), (0.72, 0.78), (0.985, 0.997), (1.0, 1.0)])(uniform)
    c, s = ring(proportions.ring_points, proportions.roundness)
    y = outline.width(x)[:, None] * c
    z = np.where(s >= 0, outline.top(x)[:, None] * s, outline.bottom(x)[:, None] * s)
    mesh = loft(np.stack([np.broadcast_to(x[:, None], y.shape), y, z], axis=-1))
    level = np.concatenate([np.broadcast_to(s, y.shape).ravel(), [0.0, 0.0]])
    return mesh.painted(hide(level, length))
