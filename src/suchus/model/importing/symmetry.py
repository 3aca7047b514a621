"""The mirror plane of a tree of hinges, the pairs of limbs that it maps onto each other, and which end is the front."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from suchus.errors import UnknownName, UnreadableFile
from suchus.model.importing.tree import Joint, Tree, TreePart

TOLERANCE = 0.02
"""Mirror images may miss each other by this share of the robot's size [-]."""
_SHARE = 0.9  # of the hinges that a mirror plane maps onto others, at least
_SLIM = (
    0.25  # a body shorter than this share of its width is a slender one seen across: the halves of a snake mirror too
)
_STEP = 15  # degrees between the planes that are tried
_LEVEL = 0.999  # cosine of two axes that are one
_FLIP = np.array([1.0, -1.0, 1.0])
_AHEAD = re.compile(r"head|snout|front|fore|neck|nose|jaw|face|shoulder|chest|thorax|^[LR]?F[LR]?(_|$)", re.I)
_BACK = re.compile(r"tail|rear|hind|back|pelvis|fin_|^[LR]?[HR][LR]?(_|$)", re.I)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Plane:
    """The vertical mirror plane, and the robot's frame: x forward in it, y left, z up."""

    point: np.ndarray
    """A point in the plane, shape (3,) [m]."""
    heading: float
    """Direction of forward, from the file's x axis to the left [degree]."""
    certain: bool
    """Whether the file's names, or an option, say which end is the front."""
    rivals: tuple[float, ...] = ()
    """Headings of planes that mirror as many hinges, of a body about as long [degree]."""

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
    tried = [(mapped_share(tree, plane), plane) for plane in _candidates(tree, ahead, heading)]
    fit = [(plane, split_by(tree, plane)) for share, plane in tried if share >= _SHARE]
    if not fit:
        most = max((share for share, _ in tried), default=0.0)
        raise UnreadableFile(
            f"no vertical plane mirrors its hinges onto each other (the best one {most:.0%} of them, {_SHARE:.0%} are "
            "needed): draw it upright and straight at zero posture, or say --heading."
        )
    ranks = [_rank(tree, *one) for one in fit]
    best = ranks.index(max(ranks))
    plane, split = fit[best]
    rivals = {one.heading for (one, _), rank in zip(fit, ranks, strict=True) if _close(rank, ranks[best])}
    plane = replace(plane, rivals=tuple(sorted(rivals - {plane.heading})))
    if heading is not None:
        return plane, split
    sign, certain = _forward(tree, plane, ahead)
    if sign > 0:
        return replace(plane, certain=certain), split
    flipped = tuple((b, a) for a, b in split.pairs)
    return replace(plane, heading=plane.heading - 180.0, certain=certain), replace(split, pairs=flipped)


def _candidates(tree: Tree, ahead: np.ndarray | None, heading: float | None) -> Iterator[Plane]:
    """Yield vertical planes through the root or the middle of the hinges; a body at the front lies along them."""
    root = tree.parts[0]
    points = [root.origin, root.com, np.mean([j.anchor for p in tree.parts for j in p.joints], axis=0)]
    for turn in [*range(0, 180, _STEP)] if heading is None else [heading]:
        for point in points:
            plane = Plane(point=point, heading=float(turn), certain=heading is not None)
            away = None if ahead is None else plane.turn @ (ahead - tree.com)
            if away is None or abs(away[1]) <= abs(away[0]):
                yield plane


def _rank(tree: Tree, plane: Plane, split: Split) -> tuple[bool, int, float]:
    """Return what makes a plane the likelier one: not across a slender body, hinges in mirrored branches, length."""
    paired = [i for pair in split.pairs for first in pair for i in tree.below(first)]
    extent = np.ptp(np.concatenate([plane.into(part.corners) for part in tree.parts]), axis=0)
    hinges = sum(len(tree.parts[i].joints) for i in paired)
    return bool(extent[0] >= _SLIM * extent[1]), hinges, round(float(extent[0]) / tree.size, 3)


def _close(one: tuple[bool, int, float], two: tuple[bool, int, float]) -> bool:
    """Return whether nothing but a tenth of the length speaks for one plane against another."""
    return one[:2] == two[:2] and abs(one[2] - two[2]) <= 0.1 * max(one[2], two[2])


def mapped_share(tree: Tree, plane: Plane) -> float:
    """Return the share of the hinges whose mirror image is a hinge."""
    joints = [joint for part in tree.parts for joint in part.joints]
    places, lines = plane.into(np.array([j.anchor for j in joints])), np.array([j.axis for j in joints]) @ plane.turn.T
    return float(_meet(places * _FLIP, lines * _FLIP, places, lines, TOLERANCE * tree.size).any(axis=1).mean())


def split_by(tree: Tree, plane: Plane) -> Split:
    """Return which parts lie in a plane and which branches mirror each other."""
    near = TOLERANCE * tree.size
    axis: list[int] = [0]
    branches: list[int] = []
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


def _within(part: TreePart, plane: Plane, near: float) -> bool:
    """Return whether a part lies in the plane: its centre of mass, and its hinges but those across the plane."""
    if abs(plane.into(part.com)[1]) > near:
        return False
    return all(abs((plane.turn @ j.axis)[1]) > _LEVEL or abs(plane.into(j.anchor)[1]) <= near for j in part.joints)


def _twins(tree: Tree, one: int, two: int, plane: Plane, near: float) -> bool:
    """Return whether two branches of one part mirror each other hinge by hinge."""
    if tree.parts[one].parent != tree.parts[two].parent:
        return False
    ours, theirs = ([tree.parts[i] for i in tree.below(b)] for b in (one, two))
    mine, others = ([joint for part in parts for joint in part.joints] for parts in (ours, theirs))
    if len(mine) != len(others):
        return False
    return all(any(_mirrors(a, b, plane, near) for b in others) for a in mine)


def _mirrors(one: Joint, two: Joint, plane: Plane, near: float) -> bool:
    """Return whether the axis of a hinge, mirrored, is the line about which another one turns."""
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
        return float(np.sign((plane.turn @ (ahead - tree.com))[0]) or 1.0), True
    votes, middle = 0.0, plane.into(tree.com)[0]
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
    whole = int(degrees % 360) if degrees % 90 == 0 else -1
    return exact.get(whole) or (float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees))))
