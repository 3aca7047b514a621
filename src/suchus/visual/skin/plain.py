"""The skin of any body: a smooth hide along the axis, rods for limbs, balls for feet."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from suchus.robot.design import Layout, LimbPlace, Rod, Shell
from suchus.visual.skin.bones import bone_rest
from suchus.visual.skin.mesh import Mesh, curve, ellipsoid, loft, ring
from suchus.visual.skin.paint import EYE, FLANK, SOLE, hide

RING_POINTS = 24
"""Points around the axis, a multiple of four [-]."""
LIMB_AROUND = 12
"""Points around a link of a limb, a multiple of four [-]."""
_RINGS, _MARGIN = 120, 1.04
_CAP = np.array([0.0, 0.3, 0.6, 0.85, 0.97])  # places of the rings of a rod's round end


def axis_mesh(robot_layout: Layout) -> Mesh:
    """Return the hide from the snout to the tip of the tail."""
    knots: list[tuple[float, float, float]] = []
    for segment, start in zip(robot_layout.robot.axis, segment_places(robot_layout), strict=True):
        for shape in segment.shapes:
            x, (half_width, half_height) = start + shape.centre[0], _section(shape)
            index = next((i for i, knot in enumerate(knots) if abs(knot[0] - x) < 1e-9), None)
            if index is None:
                knots.append((x, half_width, half_height))
            else:
                knots[index] = x, max(half_width, knots[index][1]), max(half_height, knots[index][2])
    front, back = ends(robot_layout)
    knots.sort()
    distinct_knots = [knots[0]] + [b for a, b in pairwise(knots) if b[0] - a[0] > 1e-4 * (front - back)]
    width, height = (_outline([(k[0], k[i]) for k in distinct_knots], back, front) for i in (1, 2))
    fractions = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.002, 0.998, _RINGS))  # finer at both ends, where it closes
    axial_positions = back + (front - back) * fractions
    c, s = ring(RING_POINTS, 2.2)
    points = [
        np.broadcast_to(axial_positions[:, None], (_RINGS, RING_POINTS)),
        width(axial_positions)[:, None] * c,
        height(axial_positions)[:, None] * s,
    ]
    mesh = loft(np.stack(points, axis=-1))
    level = np.concatenate([np.broadcast_to(s, (_RINGS, RING_POINTS)).ravel(), [0.0, 0.0]])
    return mesh.painted(hide(level, robot_layout.robot.length))


def eyes(robot_layout: Layout) -> list[Mesh]:
    """Return both eyes, which show where the front is."""
    front, _ = ends(robot_layout)
    shape = robot_layout.robot.axis[0].shapes[-1]
    half_width, half_height = _section(shape)
    size = 0.22 * min(half_width, half_height)
    x = front - 0.75 * max(half_width, 0.4 * (robot_layout.robot.axis[0].front + robot_layout.robot.axis[0].rear))
    return [
        ellipsoid((x, side * 0.75 * half_width, 0.62 * half_height), (size, size, size)).painted(EYE)
        for side in (1.0, -1.0)
    ]


def limb_meshes(robot_layout: Layout, limb: LimbPlace) -> list[tuple[Mesh, int]]:
    """Return the links and the foot of a limb, each with the bone that it hangs on."""
    origins, design = bone_rest(robot_layout.robot), limb.girdle.limb
    first_bone = limb.tip - len(design.links) + 1
    meshes = []
    for number, link in enumerate(design.links):
        start = origins[first_bone + number]
        end = start + np.array([link.end[0], limb.side * link.end[1], link.end[2]])
        meshes.append((rod(start, end, link.radius).painted(FLANK), first_bone + number))
    radius = design.foot.radius
    meshes.append((ellipsoid(end, (radius,) * 3, point_count=LIMB_AROUND, rings=8).painted(SOLE), limb.tip))
    return meshes


def rod(start: np.ndarray, end: np.ndarray, radius: float) -> Mesh:
    """Return a rod with round ends.

    Args:
        start: start of its axis, (3,) [m].
        end: end of its axis, (3,) [m].
        radius: [m].
    """
    length = float(np.linalg.norm(end - start))
    axis = (end - start) / length
    lateral = np.cross(axis, [0.0, 0.0, 1.0] if abs(axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    lateral /= np.linalg.norm(lateral)
    normal = np.cross(axis, lateral)
    axial_positions = np.concatenate([-radius * _CAP[::-1], length + radius * _CAP])
    ring_radii = radius * np.sqrt(1.0 - np.concatenate([_CAP[::-1], _CAP]) ** 2)
    c, s = ring(LIMB_AROUND)
    directions = c[:, None] * lateral + s[:, None] * normal
    return loft(start + axial_positions[:, None, None] * axis + ring_radii[:, None, None] * directions)


def segment_places(robot_layout: Layout) -> list[float]:
    """Return where the origin of each segment of the axis lies ahead of the root's at zero posture [m]."""
    placements = {
        body.name: (origin, body.shift)
        for body, origin in zip(robot_layout.bodies, bone_rest(robot_layout.robot), strict=True)
    }
    return [float(placements[s.name][0][0] + placements[s.name][1]) for s in robot_layout.robot.axis]


def ends(robot_layout: Layout) -> tuple[float, float]:
    """Return where the snout and the tip of the tail lie ahead of the root at zero posture [m]."""
    positions, axis = segment_places(robot_layout), robot_layout.robot.axis
    return positions[0] + axis[0].front, positions[-1] - axis[-1].rear


def _section(shape: Rod | Shell) -> tuple[float, float]:
    """Return half of the width and height of a shape of the axis [m]."""
    return (shape.radius, shape.radius) if isinstance(shape, Rod) else (shape.half[1], shape.half[2])


def _outline(knots: list[tuple[float, float]], back: float, front: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return half widths along the axis, closed at both ends.

    Args:
        knots: pairs of place x and half width, x increasing [m].
        back: x of the tail's tip [m].
        front: x of the snout's tip [m].
    """
    tail_width, snout_width = knots[0][1], knots[-1][1]
    closed = [
        (back, 0.15 * tail_width),
        *knots,
        (front - 0.35 * snout_width, 0.8 * snout_width),
        (front, 0.15 * snout_width),
    ]
    closed.sort()
    rising = [closed[0]] + [b for a, b in pairwise(closed) if b[0] > a[0]]
    return curve([(a, _MARGIN * b) for a, b in rising])
