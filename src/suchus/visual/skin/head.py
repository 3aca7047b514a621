"""Head and jaws, eyes and teeth."""

from typing import NamedTuple

import numpy as np

from suchus.robot.design import Robot
from suchus.visual.skin.look import Proportions
from suchus.visual.skin.mesh import Mesh, curve, ellipsoid, loft, ring, spike
from suchus.visual.skin.paint import EYE, PUPIL, TOOTH, brow, jaw_paint

JAW_AROUND = 20
"""Points around the lower jaw [-]."""
Knot = tuple[float, float, float, float]
"""x, half width, height above the axis, depth below it [m]."""

# from the jaw joint (0) to the tip of the snout (1): half width, top, line of the mouth, over half the head's size
_SKULL = (
    (0.10, 1.03, 1.10, 0.24),
    (0.20, 0.99, 1.08, 0.16),
    (0.30, 0.86, 1.00, 0.20),
    (0.40, 0.70, 0.76, 0.26),
    (0.55, 0.56, 0.56, 0.18),
    (0.70, 0.50, 0.47, 0.24),
    (0.82, 0.49, 0.44, 0.22),
    (0.90, 0.47, 0.47, 0.20),
    (0.955, 0.43, 0.46, 0.19),
    (0.985, 0.31, 0.36, 0.15),
    (0.996, 0.17, 0.22, 0.09),
    (1.0, 0.03, 0.04, 0.02),
)
_NECK = ((-0.85, 0.98, 1.20, 1.25), (-0.40, 0.88, 1.06, 1.10), (0.0, 0.98, 1.08, 0.90))
_JAW_WIDTH = curve(
    [(-0.06, 0.55), (0.0, 0.86), (0.12, 0.95), (0.25, 0.84), (0.4, 0.65), (0.6, 0.49), (0.85, 0.42),
     (0.95, 0.35), (0.975, 0.22), (0.988, 0.04)]
)  # fmt: skip
_JAW_TOP = curve([(-0.06, 0.3), (0.1, 0.24), (0.2, 0.16), (0.4, 0.26), (0.55, 0.18), (0.7, 0.24), (0.988, 0.22)])
_JAW_DEPTH = curve(
    [(-0.06, 0.75), (0.05, 1.05), (0.2, 0.98), (0.45, 0.66), (0.7, 0.54), (0.9, 0.5), (0.96, 0.44), (0.988, 0.26)]
)
_SKULL_WIDTH, _MOUTH = (curve([(row[0], row[i]) for row in (_NECK[-1], *_SKULL)]) for i in (1, 3))


class Frame(NamedTuple):
    """Frame and units in which the head is measured."""

    joint: float
    """x of the jaw joint [m]."""
    snout_distance: float
    """Distance from there to the tip of the snout [m]."""
    neck: float
    """Distance from the shoulders to the jaw joint [m]."""
    w: float
    """Half width [m]."""
    h: float
    """Half height [m]."""


def frame(robot: Robot, proportions: Proportions) -> Frame:
    """Return where the head is and how large."""
    length, start = robot.head.snout - robot.thorax.shoulder, robot.spine.length + robot.thorax.shoulder
    neck = proportions.skull * length
    return Frame(start + neck, length - neck, neck, robot.head.width / 2, robot.head.height / 2)


def head_knots(robot: Robot, proportions: Proportions) -> list[Knot]:
    """Return the outline from shoulders to snout, without the lower jaw."""
    f = frame(robot, proportions)
    rows = [(u * f.neck, *sizes) for u, *sizes in _NECK] + [(u * f.snout_distance, *sizes) for u, *sizes in _SKULL]
    return [(f.joint + x, a * f.w, b * f.h, c * f.h) for x, a, b, c in rows]


def jaw(robot: Robot, proportions: Proportions) -> Mesh:
    """Return the lower jaw, a little open."""
    f = frame(robot, proportions)
    u = np.concatenate([[-0.06], np.linspace(0.0, 0.94, 24), [0.965, 0.98, 0.988]])
    c, s = ring(JAW_AROUND, 2.3)
    top, bottom = -f.h * _JAW_TOP(u), -f.h * _JAW_DEPTH(u)
    z = (top + bottom)[:, None] / 2 + (top - bottom)[:, None] / 2 * s
    x = np.broadcast_to((f.snout_distance * u)[:, None], z.shape)
    y = f.w * _JAW_WIDTH(u)[:, None] * c
    mesh = loft(_opened(np.stack([x, y, z], axis=-1), f, proportions))
    level = np.concatenate([np.broadcast_to(s, z.shape).ravel(), [0.0, 0.0]])
    return mesh.painted(jaw_paint(level))


def _opened(points: np.ndarray, f: Frame, proportions: Proportions) -> np.ndarray:
    """Turn points of the lower jaw about its joint, which is the origin, and put them in their place."""
    c, s = np.cos(proportions.gape), np.sin(proportions.gape)
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([f.joint + c * x + s * z, y, c * z - s * x], axis=-1)


def eyes(robot: Robot, proportions: Proportions) -> list[Mesh]:
    """Return the left eye, its pupil and its brow, and the left nostril."""
    f = frame(robot, proportions)
    x, y, z = f.joint + 0.27 * f.snout_distance, 0.60 * f.w, 0.98 * f.h
    size = 0.135 * f.w
    brows = (x - 0.2 * size, y - 0.45 * size, z + 0.45 * size)
    pupil = (x + 0.1 * size, y + 0.62 * size, z + 0.3 * size)
    nostril = (f.joint + 0.945 * f.snout_distance, 0.19 * f.w, 0.40 * f.h)
    return [
        ellipsoid((x, y, z + 0.2 * size), (1.25 * size, size, size), point_count=12, rings=8).painted(EYE),
        ellipsoid(pupil, (0.3 * size, 0.5 * size, 0.72 * size)).painted(PUPIL),
        ellipsoid(brows, (2.1 * size, size, size), point_count=12, rings=8).painted(brow),
        ellipsoid(nostril, (0.5 * size, 0.42 * size, 0.75 * size)).painted(PUPIL),
    ]


def teeth(robot: Robot, proportions: Proportions) -> list[Mesh]:
    """Return the left teeth of both jaws; every fourth is long."""
    f = frame(robot, proportions)
    meshes = []
    for i, u in enumerate(np.linspace(0.30, 0.955, proportions.teeth)):
        size = f.h * (0.30 if i % 4 == 2 else 0.19)
        gum = (f.joint + f.snout_distance * u, 0.90 * f.w * float(_SKULL_WIDTH(u)), -f.h * (float(_MOUTH(u)) - 0.06))
        meshes.append(_tooth(np.array(gum), -size, 0.055 * f.h))
        v = u - 0.5 * 0.655 / proportions.teeth
        lower_gum = np.array(
            [f.snout_distance * v, 0.86 * f.w * float(_JAW_WIDTH(v)), -f.h * (float(_JAW_TOP(v)) + 0.06)]
        )
        meshes.append(_tooth(_opened(lower_gum, f, proportions), 0.75 * size, 0.055 * f.h))
    return [tooth.painted(TOOTH) for tooth in meshes]


def _tooth(gum: np.ndarray, height: float, radius: float) -> Mesh:
    c, s = ring(4)
    half_width = 1.4 * radius
    base = gum + np.stack([half_width * c, half_width * s * np.sign(height), 0.0 * c], axis=-1)
    return spike(base, gum + np.array([0.0, 0.1 * abs(height), height]))
