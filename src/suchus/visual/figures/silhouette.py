"""The silhouette of a posed skin as a few polygons, for drawings in lines."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from suchus.robot.design import LEGS, Layout, Robot, layout
from suchus.visual.skin.head import JAW_AROUND
from suchus.visual.skin.legs import LEG_AROUND
from suchus.visual.skin.look import SKIN
from suchus.visual.skin.plain import RING_POINTS
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
    """Legs in the order of the robot's limbs, each as overlapping convex pieces from haunch to claws."""


def silhouette(robot: Robot, vertices: np.ndarray, axes: tuple[int, int]) -> Silhouette:
    """Return the silhouette of a posed skin.

    Args:
        robot: robot whose skin it is.
        vertices: vertices of ``skin(robot)``, posed, (n, 3) [m].
        axes: which two coordinates are drawn: (0, 1) from above, (0, 2) from the side.
    """
    surface, flat = skin(robot), vertices[:, list(axes)]
    starts = np.flatnonzero(np.diff(surface.part_index, prepend=-1))
    part_points = np.split(flat, starts[1:])
    sizes = np.array([len(points) for points in part_points])
    if surface.plain:
        return _plain(layout(robot), surface, starts, part_points)
    legs: list[list[np.ndarray]] = [[], [], [], []]
    names = _owners(surface, starts)
    for points, owner in zip(part_points, names, strict=True):
        if owner >= 0:
            legs[owner] += [_hull(points)] if legs[owner] else _bands(points, skip_root=axes == (0, 2))
    axial = [points for points, owner in zip(part_points, names, strict=True) if owner < 0]
    spikes = [points for points in axial[2:] if len(points) == _SCUTE]
    eyes = [axial[i] for i in np.flatnonzero(sizes[: len(axial)] == _EYE)[:2]]
    return Silhouette(
        body=_sides(axial[0], SKIN.ring_points),
        jaw=_sides(axial[1], JAW_AROUND),
        scutes=[_hull(points[[0, 2, 4, 6, 8]]) for points in spikes],  # every other corner, and the apex
        eyes=[_hull(points) for points in eyes],
        legs=legs,
    )


def _plain(robot_layout: Layout, surface: Skin, starts: np.ndarray, part_points: list[np.ndarray]) -> Silhouette:
    """Return the silhouette of a plain body: its hide, its eyes, and the hulls of its limbs' links and feet."""
    legs: list[list[np.ndarray]] = [[] for _ in robot_layout.limbs]
    for start, points in zip(starts[3:], part_points[3:], strict=True):
        bone = int(surface.indices[start, 0])
        owner = next(i for i, limb in enumerate(robot_layout.limbs) if limb.tip >= bone)
        legs[owner].append(_hull(points))
    return Silhouette(
        body=_sides(part_points[0], RING_POINTS),
        jaw=np.empty((0, 2)),
        scutes=[],
        eyes=[_hull(points) for points in part_points[1:3]],
        legs=legs,
    )


_SCUTE, _EYE = 10, 98  # vertices of a scute and of an eye


def _owners(surface: Skin, starts: np.ndarray) -> list[int]:
    """Return for each part the leg that it belongs to, -1 for head, trunk and tail."""
    shins = {surface.bones.index(f"{leg}_{bone}"): i for i, leg in enumerate(LEGS) for bone in ("femur", "tibia")}
    last_vertices = [*(starts[1:] - 1), len(surface.part_index) - 1]  # a limb ends at its foot
    return [shins.get(int(surface.indices[vertex, 0]), -1) for vertex in last_vertices]


def _sides(points: np.ndarray, ring_size: int) -> np.ndarray:
    """Return the outline of a loft: on each ring the two points farthest across its axis, and both ends."""
    rings, start_point, end_point = points[:-2].reshape(-1, ring_size, 2)[::2], points[-2], points[-1]
    centers = rings.mean(axis=1)
    direction = np.gradient(centers, axis=0)
    normal = np.stack([-direction[:, 1], direction[:, 0]], axis=-1)
    lateral_offset = np.einsum("rpi,ri->rp", rings - centers[:, None], normal)
    ring_index = np.arange(len(rings))
    left_side, right_side = (
        rings[ring_index, lateral_offset.argmax(axis=1)],
        rings[ring_index, lateral_offset.argmin(axis=1)],
    )
    return np.concatenate([start_point[None], left_side, end_point[None], right_side[::-1]])


def _bands(points: np.ndarray, *, skip_root: bool) -> list[np.ndarray]:
    """Return the pieces of a limb, which may point at the viewer: hulls of neighbouring rings.

    Args:
        points: the limb.
        skip_root: whether to leave out its root, which is inside the body.
    """
    rings = points[:-2].reshape(-1, LEG_AROUND, 2)[:, ::2]
    used_rings = rings[np.unique(np.linspace(len(rings) // 4 if skip_root else 0, len(rings) - 1, 11).astype(int))]
    return [_hull(np.concatenate(pair)) for pair in pairwise(used_rings)]


def _hull(points: np.ndarray) -> np.ndarray:
    return points[ConvexHull(points, qhull_options="QJ").vertices]
