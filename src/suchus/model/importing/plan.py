"""The body plan of a tree of hinges: the chain of the axis from front to rear, and the chains of its limbs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from suchus.errors import UnknownName, UnreadableFile
from suchus.model.importing.options import Words
from suchus.model.importing.symmetry import Plane, find_plane
from suchus.model.importing.tree import Joint, Tree, TreePart


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
    pairs = tuple(one for one in plan.pairs if one is not pair)
    used = {*plan.axis, *(i for one in pairs for chain in one for i in chain.parts)}
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
    kept = [i for i in range(len(tree.parts)) if i not in gone]
    lighter = _lumped(tree, set(kept))
    parts = tuple(replace(lighter.parts[i], parent=-1 if i == 0 else kept.index(tree.parts[i].parent)) for i in kept)
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
    found = [place]
    while tree.parts[found[-1]].parent >= 0:
        found.append(tree.parts[found[-1]].parent)
    return found


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
    mass = [part.mass for part in tree.parts]
    moment = [part.mass * part.com for part in tree.parts]
    for i in range(len(tree.parts) - 1, 0, -1):
        if i not in used:
            above = tree.parts[i].parent
            mass[above], moment[above] = mass[above] + mass[i], moment[above] + moment[i]
            mass[i], moment[i] = 0.0, 0.0 * moment[i]
    for i in range(len(tree.parts)):  # what lies above the axis hands its mass down
        onward = next((k for k in tree.children(i) if used & set(tree.below(k))), None)
        if i not in used and onward is not None:
            mass[onward], moment[onward] = mass[onward] + mass[i], moment[onward] + moment[i]
            mass[i], moment[i] = 0.0, 0.0 * moment[i]
    return replace(
        tree,
        parts=tuple(
            replace(part, mass=m, com=w / m if m > 0 else part.com)
            for part, m, w in zip(tree.parts, mass, moment, strict=True)
        ),
    )
