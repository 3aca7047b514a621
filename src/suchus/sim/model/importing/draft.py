"""From a body plan to a robot as data, each guess with its reason: first its axis, then its limbs.

The left limb is the pattern of a pair.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.robot.design import Foot, Girdle, Hinge, Limb, Link, Robot, Rod, Segment, Shell, layout
from suchus.robot.design.hinge import Turn
from suchus.robot.design.scale import contact_for
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.sim.model.build import compile_model
from suchus.sim.model.importing.making import (
    Making,
    Match,
    axial_sign,
    axis_names,
    hinge_of,
    limb_names,
    limb_turn,
    making_of,
    numbered,
    point,
    turn_of,
)
from suchus.sim.model.importing.plan import BodyPlan, LimbChain, Words, links_between, without
from suchus.sim.model.importing.tree import JOINED, Joint, ShapePiece, TreePart

_LEG = 0.03  # of the robot's length that a leg reaches below the axis, at least
_CONTACT = {
    "foot_friction": "guess: a rubber foot on a floor; contact is not taken from the file",
    "skin_friction": "guess: a smooth skin on a floor",
    "time_constant": "guess: from the length, as torsion, rolling and depth (design.contact_for)",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Draft:
    """A robot read from a file of another tool."""

    robot: Robot
    """The robot."""
    matches: tuple[Match, ...]
    """Each hinge of the robot and the one of the file, in the order of the robot's layout."""
    remarks: tuple[str, ...]
    """What was guessed and what was not taken, in sentences."""
    notes: Mapping[str, str]
    """Guesses, by the place of the number in the robot's file, as ``girdles[0].limb.foot.radius``."""


def draft_of(plan: BodyPlan, name: str, words: Words) -> Draft:
    """Return the robot of a body plan.

    Args:
        plan: axis and limbs.
        name: of the robot.
        words: what the user said.

    Raises:
        UnreadableFile: the plan is none that a robot can have; the message says why.
    """
    try:
        plan, arms = _legs(plan, words)
        if not plan.pairs and len(plan.axis) == 1:
            raise UnreadableFile(f"nothing is left that could move: {arms[0]}")
        making = making_of(plan, words)
        girdles = [draft_girdle(making, i) for i in range(len(plan.pairs))]
        axis, root, ends = draft_axis(making)
        robot = Robot(
            name=name,
            root=root,
            axis=axis,
            girdles=tuple(
                _seated(girdle, axis[left.on].name, ends[left.on])
                for girdle, (left, _) in zip(girdles, plan.pairs, strict=True)
            ),
            cables=(),
            contact=contact_for(ends[0] - ends[-1], foot_friction=0.8, skin_friction=0.4),
        )
    except InvalidDesign as error:
        raise UnreadableFile(f"the file gives no robot that can be: {error}") from error
    robot, needless = _without_needless(robot)
    order = layout(robot).hinges
    notes = {place: text for place, text in making.notes.items() if place not in needless}
    return Draft(
        robot=robot,
        matches=tuple(sorted(making.matches, key=lambda match: order.index(match.ours))),
        remarks=(*plan.remarks, *dict.fromkeys([*arms, *making.remarks, *_balance(making, robot)])),
        notes=notes | {f"contact.{key}": text for key, text in _CONTACT.items()},
    )


_SAME = 1e-9  # of an inertia and of the length; what shapes give so nearly need not be stated


def _without_needless(robot: Robot) -> tuple[Robot, set[str]]:
    """Return a robot without the inertias that its shapes have anyway, and the places of their notes."""

    def bared(girdle: Girdle, keep: set[str]) -> Girdle:
        links = tuple(
            one if f"L{girdle.name}_{one.name}" in keep else replace(one, inertia=None) for one in girdle.limb.links
        )
        return replace(girdle, limb=replace(girdle.limb, links=links))

    def kept(keep: set[str]) -> Robot:
        axis = tuple(one if one.name in keep else replace(one, inertia=None) for one in robot.axis)
        return replace(robot, axis=axis, girdles=tuple(bared(girdle, keep) for girdle in robot.girdles))

    stated, bare = compile_model(robot), compile_model(kept(set()))
    apart = {
        body.name
        for body in layout(robot).bodies
        if body.inertia is not None and not _alike(stated, bare, body.name, robot.length)
    }
    places = {one.name: f"axis[{i}]" for i, one in enumerate(robot.axis)}
    for i, girdle in enumerate(robot.girdles):
        places |= {f"L{girdle.name}_{one.name}": f"girdles[{i}].limb.links[{k}]"
                   for k, one in enumerate(girdle.limb.links)}  # fmt: skip
    return kept(apart), {f"{place}.inertia.moments" for name, place in places.items() if name not in apart}


def _alike(one: Any, two: Any, body: str, length: float) -> bool:
    """Return whether a body of two models has its mass in the same places."""
    (place, tensor), (other, another) = (_weighed(model, body) for model in (one, two))
    near = np.linalg.norm(place - other) <= _SAME * length
    return bool(near and np.abs(tensor - another).max() <= _SAME * np.abs(tensor).max())


def _weighed(model: Any, body: str) -> tuple[np.ndarray, np.ndarray]:
    held = model.body(body)
    turn = Rotation.from_quat(held.iquat, scalar_first=True).as_matrix()
    return held.ipos, turn @ np.diag(held.inertia) @ turn.T


def _legs(plan: BodyPlan, words: Words) -> tuple[BodyPlan, list[str]]:
    """Return a plan without limbs that do not reach below the axis, and what is noted of them."""
    remarks = []
    for number in reversed(range(len(plan.pairs))):
        making = making_of(plan, words)
        depth = -lowest(draft_girdle(making, number))
        if depth < _LEG * making.size.length:
            pair = plan.pairs[number]
            parts = " and ".join(plan.part(chain.parts[0]).name for chain in pair)
            remarks.append(
                f"{parts} reach {max(depth, 0.0):.3g} m below the axis, so they are arms or fins and were left out; "
                "their masses went to the part that carries them."
            )
            plan = without(plan, pair)
    return plan, remarks


def _seated(girdle: Girdle, segment: str, front: float) -> Girdle:
    """Return a girdle on its segment, whose front end, its origin, lies at a place along the body [m]."""
    return replace(girdle, segment=segment, at=girdle.at - front)


def _balance(making: Making, robot: Robot) -> list[str]:
    """Say what the draft does to masses: moments of inertia follow from shapes, and the rest from this."""
    lost = abs(robot.mass / making.plan.tree.mass - 1.0)
    if lost > 1e-6:
        return [f"The draft weighs {robot.mass:.4g} kg, the file {np.round(making.plan.tree.mass, 6):g} kg."]
    return []


_END = "guess: the farthest point of its shapes, frames, joints and hips"
_THIN = 0.1  # radius of a segment or link without a shape, over its length
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
        inertia = making.inertia(f"axis[{i}]", [part], np.array([ends[i], 0.0, 0.0]))
        segments.append(
            Segment(name=part.name, front=0.0, rear=length, shapes=shapes, hinges=hinges[i], inertia=inertia)
        )
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
    hinges = []
    for joint, onward in links_between(making.plan, near, far):
        turn, sense = turn_of(joint, making.turned(joint.axis), making.remarks)
        off = 0.0 if turn == "yaw" else abs(float(making.into(joint.anchor)[2]))
        hinges.append((joint, turn, axial_sign(turn, sense, ahead=ahead, onward=onward), off))
    return hinges


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
    shapes: list[Rod | Shell] = []
    for i, piece in enumerate(inside):
        name = part.name if i == 0 else f"{part.name}_{i + 1}"
        mass = part.mass * piece.volume / volume
        points = making.into(piece.ends) - start
        half = _half(making, piece)
        if len(points) == 2:
            shapes.append(Rod(name=name, start=point(points[0]), end=point(points[1]), radius=half[0], mass=mass))
        else:
            shapes.append(Shell(name=name, at=point(points[0]), half=half, mass=mass))
        if len(inside) > 1:
            making.notes[f"{place}[{i}].mass"] = "guess: the segment's mass shared among its shapes by volume"
    return tuple(shapes)


def _half(making: Making, piece: ShapePiece) -> tuple[float, float, float]:
    """Return half axes in the robot's frame; where that is turned, those of the box around [m]."""
    turned = np.abs(making.plan.plane.turn) @ piece.half
    return point(piece.half if len(piece.ends) == 2 else turned)


def _overlaps(making: Making, piece: ShapePiece, front: float, length: float) -> bool:
    along = making.into(piece.corners)[:, 0]
    return bool(along.min() <= front and along.max() >= front - length)


_NAMES = {1: "H", 2: "FH", 3: "FMH"}
_FOOT = 0.08  # radius of a foot, over the limb's reach
_FOOT_SHARE = 0.1  # of the last link's mass
_POINT = 1e-6  # m; hinges nearer to each other sit in one point
_ASIDE = 1e-5  # m; of a hip's distance from the midline
_ALIKE = 0.01  # of the size, or rad; sides that differ by more are noted
_POSTURES = 256


def draft_girdle(making: Making, number: int) -> Girdle:
    """Return a girdle, its place along the body still from the origin of the robot's frame.

    Raises:
        UnreadableFile: left and right have other hinges, or a hinge is skew.
    """
    left, right = making.plan.pairs[number]
    joints, others = ([j for i in chain.parts for j in making.plan.part(i).joints] for chain in (left, right))
    count = len(making.plan.pairs)
    name = _NAMES[count][number] if count in _NAMES else f"G{number + 1}"
    turns = [limb_turn(joint, making.turned(joint.axis), 1.0, making.remarks) for joint in joints]
    across = [limb_turn(joint, making.turned(joint.axis), -1.0, making.remarks) for joint in others]
    if [turn for turn, _ in turns] != [turn for turn, _ in across]:
        raise UnreadableFile(f"the limbs of {joints[0].name} and {others[0].name} have their hinges in another order.")
    labels = limb_names([j.name for j in joints], [j.name for j in others], name) or numbered([t for t, _ in turns])
    _tell_sides(making, (joints, others), [s for _, s in turns], [s for _, s in across])
    for side, those, signs in (("L", joints, turns), ("R", others, across)):
        making.matches += [
            Match(ours=f"{side}{name}_{label}", theirs=joint.name, sign=sign, zero=joint.zero)
            for label, joint, (_, sign) in zip(labels, those, signs, strict=True)
        ]
    hip = making.into(making.hip(left))
    if hip[1] < _ASIDE:
        where = f"the draft has them {_ASIDE:g} m beside it"
        making.remarks.append(f"The hips of girdle {name} lie in the midline; {where}.")
    limb = _limb(making, left, turns, labels, f"girdles[{number}].limb")
    return Girdle(
        name=name, segment="-", at=float(hip[0]), aside=max(float(hip[1]), _ASIDE), above=float(hip[2]), limb=limb
    )


def lowest(girdle: Girdle) -> float:
    """Return the height above the axis of the lowest point that a limb's foot reaches within its ranges [m]."""
    low, high = np.array([hinge.range or (-np.pi, np.pi) for hinge in girdle.limb.hinges]).T
    angles = np.random.default_rng(0).uniform(low, high, (_POSTURES, len(low)))
    return float(limb_kinematics.forward(girdle.limb, angles)[:, 2].min()) + girdle.above


def _limb(making: Making, chain: LimbChain, turns: list[tuple[Turn, float]], labels: list[str], place: str) -> Limb:
    """Return the left limb: hinges in one point share a link, whose mass is that of the parts up to the next point."""
    parts = [making.plan.part(i) for i in chain.parts]
    stations: list[tuple[np.ndarray, list[tuple[int, Joint]], list[TreePart]]] = []
    number = 0
    for part in parts:
        for joint in part.joints:
            anchor = making.into(joint.anchor)
            if not stations or np.linalg.norm(anchor - stations[-1][0]) > _POINT:
                stations.append((anchor, [], []))
            stations[-1][1].append((number, joint))
            number += 1
        stations[-1][2].append(part)
    foot, radius = _foot(making, parts, stations[-1][0], place)
    ends = [*(anchor for anchor, _, _ in stations[1:]), foot]
    links = []
    for i, ((anchor, hinges, carried), end) in enumerate(zip(stations, ends, strict=True)):
        link = f"{place}.links[{i}]"
        made = []
        for k, (n, joint) in enumerate(hinges):
            turn, sign = turns[n]
            hinge = hinge_of(labels[n], turn, sign, joint, making.size, 1.0, lone=len(turns) == 1)
            making.note_hinge(f"{link}.hinges[{k}]", hinge, joint, sign)
            made.append(hinge)
        mass = sum(part.mass for part in carried) or 1e-3 * making.size.mass
        if not carried:
            making.notes[f"{link}.mass"] = "guess: a thousandth of the robot; the file has none between these hinges"
        last = i == len(stations) - 1
        links.append(
            Link(
                name=_link_name(carried, i, chain, making),
                hinges=tuple(made),
                end=point(end - anchor),
                radius=_radius(making, carried, float(np.linalg.norm(end - anchor)), f"{link}.radius"),
                mass=mass * (1.0 - _FOOT_SHARE) if last else mass,
                inertia=making.inertia(link, carried, anchor),
            )
        )
    feet = _FOOT_SHARE / (1.0 - _FOOT_SHARE) * links[-1].mass
    making.notes[f"{place}.foot.mass"] = "guess: a tenth of the last link's mass"
    if making.words.foot_radius is not None:
        radius = making.words.foot_radius
        making.notes[f"{place}.foot.radius"] = "as asked (--foot-radius)"
    return Limb(links=tuple(links), foot=Foot(radius=radius, mass=feet))


def _link_name(carried: list[TreePart], number: int, chain: LimbChain, making: Making) -> str:
    """Return the name of a link: that of its part without the limb's, if it is called so."""
    names = [making.plan.part(i).name for i in chain.parts]
    own = carried[-1].name if carried else ""
    head, found, tail = own.partition("_")
    alike = all(name.partition("_")[0] == head for name in names)
    unique = sum(name.partition("_")[2] == tail for name in names) == 1
    return tail if found and tail and alike and unique else f"link_{number + 1}"


def _foot(making: Making, parts: list[TreePart], knee: np.ndarray, place: str) -> tuple[np.ndarray, float]:
    """Return the foot's centre in the robot's frame [m] and its radius [m]."""
    last = parts[-1]
    balls = [(making.into(piece.centre), float(piece.half[0])) for piece in last.pieces if piece.ball]
    rods = [(making.into(end), float(p.half[0])) for p in last.pieces if len(p.ends) == 2 for end in p.ends]
    for found, why in ((balls, ""), (rods, "guess: the round end of the link's rod")):
        far = [one for one in found if np.linalg.norm(one[0] - knee) > _POINT]
        if far:
            if why:
                making.notes[f"{place}.foot.radius"] = why
            return max(far, key=lambda one: float(np.linalg.norm(one[0] - knee)) + one[1])
    reach = sum(float(np.linalg.norm(two.joints[0].anchor - one.joints[0].anchor)) for one, two in pairwise(parts))
    ends = [making.into(point) for point in (*last.points, *(c for p in last.pieces for c in p.corners))]
    far_end = max(ends, key=lambda end: float(np.linalg.norm(end - knee)), default=knee)
    if np.linalg.norm(far_end - knee) < max(0.1 * reach, _POINT):
        far_end = knee - np.array([0.0, 0.0, reach or 0.2 * making.size.length])
        making.remarks.append(
            f"Nothing of the file says how far {last.name} reaches beyond its joint; the draft has its foot "
            f"{knee[2] - far_end[2]:.3g} m below."
        )
        making.notes[f"{place}.links[{len(parts) - 1}].end"] = "guess: straight down, as long as the links before it"
    elif last.pieces:
        middle = np.mean([making.into(piece.centre) for piece in last.pieces], axis=0)
        far_end = np.array([*middle[:2], far_end[2]]) if abs(far_end[2] - knee[2]) > _POINT else far_end
        making.remarks.append(f"{last.name} has no ball for a foot; the draft has the foot at its farthest end.")
    radius = _FOOT * max(reach + float(np.linalg.norm(far_end - knee)), _POINT)
    making.notes[f"{place}.foot.radius"] = "guess: a twelfth of the limb's reach; see --foot-radius"
    return far_end, max(radius, 1e-5)


def _radius(making: Making, carried: list[TreePart], length: float, place: str) -> float:
    """Return the radius of a link: of its thickest rod, else from the box around its shapes, else from its length."""
    pieces = [piece for part in carried for piece in part.pieces]
    rods = [float(piece.half[0]) for piece in pieces if len(piece.ends) == 2]
    if rods:
        return max(rods)
    making.notes[place] = "guess: from its shapes" if pieces else "guess: a tenth of its length"
    return max(min([float(np.sort(piece.half)[0]) for piece in pieces], default=_THIN * length), 1e-5)


def _tell_sides(
    making: Making, joints: tuple[list[Joint], list[Joint]], ours: list[float], theirs: list[float]
) -> None:
    """Say where the right limb is no exact mirror image of the left one."""
    for one, two, a, b in zip(*joints, ours, theirs, strict=True):
        gap = making.into(one.anchor) * np.array([1.0, -1.0, 1.0]) - making.into(two.anchor)
        line = making.turned(two.axis)
        off = float(np.linalg.norm(gap - (gap @ line) * line))
        if off > _ALIKE * making.size.length:
            making.remarks.append(
                f"{two.name} lies {off:.3g} m off the mirror image of {one.name}; the draft has the image."
            )
        if one.range and two.range:
            left, right = (sorted(sign * end for end in r) for sign, r in ((a, one.range), (b, two.range)))
            if np.abs(np.subtract(left, right)).max() > _ALIKE:
                which = f"{two.name} has another range than {one.name}"
                making.remarks.append(f"{which}; the draft has the left one on both.")
