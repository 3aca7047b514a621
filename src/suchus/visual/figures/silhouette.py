"""The silhouette of a posed skin as a few polygons, for drawings in lines."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from suchus.robot.design import LEGS, Layout, Robot, layout
from suchus.visual.skin.head import JAW_AROUND
from suchus.visual.skin.legs import LEG_AROUND
from suchus.visual.skin.look import SKIN
from suchus.visual.skin.plain import AROUND
from suchus.visual.skin.surface import Skin, skin


class Silhouette(NamedTuple):
    """Polygons of one view, each (corner, 2) [m]."""

    body: np.ndarray
    """Snout to tail tip."""
    jaw: np.ndarray
    """The lower jaw; empty for a plain body."""
    scutes: list[np.ndarray]
    """Plates and crests, those of the midline first."""
    eyes: list[np.ndarray]
    """Left and right."""
    legs: list[list[np.ndarray]]
    """In the order of the robot's limbs: convex pieces from haunch to claws that overlap; together they are the leg."""


def silhouette(robot: Robot, vertices: np.ndarray, axes: tuple[int, int]) -> Silhouette:
    """Return the silhouette of a posed skin.

    Args:
        robot: whose skin it is.
        vertices: of ``skin(robot)``, posed, (n, 3) [m].
        axes: which two coordinates are drawn: (0, 1) from above, (0, 2) from the side.
    """
    surface, flat = skin(robot), vertices[:, list(axes)]
    starts = np.flatnonzero(np.diff(surface.part, prepend=-1))
    parts = np.split(flat, starts[1:])
    sizes = np.array([len(part) for part in parts])
    if surface.plain:
        return _plain(layout(robot), surface, starts, parts)
    legs: list[list[np.ndarray]] = [[], [], [], []]
    names = _owners(surface, starts)
    for part, owner in zip(parts, names, strict=True):
        if owner >= 0:
            legs[owner] += [_hull(part)] if legs[owner] else _bands(part, LEG_AROUND, bare=axes == (0, 2))
    axial = [part for part, owner in zip(parts, names, strict=True) if owner < 0]
    spikes = [part for part in axial[2:] if len(part) == _SCUTE]
    eyes = [axial[i] for i in np.flatnonzero(sizes[: len(axial)] == _EYE)[:2]]
    return Silhouette(
        body=_sides(axial[0], SKIN.around),
        jaw=_sides(axial[1], JAW_AROUND),
        scutes=[_hull(part[[0, 2, 4, 6, 8]]) for part in spikes],  # every other corner, and the apex
        eyes=[_hull(part) for part in eyes],
        legs=legs,
    )


def _plain(place: Layout, surface: Skin, starts: np.ndarray, parts: list[np.ndarray]) -> Silhouette:
    """Return the silhouette of a plain body: its hide, its eyes, and the hulls of its limbs' links and feet."""
    legs: list[list[np.ndarray]] = [[] for _ in place.limbs]
    for start, part in zip(starts[3:], parts[3:], strict=True):
        bone = int(surface.indices[start, 0])
        owner = next(i for i, limb in enumerate(place.limbs) if limb.tip >= bone)
        legs[owner].append(_hull(part))
    return Silhouette(
        body=_sides(parts[0], AROUND),
        jaw=np.empty((0, 2)),
        scutes=[],
        eyes=[_hull(part) for part in parts[1:3]],
        legs=legs,
    )


_SCUTE, _EYE = 10, 98  # vertices of a scute and of an eye


def _owners(surface: Skin, starts: np.ndarray) -> list[int]:
    """Return for each part the leg that it belongs to, -1 for head, trunk and tail."""
    shins = {surface.bones.index(f"{leg}_{bone}"): i for i, leg in enumerate(LEGS) for bone in ("femur", "tibia")}
    last = [*(starts[1:] - 1), len(surface.part) - 1]  # a limb ends at its foot
    return [shins.get(int(surface.indices[at, 0]), -1) for at in last]


def _sides(part: np.ndarray, around: int) -> np.ndarray:
    """Return the outline of a loft: on each ring the two points farthest across its axis, and both ends."""
    rings, first, last = part[:-2].reshape(-1, around, 2)[::2], part[-2], part[-1]
    middle = rings.mean(axis=1)
    ahead = np.gradient(middle, axis=0)
    across = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
    aside = np.einsum("rpi,ri->rp", rings - middle[:, None], across)
    each = np.arange(len(rings))
    left, right = rings[each, aside.argmax(axis=1)], rings[each, aside.argmin(axis=1)]
    return np.concatenate([first[None], left, last[None], right[::-1]])


def _bands(part: np.ndarray, around: int, *, bare: bool) -> list[np.ndarray]:
    """Return the pieces of a limb, which may point at the viewer: hulls of neighbouring rings.

    Args:
        part: the limb.
        around: points of a ring.
        bare: whether to leave out its root, which is inside the body.
    """
    rings = part[:-2].reshape(-1, around, 2)[:, ::2]
    kept = rings[np.unique(np.linspace(len(rings) // 4 if bare else 0, len(rings) - 1, 11).astype(int))]
    return [_hull(np.concatenate(pair)) for pair in pairwise(kept)]


def _hull(part: np.ndarray) -> np.ndarray:
    return part[ConvexHull(part, qhull_options="QJ").vertices]
