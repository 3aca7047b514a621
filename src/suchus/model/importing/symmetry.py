"""The mirror plane of a tree of hinges, the pairs of limbs that it maps onto each other, and which end is the front."""

import re
from dataclasses import dataclass

import numpy as np

from suchus.errors import UnknownName, UnreadableFile
from suchus.model.importing.tree import Joint, Part, Tree

TOLERANCE = 0.02
"""Mirror images may miss each other by this share of the robot's size [-]."""
_SHARE = 0.9  # of the hinges that a mirror plane maps onto others, at least
_STEP = 15  # degrees between the planes that are tried
_LEVEL = 0.999  # cosine of two axes that are one
_FLIP = np.array([1.0, -1.0, 1.0])
_AHEAD = re.compile(r"head|snout|front|fore|neck|nose|jaw|face|shoulder|chest|thorax|^[LR]?F[LR]?(_|$)", re.I)
_BACK = re.compile(r"tail|rear|hind|back|pelvis|fin_|^[LR]?[HR][LR]?(_|$)", re.I)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Plane:
    """The vertical mirror plane, and the robot's frame: x forward in it, y left, z up."""

    point: np.ndarray
    """In the plane, shape (3,) [m]."""
    heading: float
    """Of forward, from the file's x axis to the left [degree]."""
    certain: bool
    """Whether the file's names, or an option, say which end is the front."""

    @property
    def turn(self) -> np.ndarray:
        """Rotation from the file's frame into the robot's, shape (3, 3) [-]."""
        c, s = _level(self.heading)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    def into(self, points: np.ndarray) -> np.ndarray:
        """Return points of the file in the robot's frame, shape (..., 3) [m]."""
        return np.asarray((points - self.point) @ self.turn.T)


@dataclass(frozen=True, slots=True, kw_only=True)
class Split:
    """What lies in the plane and what hangs beside it."""

    axis: tuple[int, ...]
    """Parts in the plane that hang together with the root."""
    pairs: tuple[tuple[int, int], ...]
    """First parts of mirrored branches, the left one first."""
    single: tuple[int, ...]
    """First parts of branches without a mirror image."""


def find_plane(tree: Tree, *, front: str | None, heading: float | None) -> tuple[Plane, Split]:
    """Return the mirror plane with most hinges in mirrored branches, then the longest, and what it splits.

    Args:
        tree: the parts.
        front: a body at the front end; None: guess by names, else along the file's x axis.
        heading: of the front, from the file's x axis to the left [degree]; None: guess.

    Raises:
        UnreadableFile: no plane maps enough hinges onto each other.
        UnknownName: there is no such body.
    """
    ahead = None if front is None else _named(tree, front)
    root = tree.parts[0]
    points = [root.origin, root.com, np.mean([j.anchor for p in tree.parts for j in p.joints], axis=0)]
    turns = [*range(0, 180, _STEP)] if heading is None else [heading]
    best: tuple[float, ...] = ()
    chosen: tuple[Plane, Split] | None = None
    most = 0.0
    for turn in turns:
        for point in points:
            plane = Plane(point=point, heading=float(turn), certain=heading is not None)
            if ahead is not None and abs(plane.into(ahead)[1]) > abs(plane.into(ahead)[0]):
                continue
            share = mapped_share(tree, plane)
            most = max(most, share)
            if share < _SHARE:
                continue
            split = split_by(tree, plane)
            hinges = sum(len(tree.parts[i].joints) for one, two in split.pairs for b in (one, two) for i in tree.below(b))
            length = np.ptp(np.concatenate([plane.into(part.corners)[:, 0] for part in tree.parts]))
            rank = (float(hinges), round(float(length) / tree.size, 3))
            if rank > best:
                best, chosen = rank, (plane, split)
    if chosen is None:
        raise UnreadableFile(
            f"no vertical plane mirrors its hinges onto each other (the best one {most:.0%} of them, {_SHARE:.0%} are "
            "needed): draw it upright and straight at zero posture, or say --heading."
        )
    if heading is not None:
        return chosen
    plane, split = chosen
    sign, certain = _forward(tree, plane, ahead)
    if sign > 0:
        return Plane(point=plane.point, heading=plane.heading, certain=certain), split
    flipped = Plane(point=plane.point, heading=plane.heading - 180.0, certain=certain)
    return flipped, Split(axis=split.axis, pairs=tuple((b, a) for a, b in split.pairs), single=split.single)


def mapped_share(tree: Tree, plane: Plane) -> float:
    """Return the share of the hinges whose mirror image is a hinge."""
    joints = [joint for part in tree.parts for joint in part.joints]
    places, lines = plane.into(np.array([j.anchor for j in joints])), np.array([j.axis for j in joints]) @ plane.turn.T
    return float(_meet(places * _FLIP, lines * _FLIP, places, lines, TOLERANCE * tree.size).any(axis=1).mean())


def split_by(tree: Tree, plane: Plane) -> Split:
    """Return which parts lie in a plane and which branches mirror each other."""
    near = TOLERANCE * tree.size
    axis, branches = [0], []
    for place, part in enumerate(tree.parts[1:], 1):
        if part.parent in axis:
            (axis if _within(part, plane, near) else branches).append(place)
    pairs, single, left = [], [], list(branches)
    while left:
        one = left.pop(0)
        twin = next((two for two in left if _twins(tree, one, two, plane, near)), None)
        if twin is None:
            single.append(one)
            continue
        left.remove(twin)
        aside = float(np.mean([plane.into(tree.parts[i].com)[1] for i in tree.below(one)]))
        pairs.append((one, twin) if aside > 0 else (twin, one))
    return Split(axis=tuple(axis), pairs=tuple(pairs), single=tuple(single))


def _within(part: Part, plane: Plane, near: float) -> bool:
    """Tell whether a part lies in the plane: its centre of mass, and its hinges but those across the plane."""
    if abs(plane.into(part.com)[1]) > near:
        return False
    return all(abs((plane.turn @ j.axis)[1]) > _LEVEL or abs(plane.into(j.anchor)[1]) <= near for j in part.joints)


def _twins(tree: Tree, one: int, two: int, plane: Plane, near: float) -> bool:
    """Tell whether two branches of one part mirror each other hinge by hinge."""
    if tree.parts[one].parent != tree.parts[two].parent:
        return False
    ours, theirs = ([tree.parts[i] for i in tree.below(b)] for b in (one, two))
    mine, others = ([joint for part in parts for joint in part.joints] for parts in (ours, theirs))
    if len(mine) != len(others):
        return False
    return all(any(_mirrors(a, b, plane, near) for b in others) for a in mine)


def _mirrors(one: Joint, two: Joint, plane: Plane, near: float) -> bool:
    """Tell whether the axis of a hinge, mirrored, is the line about which another one turns."""
    place, line = plane.into(one.anchor) * _FLIP, plane.turn @ one.axis * _FLIP
    return bool(_meet(place[None], line[None], plane.into(two.anchor)[None], (plane.turn @ two.axis)[None], near)[0, 0])


def _meet(places: np.ndarray, lines: np.ndarray, others: np.ndarray, along: np.ndarray, near: float) -> np.ndarray:
    """Return which lines through places fall together with which others, shape (place, other)."""
    gap = places[:, None] - others[None]
    off = gap - np.einsum("ijk,jk->ij", gap, along)[..., None] * along[None]
    return np.asarray((np.abs(lines @ along.T) > _LEVEL) & (np.linalg.norm(off, axis=-1) < near))


def _forward(tree: Tree, plane: Plane, ahead: np.ndarray | None) -> tuple[float, bool]:
    """Return 1 if the plane's x points forward and -1 if backward, and whether something says so."""
    if ahead is not None:
        return float(np.sign(plane.into(ahead)[0]) or 1.0), True
    votes = 0.0
    middle = np.mean([plane.into(part.com)[0] for part in tree.parts])
    for part in tree.parts:
        for name, place in [*((n, part.com) for n in part.names), *((j.name, j.anchor) for j in part.joints)]:
            says = bool(_AHEAD.search(name)) - bool(_BACK.search(name))
            votes += says * np.sign(plane.into(place)[0] - middle)
    if votes:
        return float(np.sign(votes)), True
    c, s = _level(plane.heading)
    return (1.0 if c > 1e-9 or (abs(c) <= 1e-9 and s > 0) else -1.0), False


def _named(tree: Tree, name: str) -> np.ndarray:
    for part in tree.parts:
        if name in part.names:
            return part.com
    raise UnknownName("body", name, [one for part in tree.parts for one in part.names])


def _level(degrees: float) -> tuple[float, float]:
    """Return cosine and sine, exact at right angles."""
    exact = {0: (1.0, 0.0), 90: (0.0, 1.0), 180: (-1.0, 0.0), 270: (0.0, -1.0)}
    turn = degrees % 360
    return exact.get(turn) or (float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees))))
