"""The body plan of a tree of hinges: the chain of the axis from front to rear, and the chains of its limbs.

It begins with the mirror plane, the pairs of limbs that it maps onto each other, and which end is the front.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from suchus.core.errors import UnknownName, UnreadableFile
from suchus.robot.design.segment import combine_inertias
from suchus.sim.model.importing.names import NamedFrame, frame_by_names
from suchus.sim.model.importing.tree import Joint, Tree, TreePart


@dataclass(frozen=True, slots=True, kw_only=True)
class Words:
    """Answers to what geometry cannot say; None: guess, and show the guess."""

    front: str | None = None
    """A body at the front end."""
    heading: float | None = None
    """Direction of the front, from the file's x axis to the left [degree]; from its y axis where x points up."""
    up: str | None = None
    """Axis of the file that points up: ``z``, ``y``, ``x``, ``-z``, ``-y`` or ``-x``."""
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
_MIN_ASPECT_RATIO = (
    0.25  # a body shorter than this share of its width is a slender one seen across: the halves of a snake mirror too
)
_STEP = 15  # degrees between the planes that are tried
_LEVEL = 0.999  # cosine of two axes that are one
_FLIP = np.array([1.0, -1.0, 1.0])
_RIVAL_LENGTH = {False: 0.5, True: 0.9}
"""Trunk length of another plane over that of the chosen one, above which it is named; True where names agree [-]."""
_MAX_NAME_ANGLE = 45.0  # degrees between the front by names and the one of a plane that agrees with them


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
    """Headings of other planes that mirror as many hinges, of a trunk of similar length [degree]."""
    disagreements: tuple[str, ...] = ()
    """Sentences on what names and shape say differently, with the option that decides."""

    @property
    def turn(self) -> np.ndarray:
        """Rotation from the file's frame into the robot's, shape (3, 3) [-]."""
        c, s = _level(self.heading)
        return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])

    def to_robot_frame(self, points: np.ndarray) -> np.ndarray:
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
    """Return the mirror plane and what it splits.

    The front that the file's names give comes first; among the planes that agree with it, and where names say nothing,
    it is the plane with most hinges in mirrored branches, then with the longest trunk.

    Args:
        tree: the parts.
        front: a body at the front end; None: guess by names, else along the file's x axis.
        heading: heading of the front, from the file's x axis to the left [degree]; None: guess.

    Raises:
        UnreadableFile: no plane maps enough hinges onto each other.
        UnknownName: there is no such body.
    """
    front_com = None if front is None else _body_com(tree, front)
    scored_planes = [(mapped_fraction(tree, plane), plane) for plane in _candidates(tree, front_com, heading)]
    fit = [(plane, split_by(tree, plane)) for fraction, plane in scored_planes if fraction >= _SHARE]
    if not fit:
        best_fraction = max((fraction for fraction, _ in scored_planes), default=0.0)
        raise UnreadableFile(
            f"no vertical plane mirrors its hinges onto each other (the best one {best_fraction:.0%} of them, "
            f"{_SHARE:.0%} are needed): draw it upright and straight at zero posture, or say --heading, or --up "
            "where another axis than z points up."
        )
    named_frame = frame_by_names(tree)
    named_heading = named_frame.heading if front is None and heading is None else None
    ranks = [_rank(tree, *candidate) for candidate in fit]
    agrees = [named_heading is not None and _is_along(plane, named_heading) for plane, _ in fit]
    best = max(range(len(fit)), key=lambda i: (agrees[i], ranks[i]))
    plane, split = fit[best]
    rivals = {
        candidate.heading
        for (candidate, _), rank, agreement in zip(fit, ranks, agrees, strict=True)
        if agreement == agrees[best] and _close(rank, ranks[best], _RIVAL_LENGTH[agrees[best]])
    }
    plane = replace(plane, rivals=tuple(sorted(rivals - {plane.heading})))
    if heading is not None:
        return plane, split
    sign, certain = _forward(plane, front_com, tree, named_frame)
    if sign < 0:
        plane = replace(plane, heading=plane.heading - 180.0)
        split = replace(split, pairs=tuple((right, left) for left, right in split.pairs))
    if front is None:
        by_shape = fit[ranks.index(max(ranks))][0]
        disagreements = _disagreements(plane, by_shape, named_frame, has_limbs=bool(split.pairs))
        plane = replace(plane, disagreements=disagreements)
    return replace(plane, certain=certain), split


def _is_along(plane: Plane, heading: float) -> bool:
    """Return whether a plane lies along a heading [degree], in either sense."""
    angle = abs((plane.heading - heading + 90.0) % 180.0 - 90.0)
    return angle < _MAX_NAME_ANGLE


def _disagreements(plane: Plane, by_shape: Plane, named_frame: NamedFrame, *, has_limbs: bool) -> tuple[str, ...]:
    """Return sentences on what names and shape say differently, and on names that contradict each other.

    Args:
        plane: the one that was taken, its heading that of the front.
        by_shape: the one that shape alone would choose.
        named_frame: directions that names give.
        has_limbs: whether limbs have sides that could be exchanged.
    """
    sentences = []
    heading = named_frame.heading
    if heading is not None and not _is_along(plane, heading):
        sentences.append(
            f"Names and shape disagree: by names the front is at {heading % 360:.3g} degrees to the left, "
            f"where no plane mirrors the hinges; the shape says {plane.heading % 360:g}. If that is wrong, "
            "say --front BODY or --heading DEGREES."
        )
    elif heading is not None and not _is_along(by_shape, plane.heading):
        shape_headings = " or ".join(f"{(by_shape.heading + turn) % 360:g}" for turn in (0, 180))
        sentences.append(
            f"Names and shape disagree: by shape alone the front would be at {shape_headings} degrees; the names were "
            f"followed. If the shape is right, say --heading {by_shape.heading % 360:g}."
        )
    if named_frame.is_mirrored and has_limbs:
        sentences.append(
            "Names disagree with each other: what they call left lies to the right of what they call front. The front "
            f"was followed and the sides are by place. If the front is wrong, say --heading "
            f"{(plane.heading + 180) % 360:g}."
        )
    return tuple(sentences)


def _candidates(tree: Tree, front_com: np.ndarray | None, heading: float | None) -> Iterator[Plane]:
    """Yield vertical planes through the root or the middle of the hinges; a body at the front lies along them."""
    root = tree.parts[0]
    points = [root.origin, root.com, np.mean([j.anchor for p in tree.parts for j in p.joints], axis=0)]
    for turn in [*range(0, 180, _STEP)] if heading is None else [heading]:
        for point in points:
            plane = Plane(point=point, heading=float(turn), certain=heading is not None)
            front_offset = None if front_com is None else plane.turn @ (front_com - tree.com)
            if front_offset is None or abs(front_offset[1]) <= abs(front_offset[0]):
                yield plane


def _rank(tree: Tree, plane: Plane, split: Split) -> tuple[bool, int, float]:
    """Return the rank of a plane: not across a slender body, hinges in mirrored branches, length of the trunk.

    The trunk is what lies in the plane with the hips beside it. Limbs that are spread to the sides say nothing of it.
    """
    roots = [branch for pair in split.pairs for branch in pair]
    paired = [i for branch in roots for i in tree.subtree(branch)]
    extent = np.ptp(np.concatenate([plane.to_robot_frame(tree_part.corners) for tree_part in tree.parts]), axis=0)
    hips = np.array([tree.parts[branch].joints[0].anchor for branch in roots]).reshape(-1, 3)
    trunk = np.concatenate([*(tree.parts[i].corners for i in split.axis), hips])
    length = float(np.ptp(plane.to_robot_frame(trunk)[:, 0]))
    hinges = sum(len(tree.parts[i].joints) for i in paired)
    return bool(extent[0] >= _MIN_ASPECT_RATIO * extent[1]), hinges, round(length / tree.size, 3)


def _close(first_rank: tuple[bool, int, float], second_rank: tuple[bool, int, float], length_ratio: float) -> bool:
    """Return whether two planes mirror as many hinges, of trunks whose lengths have at least a ratio [-]."""
    shorter, longer = sorted((first_rank[2], second_rank[2]))
    return first_rank[:2] == second_rank[:2] and shorter >= length_ratio * longer


def mapped_fraction(tree: Tree, plane: Plane) -> float:
    """Return the share of the hinges whose mirror image is a hinge."""
    points, lines = _hinge_lines([joint for tree_part in tree.parts for joint in tree_part.joints], plane)
    return float(_meet(points * _FLIP, lines * _FLIP, points, lines, TOLERANCE * tree.size).any(axis=1).mean())


def split_by(tree: Tree, plane: Plane) -> Split:
    """Return which parts lie in a plane and which branches mirror each other."""
    tolerance = TOLERANCE * tree.size
    axis: list[int] = [0]
    branches: list[int] = []
    for index, tree_part in enumerate(tree.parts[1:], 1):
        if tree_part.parent in axis:
            (axis if _is_in_plane(tree_part, plane, tolerance) else branches).append(index)
    hinges = {index: _branch(tree, index, plane) for index in branches}
    pairs, single, open_branches = [], [], list(branches)
    while open_branches:
        branch = open_branches.pop(0)
        twin = next((two for two in open_branches if _twins(hinges[branch], hinges[two], tolerance)), None)
        if twin is None:
            single.append(branch)
            continue
        open_branches.remove(twin)
        lateral = float(np.mean([plane.to_robot_frame(tree.parts[i].com)[1] for i in tree.subtree(branch)]))
        pairs.append((branch, twin) if lateral > 0 else (twin, branch))
    return Split(axis=tuple(axis), pairs=tuple(pairs), single=tuple(single))


def _is_in_plane(tree_part: TreePart, plane: Plane, tolerance: float) -> bool:
    """Return whether a part lies in the plane: its centre of mass, and its hinges but those across the plane."""
    if abs(plane.to_robot_frame(tree_part.com)[1]) > tolerance:
        return False
    return all(
        abs((plane.turn @ j.axis)[1]) > _LEVEL or abs(plane.to_robot_frame(j.anchor)[1]) <= tolerance
        for j in tree_part.joints
    )


def _twins(
    first_branch: tuple[int, np.ndarray, np.ndarray],
    second_branch: tuple[int, np.ndarray, np.ndarray],
    tolerance: float,
) -> bool:
    """Return whether two branches, see ``_branch``, hang on one part and mirror each other hinge by hinge.

    Args:
        first_branch: part that carries it, points and directions of its hinges.
        second_branch: likewise.
        tolerance: greatest distance of mirrored hinges [m].
    """
    (parent, points, lines), (other_parent, other_points, other_lines) = first_branch, second_branch
    if parent != other_parent or len(points) != len(other_points):
        return False
    return bool(_meet(points * _FLIP, lines * _FLIP, other_points, other_lines, tolerance).any(axis=1).all())


def _branch(tree: Tree, index: int, plane: Plane) -> tuple[int, np.ndarray, np.ndarray]:
    """Return the part that a branch hangs on, and the lines of its hinges."""
    joints = [joint for i in tree.subtree(index) for joint in tree.parts[i].joints]
    return tree.parts[index].parent, *_hinge_lines(joints, plane)


def _hinge_lines(joints: Sequence[Joint], plane: Plane) -> tuple[np.ndarray, np.ndarray]:
    """Return points and directions of axes of hinges in the plane's coordinates, each of shape (n, 3)."""
    anchors, axes = (np.array([getattr(j, name) for j in joints]).reshape(-1, 3) for name in ("anchor", "axis"))
    return plane.to_robot_frame(anchors), axes @ plane.turn.T


def _meet(
    points: np.ndarray, lines: np.ndarray, other_points: np.ndarray, other_lines: np.ndarray, tolerance: float
) -> np.ndarray:
    """Return whether each line coincides with each other line, shape (place, other)."""
    gap = points[:, None] - other_points[None]
    distances = gap - np.einsum("ijk,jk->ij", gap, other_lines)[..., None] * other_lines[None]
    return np.asarray((np.abs(lines @ other_lines.T) > _LEVEL) & (np.linalg.norm(distances, axis=-1) < tolerance))


def _forward(plane: Plane, front_com: np.ndarray | None, tree: Tree, named_frame: NamedFrame) -> tuple[float, bool]:
    """Return 1 if the plane's x points forward, else -1, and whether an option or names decide it.

    Args:
        plane: the mirror plane.
        front_com: centre of the body that an option puts in front [m].
        tree: the parts.
        named_frame: directions that names give.
    """
    if front_com is not None:
        return float(np.sign((plane.turn @ (front_com - tree.com))[0]) or 1.0), True
    c, s = _level(plane.heading)
    heading = named_frame.heading
    if heading is not None and _is_along(plane, heading):
        named = np.radians(heading)
        return float(np.sign(c * np.cos(named) + s * np.sin(named))), True
    return (1.0 if c > 1e-9 or (abs(c) <= 1e-9 and s > 0) else -1.0), False


def _body_com(tree: Tree, name: str) -> np.ndarray:
    for tree_part in tree.parts:
        if name in tree_part.names:
            return tree_part.com
    raise UnknownName("body", name, [body_name for tree_part in tree.parts for body_name in tree_part.names])


def _level(degrees: float) -> tuple[float, float]:
    """Return cosine and sine, exact at right angles."""
    exact = {0: (1.0, 0.0), 90: (0.0, 1.0), 180: (-1.0, 0.0), 270: (0.0, -1.0)}
    right_angle = int(degrees % 360) if degrees % 90 == 0 else -1
    return exact.get(right_angle) or (float(np.cos(np.radians(degrees))), float(np.sin(np.radians(degrees))))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LimbChain:
    """A limb: parts from the hip to the foot."""

    axis_index: int
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

    def tree_part(self, index: int) -> TreePart:
        """Return a part of the tree."""
        return self.tree.parts[index]


def plan_of(tree: Tree, words: Words) -> BodyPlan:
    """Return the body plan of a tree.

    Raises:
        UnreadableFile: it has no mirror plane, or its root is a limb.
        UnknownName: a body that was named is not there.
    """
    tree, remarks = _pruned(tree, words.leave)
    plane, split = find_plane(tree, front=words.front, heading=words.heading)
    axis = _chain(tree, plane, split.axis, words)
    remarks += _remarks_on_front(plane, tree.reference_axis)
    pairs, dropped_branches = [], [(i, "no mirror image") for i in split.single]
    for left_root, right_root in split.pairs:
        carrier = tree.parts[left_root].parent
        if carrier not in axis:
            dropped_branches += [(i, "hangs beside the axis") for i in (left_root, right_root)]
            continue
        left_path, right_path = (_main(tree, plane, limb_root) for limb_root in (left_root, right_root))
        pairs.append(
            (
                LimbChain(axis_index=axis.index(carrier), parts=left_path),
                LimbChain(axis_index=axis.index(carrier), parts=right_path),
            )
        )
    if not pairs and len(axis) == 1:
        single_names = ", ".join(tree.parts[i].name for i, _ in dropped_branches[:4])
        image = f"; {single_names} have no mirror image" if single_names else ""
        raise UnreadableFile(
            f"no mirrored limbs and no hinges along an axis were found{image}: draw it upright and straight at zero "
            "posture, or say --heading, or --up where another axis than z points up."
        )
    plan_parts = {*axis, *(i for pair in pairs for chain in pair for i in chain.parts)}
    omitted_roots = [
        i for i in range(len(tree.parts)) if i not in plan_parts and (tree.parts[i].parent in plan_parts or i == 0)
    ]
    reasons = dict(dropped_branches)
    for i in omitted_roots:
        names = [tree.parts[k].name for k in tree.subtree(i) if k not in plan_parts]
        reason = reasons.get(i) or ("in the middle, but not between front and rear" if i in split.axis else "a fork")
        remarks.append(
            f"{', '.join(names[:4])}{' ...' if len(names) > 4 else ''} was left out ({reason}); its mass went to the "
            f"part that carries it. {'See --neck and --tail.' if i in split.axis else ''}".rstrip()
        )
    hips = {pair: plane.to_robot_frame(tree.parts[pair[0].parts[0]].joints[0].anchor)[0] for pair in pairs}
    return BodyPlan(
        tree=_lumped(tree, plan_parts),
        plane=plane,
        axis=axis,
        pairs=tuple(sorted(pairs, key=lambda pair: -hips[pair])),
        remarks=(*tree.remarks, *remarks),
    )


def without_limbs(plan: BodyPlan, pair: tuple[LimbChain, LimbChain]) -> BodyPlan:
    """Return a plan without a pair of limbs, whose mass goes to the part that carries them."""
    pairs = tuple(limb_pair for limb_pair in plan.pairs if limb_pair is not pair)
    plan_parts = {*plan.axis, *(i for limb_pair in pairs for chain in limb_pair for i in chain.parts)}
    return replace(plan, tree=_lumped(plan.tree, plan_parts), pairs=pairs)


def links_between(plan: BodyPlan, inner: int, outer: int) -> Iterator[tuple[Joint, bool]]:
    """Yield the hinges between two neighbours of the axis from the one near our root on.

    Each comes with whether its positive turn moves the far part as in the file, and not the near one.

    Args:
        plan: the body plan.
        inner: index of the part nearer to the robot's root.
        outer: index of the other part.
    """
    if plan.tree_part(outer).parent == inner:
        for joint in plan.tree_part(outer).joints:
            yield joint, True
    else:
        for joint in reversed(plan.tree_part(inner).joints):
            yield joint, False


def _remarks_on_front(plane: Plane, reference_axis: str) -> list[str]:
    """Return sentences on which end is the front and on other planes of symmetry.

    Args:
        plane: the mirror plane.
        reference_axis: reference axis of the file, from which headings count.
    """
    axis_text, heading = f"the file's {reference_axis} axis", round(plane.heading, 6) % 360
    directions = {0.0: f"along {axis_text}", 180.0: f"against {axis_text}"}
    heading_text = directions.get(heading, f"{axis_text} turned left by {heading:g} degrees")
    opposite_heading = (plane.heading + 180) % 360
    if plane.certain:
        remarks = [f"Front: {heading_text}, as names or options say (--front, --heading)."]
    else:
        remarks = [
            f"Guess: the front is {heading_text}; if it is the rear, say --front BODY or --heading "
            f"{opposite_heading:g}."
        ]
    if plane.rivals:
        rival_text = " or ".join(f"{(heading + turn) % 360:g}" for heading in plane.rivals for turn in (0, 180))
        remarks.append(
            f"Guess: its sides mirror as well about another plane; if that is the right one, --heading {rival_text}."
        )
    remarks += plane.disagreements
    return remarks


def _pruned(tree: Tree, names: Sequence[str]) -> tuple[Tree, list[str]]:
    """Return a tree without the branches of some bodies, whose masses go to the parts that carry them."""
    removed_parts: set[int] = set()
    for name in names:
        index = next((i for i, tree_part in enumerate(tree.parts) if name in tree_part.names), None)
        if index is None:
            raise UnknownName("body", name, [body_name for tree_part in tree.parts for body_name in tree_part.names])
        if index == 0:
            raise UnreadableFile(f"--leave {name} is the root, which carries everything; name a branch.")
        removed_parts |= set(tree.subtree(index))
    if not removed_parts:
        return tree, []
    remaining_parts = [i for i in range(len(tree.parts)) if i not in removed_parts]
    lighter = _lumped(tree, set(remaining_parts))
    parts = tuple(
        replace(lighter.parts[i], parent=-1 if i == 0 else remaining_parts.index(tree.parts[i].parent))
        for i in remaining_parts
    )
    names_text = ", ".join(tree.parts[i].name for i in sorted(removed_parts))
    remark = f"Left out as asked, their masses lent to what carries them: {names_text}."
    return replace(tree, parts=parts), [remark]


def _chain(tree: Tree, plane: Plane, plane_parts: Sequence[int], words: Words) -> tuple[int, ...]:
    """Return the path through the parts in the plane from the foremost to the hindmost one."""
    ends = {i: plane.to_robot_frame(tree.parts[i].corners)[:, 0] for i in plane_parts}
    front = (
        _place(tree, words.neck, plane_parts) if words.neck else max(plane_parts, key=lambda i: float(ends[i].max()))
    )
    rear = _place(tree, words.tail, plane_parts) if words.tail else min(plane_parts, key=lambda i: float(ends[i].min()))
    front_path, rear_path = _upward(tree, front), _upward(tree, rear)
    meet = next(i for i in front_path if i in rear_path)
    return (*front_path[: front_path.index(meet)], *reversed(rear_path[: rear_path.index(meet) + 1]))


def _place(tree: Tree, name: str, plane_parts: Sequence[int]) -> int:
    """Return the index of the part in the mirror plane that has a body of a name."""
    for i in plane_parts:
        if name in tree.parts[i].names:
            return i
    raise UnknownName(
        "body in the mirror plane", name, [body_name for i in plane_parts for body_name in tree.parts[i].names]
    )


def _upward(tree: Tree, index: int) -> list[int]:
    path = [index]
    while tree.parts[path[-1]].parent >= 0:
        path.append(tree.parts[path[-1]].parent)
    return path


def _main(tree: Tree, plane: Plane, limb_root: int) -> tuple[int, ...]:
    """Return the path from a hip to the end of the branch that has most hinges, the lowest of those alike."""

    def rank(index: int) -> tuple[int, float]:
        path = [i for i in _upward(tree, index) if i >= limb_root]
        hinges = sum(len(tree.parts[i].joints) for i in path)
        return hinges, -float(plane.to_robot_frame(tree.parts[index].corners)[:, 2].min())

    branch = tree.subtree(limb_root)
    end = max((i for i in branch if not any(tree.parts[k].parent == i for k in branch)), key=rank)
    return tuple(i for i in reversed(_upward(tree, end)) if i in branch)


def _lumped(tree: Tree, plan_parts: set[int]) -> Tree:
    """Return a tree in which parts that are not used have no mass, and those that carry them have it all."""
    masses = [[(tree_part.mass, tree_part.com, tree_part.tensor)] for tree_part in tree.parts]
    for i in range(len(tree.parts) - 1, 0, -1):
        if i not in plan_parts:
            masses[tree.parts[i].parent] += masses[i]
            masses[i] = []
    for i in range(len(tree.parts)):  # what lies above the axis hands its mass down
        child = next((k for k in tree.children(i) if plan_parts & set(tree.subtree(k))), None)
        if i not in plan_parts and child is not None:
            masses[child] += masses[i]
            masses[i] = []
    parts = []
    for tree_part, part_masses in zip(tree.parts, masses, strict=True):
        mass, com, tensor = combine_inertias(part_masses or [(0.0, tree_part.com, np.zeros((3, 3)))])
        parts.append(replace(tree_part, mass=mass, com=com, tensor=tensor))
    return replace(tree, parts=tuple(parts))
