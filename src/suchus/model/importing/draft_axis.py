"""The axis of a robot that is drafted from a file: segments, their shapes and hinges."""

from collections.abc import Sequence

import numpy as np

from suchus.design import Hinge, Rod, Segment, Shell
from suchus.design.hinge import Turn
from suchus.errors import UnreadableFile
from suchus.model.importing.draft_hinges import Match, axial_sign, axis_names, hinge_of, turn_of
from suchus.model.importing.making import Making, point
from suchus.model.importing.plan import BodyPlan, links_between
from suchus.model.importing.shapes import ShapePiece
from suchus.model.importing.tree import JOINED, Joint, TreePart

_END = "guess: the farthest point of its shapes, frames, joints and hips"
_THIN = 0.1  # radius of a segment without a shape, over its length
_LEAST = 1e-3  # of the robot's length; of a segment at an end that nothing of it reaches beyond its joint

Found = tuple[Joint, Turn, float, float]
"""A hinge of the file, what it turns, its sign, and how far it lies off the axis [m]."""


def draft_axis(making: Making) -> tuple[tuple[Segment, ...], str, list[float]]:
    """Return the segments, the name of the root, and where segments begin and end along x from the snout on [m].

    Raises:
        UnreadableFile: the axis is not drawn stretched.
    """
    plan = making.plan
    parts = [plan.part(i) for i in plan.axis]
    root = plan.pairs[-1][0].on if plan.pairs else _free_root(plan)
    groups = [_joints(making, i, root) for i in range(len(parts) - 1)]
    places = [float(np.mean([making.into(joint.anchor)[0] for joint, *_ in group])) for group in groups]
    ends = _ends(making, parts, places)
    _tell_offsets(making, groups, places)
    hinges = _hinges(making, groups, root)
    segments = []
    for i, part in enumerate(parts):
        length = ends[i] - ends[i + 1]
        if length <= 1e-6:
            raise UnreadableFile(
                f"{part.name} is {length:.3g} m long from its front joint to its rear one; the axis must be drawn "
                "stretched, from the front to the rear, at zero posture."
            )
        shapes = _shapes(making, part, ends[i], length, i)
        segments.append(Segment(name=part.name, front=0.0, rear=length, shapes=shapes, hinges=hinges[i]))
    making.notes["axis[0].rear"] = making.notes[f"axis[{len(parts) - 1}].rear"] = _END
    making.notes["root"] = "the hindmost girdle's segment" if plan.pairs else "guess: the file's root, or the middle"
    return tuple(segments), parts[root].name, ends


def _hinges(making: Making, groups: Sequence[Sequence[Found]], root: int) -> list[tuple[Hinge, ...]]:
    """Return the hinges behind each segment."""
    plan = making.plan
    front = plan.pairs[0][0].on if plan.pairs else 0
    words = ["tail" if i >= root else "neck" if i < front else "spine" for i in range(len(groups))]
    order = [*range(root - 1, -1, -1), *range(root, len(groups))]
    flat = [(i, *one) for i in order for one in groups[i]]
    names = axis_names([(turn, words[i], joint.name) for i, joint, turn, _, _ in flat])
    made: list[list[Hinge]] = [[] for _ in plan.axis]
    for (i, joint, turn, sign, _), name in zip(flat, names, strict=True):
        carried = plan.part(plan.axis[i if i < root else i + 1])
        hinge = hinge_of(name, turn, sign, joint, making.size, carried.mass / making.heaviest, lone=False)
        making.note_hinge(f"axis[{i}].hinges[{len(made[i])}]", hinge, joint, sign)
        making.matches.append(Match(ours=name, theirs=joint.name, sign=sign, zero=joint.zero))
        made[i].append(hinge)
    return [tuple(group) for group in made]


def _free_root(plan: BodyPlan) -> int:
    return plan.axis.index(0) if 0 in plan.axis else len(plan.axis) // 2


def _joints(making: Making, i: int, root: int) -> list[Found]:
    """Return the hinges behind segment i from our root on."""
    axis, ahead = making.plan.axis, i < root
    near, far = (axis[i + 1], axis[i]) if ahead else (axis[i], axis[i + 1])
    found = []
    for joint, onward in links_between(making.plan, near, far):
        turn, sense = turn_of(joint, making.turned(joint.axis), making.remarks)
        off = 0.0 if turn == "yaw" else abs(float(making.into(joint.anchor)[2]))
        found.append((joint, turn, axial_sign(turn, sense, ahead=ahead, onward=onward), off))
    return found


def _ends(making: Making, parts: list[TreePart], places: list[float]) -> list[float]:
    """Return where segments begin and end along x, from the snout to the tip of the tail [m]."""
    limbs = [chain for pair in making.plan.pairs for chain in pair]

    def reach(at: int) -> list[float]:
        hips = [float(making.into(making.hip(chain))[0]) for chain in limbs if chain.on == at]
        return [*making.into(parts[at].corners)[:, 0].tolist(), *hips]

    front, rear = max(reach(0)), min(reach(len(parts) - 1))
    least = _LEAST * making.size.length
    if places:
        front, rear = max(front, places[0] + least), min(rear, places[-1] - least)
    return [front, *places, rear]


def _tell_offsets(making: Making, groups: Sequence[Sequence[Found]], places: list[float]) -> None:
    """Say which hinges do not lie on the straight axis, and by how much they were moved."""
    moved = [(off, j.name) for group in groups for j, _, _, off in group]
    for group, place in zip(groups, places, strict=True):
        moved += [(abs(float(making.into(j.anchor)[0]) - place), j.name) for j, turn, _, _ in group if turn != "roll"]
    worst = max(moved, default=(0.0, ""))
    if worst[0] > JOINED * making.size.length:
        making.remarks.append(
            f"The axis of a robot is straight here: hinges of the file lie up to {worst[0]:.3g} m off it ({worst[1]}) "
            "and were moved onto it."
        )


def _shapes(making: Making, part: TreePart, front: float, length: float, number: int) -> tuple[Rod | Shell, ...]:
    """Return a segment's shapes, its mass shared among them by volume."""
    start = np.array([front, 0.0, 0.0])
    place = f"axis[{number}].shapes"
    inside = [piece for piece in part.pieces if _overlaps(making, piece, front, length)]
    volume = sum(piece.volume for piece in inside)
    if not inside or volume <= 0:
        making.notes[f"{place}[0].radius"] = "guess: a tenth of the segment's length; the file has no shape for it"
        making.remarks.append(f"{part.name} has no shape that is read; the draft gives it a rod.")
        radius = min(max(_THIN * length, 1e-5), 10.0)
        return (Rod(name=part.name, start=(0.0, 0.0, 0.0), end=(-length, 0.0, 0.0), radius=radius, mass=part.mass),)
    found: list[Rod | Shell] = []
    for i, piece in enumerate(inside):
        name = part.name if i == 0 else f"{part.name}_{i + 1}"
        mass = part.mass * piece.volume / volume
        points = making.into(piece.ends) - start
        half = _half(making, piece)
        if len(points) == 2:
            found.append(Rod(name=name, start=point(points[0]), end=point(points[1]), radius=half[0], mass=mass))
        else:
            found.append(Shell(name=name, at=point(points[0]), half=half, mass=mass))
        if len(inside) > 1:
            making.notes[f"{place}[{i}].mass"] = "guess: the segment's mass shared among its shapes by volume"
    return tuple(found)


def _half(making: Making, piece: ShapePiece) -> tuple[float, float, float]:
    """Return half axes in the robot's frame; where that is turned, those of the box around [m]."""
    turned = np.abs(making.plan.plane.turn) @ piece.half
    return point(piece.half if len(piece.ends) == 2 else turned)


def _overlaps(making: Making, piece: ShapePiece, front: float, length: float) -> bool:
    along = making.into(piece.corners)[:, 0]
    return bool(along.min() <= front and along.max() >= front - length)
