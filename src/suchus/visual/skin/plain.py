"""The skin of any body: a smooth hide along the axis, rods for limbs, balls for feet."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from suchus.robot.design import Layout, LimbPlace, Rod, Shell
from suchus.visual.skin.bones import bone_rest
from suchus.visual.skin.mesh import Mesh, curve, ellipsoid, loft, ring
from suchus.visual.skin.paint import EYE, FLANK, SOLE, hide

AROUND = 24
"""Points around the axis, a multiple of four [-]."""
LIMB_AROUND = 12
"""Points around a link of a limb, a multiple of four [-]."""
_RINGS, _MARGIN = 120, 1.04
_CAP = np.array([0.0, 0.3, 0.6, 0.85, 0.97])  # places of the rings of a rod's round end


def axis_mesh(place: Layout) -> Mesh:
    """Return the hide from the snout to the tip of the tail."""
    knots: list[tuple[float, float, float]] = []
    for segment, start in zip(place.robot.axis, segment_places(place), strict=True):
        for shape in segment.shapes:
            x, (wide, high) = start + shape.centre[0], _section(shape)
            there = next((i for i, knot in enumerate(knots) if abs(knot[0] - x) < 1e-9), None)
            if there is None:
                knots.append((x, wide, high))
            else:
                knots[there] = x, max(wide, knots[there][1]), max(high, knots[there][2])
    front, back = ends(place)
    knots.sort()
    kept = [knots[0]] + [b for a, b in pairwise(knots) if b[0] - a[0] > 1e-4 * (front - back)]
    width, height = (_outline([(k[0], k[i]) for k in kept], back, front) for i in (1, 2))
    share = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.002, 0.998, _RINGS))  # finer at both ends, where it closes
    along = back + (front - back) * share
    c, s = ring(AROUND, 2.2)
    points = [np.broadcast_to(along[:, None], (_RINGS, AROUND)), width(along)[:, None] * c, height(along)[:, None] * s]
    mesh = loft(np.stack(points, axis=-1))
    level = np.concatenate([np.broadcast_to(s, (_RINGS, AROUND)).ravel(), [0.0, 0.0]])
    return mesh.painted(hide(level, place.robot.length))


def eyes(place: Layout) -> list[Mesh]:
    """Return both eyes, for whom it is easier to see where the front is."""
    front, _ = ends(place)
    shape = place.robot.axis[0].shapes[-1]
    wide, high = _section(shape)
    size = 0.22 * min(wide, high)
    at = front - 0.75 * max(wide, 0.4 * (place.robot.axis[0].front + place.robot.axis[0].rear))
    return [ellipsoid((at, side * 0.75 * wide, 0.62 * high), (size, size, size)).painted(EYE) for side in (1.0, -1.0)]


def limb_meshes(place: Layout, limb: LimbPlace) -> list[tuple[Mesh, int]]:
    """Return the links and the foot of a limb, each with the bone that it hangs on."""
    rest, design = bone_rest(place.robot), limb.girdle.limb
    first = limb.tip - len(design.links) + 1
    found = []
    for number, link in enumerate(design.links):
        start = rest[first + number]
        end = start + np.array([link.end[0], limb.side * link.end[1], link.end[2]])
        found.append((rod(start, end, link.radius).painted(FLANK), first + number))
    radius = design.foot.radius
    found.append((ellipsoid(end, (radius,) * 3, around=LIMB_AROUND, rings=8).painted(SOLE), limb.tip))
    return found


def rod(start: np.ndarray, end: np.ndarray, radius: float) -> Mesh:
    """Return a rod with round ends."""
    length = float(np.linalg.norm(end - start))
    ahead = (end - start) / length
    aside = np.cross(ahead, [0.0, 0.0, 1.0] if abs(ahead[2]) < 0.9 else [1.0, 0.0, 0.0])
    aside /= np.linalg.norm(aside)
    up = np.cross(ahead, aside)
    along = np.concatenate([-radius * _CAP[::-1], length + radius * _CAP])
    wide = radius * np.sqrt(1.0 - np.concatenate([_CAP[::-1], _CAP]) ** 2)
    c, s = ring(LIMB_AROUND)
    around = c[:, None] * aside + s[:, None] * up
    return loft(start + along[:, None, None] * ahead + wide[:, None, None] * around)


def segment_places(place: Layout) -> list[float]:
    """Return where the origin of each segment of the axis lies ahead of the root's at zero posture [m]."""
    rest = {body.name: (at, body.shift) for body, at in zip(place.bodies, bone_rest(place.robot), strict=True)}
    return [float(rest[s.name][0][0] + rest[s.name][1]) for s in place.robot.axis]


def ends(place: Layout) -> tuple[float, float]:
    """Return where the snout and the tip of the tail lie ahead of the root at zero posture [m]."""
    at, axis = segment_places(place), place.robot.axis
    return at[0] + axis[0].front, at[-1] - axis[-1].rear


def _section(shape: Rod | Shell) -> tuple[float, float]:
    """Return half of the width and height of a shape of the axis [m]."""
    return (shape.radius, shape.radius) if isinstance(shape, Rod) else (shape.half[1], shape.half[2])


def _outline(knots: list[tuple[float, float]], back: float, front: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return half widths along the axis, closed at both ends."""
    first, last = knots[0][1], knots[-1][1]
    closed = [(back, 0.15 * first), *knots, (front - 0.35 * last, 0.8 * last), (front, 0.15 * last)]
    closed.sort()
    rising = [closed[0]] + [b for a, b in pairwise(closed) if b[0] > a[0]]
    return curve([(a, _MARGIN * b) for a, b in rising])
