"""The body plan of a tree of hinges: the chain of the axis from front to rear, and the chains of its limbs.

It begins with the mirror plane, the pairs of limbs that it maps onto each other, and which end is the front.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from suchus.core.errors import UnknownName, UnreadableFile
from suchus.robot.design.segment import together
from suchus.sim.model.importing.tree import Joint, Tree, TreePart


@dataclass(frozen=True, slots=True, kw_only=True)
class Words:
    """Answers to what geometry cannot say; None: guess, and show the guess."""

    front: str | None = None
    """A body at the front end."""
    heading: float | None = None
    """Direction of the front, from the file's x axis to the left [degree]."""
    neck: str | None = None
    """The body in which the axis ends in front, where it forks."""
    tail: str | None = None
    """The body in which the axis ends behind, where it forks."""
    leave: tuple[str, ...] = ()
    """Bodies to leave out with all that hangs on them, such as arms."""
    foot_radius: float | None = None
    """Radius of every foot [m]."""
    packages: tuple[str | Path, ...] = ()
    """Folders in which the packages lie that meshes name by ``package://``."""
    without_meshes: bool = False
    """Whether a body whose mesh is not read gets a rod."""


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
    places, lines = _hinge_lines([joint for part in tree.parts for joint in part.joints], plane)
    return float(_meet(places * _FLIP, lines * _FLIP, places, lines, TOLERANCE * tree.size).any(axis=1).mean())


def split_by(tree: Tree, plane: Plane) -> Split:
    """Return which parts lie in a plane and which branches mirror each other."""
    near = TOLERANCE * tree.size
    axis: list[int] = [0]
    branches: list[int] = []
    for place, part in enumerate(tree.parts[1:], 1):
        if part.parent in axis:
            (axis if _within(part, plane, near) else branches).append(place)
    hinges = {place: _branch(tree, place, plane) for place in branches}
    pairs, single, left = [], [], list(branches)
    while left:
        one = left.pop(0)
        twin = next((two for two in left if _twins(hinges[one], hinges[two], near)), None)
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


def _twins(one: tuple[int, np.ndarray, np.ndarray], two: tuple[int, np.ndarray, np.ndarray], near: float) -> bool:
    """Return whether two branches, see ``_branch``, hang on one part and mirror each other hinge by hinge."""
    (parent, places, lines), (other, others, along) = one, two
    if parent != other or len(places) != len(others):
        return False
    return bool(_meet(places * _FLIP, lines * _FLIP, others, along, near).any(axis=1).all())


def _branch(tree: Tree, place: int, plane: Plane) -> tuple[int, np.ndarray, np.ndarray]:
    """Return the part that a branch hangs on, and the lines of its hinges."""
    joints = [joint for i in tree.below(place) for joint in tree.parts[i].joints]
    return tree.parts[place].parent, *_hinge_lines(joints, plane)


def _hinge_lines(joints: Sequence[Joint], plane: Plane) -> tuple[np.ndarray, np.ndarray]:
    """Return points and directions of axes of hinges in the plane's coordinates, each of shape (n, 3)."""
    anchors, axes = (np.array([getattr(j, name) for j in joints]).reshape(-1, 3) for name in ("anchor", "axis"))
    return plane.into(anchors), axes @ plane.turn.T


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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LimbChain:
    """A limb: parts from the hip to the foot."""

    on: int
    """Place along the axis, from the front, of the part that carries it."""
    parts: tuple[int, ...]
    """Places in the tree."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BodyPlan:
    """The parts of the tree that form the axis, and those that form each limb."""

    tree: Tree
    """The tree; parts that were left out have lent their masses to those that carry them."""
    plane: Plane
    """The robot's frame."""
    axis: tuple[int, ...]
    """Places in the tree, from the front end to the rear end."""
    pairs: tuple[tuple[LimbChain, LimbChain], ...]
    """Limbs, left and right, from the front."""
    remarks: tuple[str, ...]
    """What was guessed, and what was not taken."""

    def part(self, place: int) -> TreePart:
        """Return a part of the tree."""
        return self.tree.parts[place]


def plan_of(tree: Tree, words: Words) -> BodyPlan:
    """Return the body plan of a tree.

    Raises:
        UnreadableFile: it has no mirror plane, or its root is a limb.
        UnknownName: a body that was named is not there.
    """
    tree, remarks = _pruned(tree, words.leave)
    plane, split = find_plane(tree, front=words.front, heading=words.heading)
    axis = _chain(tree, plane, split.axis, words)
    remarks += _remarks_on_front(plane)
    pairs, lost = [], [(i, "no mirror image") for i in split.single]
    for left, right in split.pairs:
        where = tree.parts[left].parent
        if where not in axis:
            lost += [(i, "hangs beside the axis") for i in (left, right)]
            continue
        one, two = (_main(tree, plane, first) for first in (left, right))
        pairs.append((LimbChain(on=axis.index(where), parts=one), LimbChain(on=axis.index(where), parts=two)))
    if not pairs and len(axis) == 1:
        alone = ", ".join(tree.parts[i].name for i, _ in lost[:4])
        image = f"; {alone} have no mirror image" if alone else ""
        raise UnreadableFile(
            f"no mirrored limbs and no hinges along an axis were found{image}: draw it upright and straight at zero "
            "posture, or say --heading."
        )
    used = {*axis, *(i for pair in pairs for chain in pair for i in chain.parts)}
    first = [i for i in range(len(tree.parts)) if i not in used and (tree.parts[i].parent in used or i == 0)]
    why = dict(lost)
    for i in first:
        names = [tree.parts[k].name for k in tree.below(i) if k not in used]
        reason = why.get(i) or ("in the middle, but not between front and rear" if i in split.axis else "a fork")
        remarks.append(
            f"{', '.join(names[:4])}{' ...' if len(names) > 4 else ''} was left out ({reason}); its mass went to the "
            f"part that carries it. {'See --neck and --tail.' if i in split.axis else ''}".rstrip()
        )
    hips = {pair: plane.into(tree.parts[pair[0].parts[0]].joints[0].anchor)[0] for pair in pairs}
    return BodyPlan(
        tree=_lumped(tree, used),
        plane=plane,
        axis=axis,
        pairs=tuple(sorted(pairs, key=lambda pair: -hips[pair])),
        remarks=(*tree.remarks, *remarks),
    )


def without(plan: BodyPlan, pair: tuple[LimbChain, LimbChain]) -> BodyPlan:
    """Return a plan without a pair of limbs, whose mass goes to the part that carries them."""
    pairs = tuple(other for other in plan.pairs if other is not pair)
    used = {*plan.axis, *(i for other in pairs for chain in other for i in chain.parts)}
    return replace(plan, tree=_lumped(plan.tree, used), pairs=pairs)


def links_between(plan: BodyPlan, near: int, far: int) -> Iterator[tuple[Joint, bool]]:
    """Yield the hinges between two neighbours of the axis from the one near our root on.

    Each comes with whether its positive turn moves the far part as in the file, and not the near one.
    """
    if plan.part(far).parent == near:
        for joint in plan.part(far).joints:
            yield joint, True
    else:
        for joint in reversed(plan.part(near).joints):
            yield joint, False


def _remarks_on_front(plane: Plane) -> list[str]:
    where = f"the file's x axis turned left by {plane.heading % 360:g} degrees"
    other = (plane.heading + 180) % 360
    if plane.certain:
        remarks = [f"Front: {where}, as names or options say (--front, --heading)."]
    else:
        remarks = [f"Guess: the front is {where}; if it is the rear, say --front BODY or --heading {other:g}."]
    if plane.rivals:
        others = " or ".join(f"{(heading + turn) % 360:g}" for heading in plane.rivals for turn in (0, 180))
        remarks.append(
            f"Guess: its sides mirror as well about another plane; if that is the right one, --heading {others}."
        )
    return remarks


def _pruned(tree: Tree, names: Sequence[str]) -> tuple[Tree, list[str]]:
    """Return a tree without branches, whose masses go to what carries them."""
    gone: set[int] = set()
    for name in names:
        place = next((i for i, part in enumerate(tree.parts) if name in part.names), None)
        if place is None:
            raise UnknownName("body", name, [one for part in tree.parts for one in part.names])
        if place == 0:
            raise UnreadableFile(f"--leave {name} is the root, which carries everything; name a branch.")
        gone |= set(tree.below(place))
    if not gone:
        return tree, []
    rest = [i for i in range(len(tree.parts)) if i not in gone]
    lighter = _lumped(tree, set(rest))
    parts = tuple(replace(lighter.parts[i], parent=-1 if i == 0 else rest.index(tree.parts[i].parent)) for i in rest)
    left = ", ".join(tree.parts[i].name for i in sorted(gone))
    remark = f"Left out as asked, their masses lent to what carries them: {left}."
    return Tree(parts=parts, remarks=tree.remarks), [remark]


def _chain(tree: Tree, plane: Plane, inside: Sequence[int], words: Words) -> tuple[int, ...]:
    """Return the path through the parts in the plane from the foremost to the hindmost one."""
    ends = {i: plane.into(tree.parts[i].corners)[:, 0] for i in inside}
    front = _place(tree, words.neck, inside) if words.neck else max(inside, key=lambda i: float(ends[i].max()))
    rear = _place(tree, words.tail, inside) if words.tail else min(inside, key=lambda i: float(ends[i].min()))
    up, down = _upward(tree, front), _upward(tree, rear)
    meet = next(i for i in up if i in down)
    return (*up[: up.index(meet)], *reversed(down[: down.index(meet) + 1]))


def _place(tree: Tree, name: str, inside: Sequence[int]) -> int:
    for i in inside:
        if name in tree.parts[i].names:
            return i
    raise UnknownName("body in the mirror plane", name, [one for i in inside for one in tree.parts[i].names])


def _upward(tree: Tree, place: int) -> list[int]:
    path = [place]
    while tree.parts[path[-1]].parent >= 0:
        path.append(tree.parts[path[-1]].parent)
    return path


def _main(tree: Tree, plane: Plane, first: int) -> tuple[int, ...]:
    """Return the path from a hip to the end of the branch that has most hinges, the lowest of those alike."""

    def rank(place: int) -> tuple[int, float]:
        path = [i for i in _upward(tree, place) if i >= first]
        hinges = sum(len(tree.parts[i].joints) for i in path)
        return hinges, -float(plane.into(tree.parts[place].corners)[:, 2].min())

    below = tree.below(first)
    end = max((i for i in below if not any(tree.parts[k].parent == i for k in below)), key=rank)
    return tuple(i for i in reversed(_upward(tree, end)) if i in below)


def _lumped(tree: Tree, used: set[int]) -> Tree:
    """Return a tree in which parts that are not used have no mass, and those that carry them have it all."""
    held = [[(part.mass, part.com, part.tensor)] for part in tree.parts]
    for i in range(len(tree.parts) - 1, 0, -1):
        if i not in used:
            held[tree.parts[i].parent] += held[i]
            held[i] = []
    for i in range(len(tree.parts)):  # what lies above the axis hands its mass down
        onward = next((k for k in tree.children(i) if used & set(tree.below(k))), None)
        if i not in used and onward is not None:
            held[onward] += held[i]
            held[i] = []
    parts = []
    for part, those in zip(tree.parts, held, strict=True):
        mass, com, tensor = together(those or [(0.0, part.com, np.zeros((3, 3)))])
        parts.append(replace(part, mass=mass, com=com, tensor=tensor))
    return replace(tree, parts=tuple(parts))
