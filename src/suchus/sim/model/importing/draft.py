"""From a body plan to a robot as data, each guess with its reason: first its axis, then its limbs.

The left limb is the pattern of a pair.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.linalg import null_space
from scipy.spatial.transform import Rotation

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.robot.design import Foot, Girdle, Hinge, Limb, Link, Robot, Rod, Segment, Shell, layout
from suchus.robot.design.hinge import Turn
from suchus.robot.design.scale import contact_for
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.sim.model.build import compile_model
from suchus.sim.model.importing.cleaning import Drive
from suchus.sim.model.importing.making import (
    DraftState,
    Match,
    axial_sign,
    axis_names,
    empty_draft,
    hinge_of,
    limb_names,
    limb_turn,
    numbered_names,
    point,
    turn_of,
)
from suchus.sim.model.importing.names import is_fin_name
from suchus.sim.model.importing.plan import BodyPlan, LimbChain, Words, links_between, without_limbs
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
        name: name of the robot.
        words: what the user said.

    Raises:
        UnreadableFile: the plan is none that a robot can have; the message says why.
    """
    try:
        plan, arms = _legs(plan, words)
        if not plan.pairs and len(plan.axis) == 1:
            raise UnreadableFile(f"nothing is left that could move: {arms[0]}")
        state = empty_draft(plan, words)
        girdles = [draft_girdle(state, i) for i in range(len(plan.pairs))]
        axis, root, ends = draft_axis(state)
        robot = Robot(
            name=name,
            root=root,
            axis=axis,
            girdles=tuple(
                _seated(girdle, axis[left_chain.axis_index].name, ends[left_chain.axis_index])
                for girdle, (left_chain, _) in zip(girdles, plan.pairs, strict=True)
            ),
            cables=(),
            contact=contact_for(ends[0] - ends[-1], foot_friction=0.8, skin_friction=0.4),
        )
    except InvalidDesign as error:
        raise UnreadableFile(f"the file gives no robot that can be: {error}") from error
    robot, needless = _without_needless(robot)
    order = layout(robot).hinges
    notes = {note_path: text for note_path, text in state.notes.items() if note_path not in needless}
    return Draft(
        robot=robot,
        matches=tuple(sorted(state.matches, key=lambda match: order.index(match.hinge))),
        remarks=(*plan.remarks, *dict.fromkeys([*arms, *state.remarks, *_balance(state, robot)])),
        notes=notes | {f"contact.{key}": text for key, text in _CONTACT.items()},
    )


_INERTIA_TOLERANCE = 1e-9  # of an inertia and of the length; what shapes give so nearly need not be stated


def _without_needless(robot: Robot) -> tuple[Robot, set[str]]:
    """Return a robot without inertias that equal those of its shapes, and the places of their notes."""

    def bared(girdle: Girdle, keep: set[str]) -> Girdle:
        links = tuple(
            link if f"L{girdle.name}_{link.name}" in keep else replace(link, inertia=None) for link in girdle.limb.links
        )
        return replace(girdle, limb=replace(girdle.limb, links=links))

    def with_inertias(keep: set[str]) -> Robot:
        axis = tuple(segment if segment.name in keep else replace(segment, inertia=None) for segment in robot.axis)
        return replace(robot, axis=axis, girdles=tuple(bared(girdle, keep) for girdle in robot.girdles))

    try:
        stated, shape_model = compile_model(robot), compile_model(with_inertias(set()))
    except InvalidDesign as error:
        if "inertia" not in str(error):
            raise
        raise UnreadableFile(
            f"the robot is {robot.length:.2g} m long and weighs {robot.mass:.2g} kg: moments of inertia of its parts "
            "are smaller than MuJoCo computes with; if lengths are in other units, scale them to metres."
        ) from error
    differing = {
        body.name
        for body in layout(robot).bodies
        if body.inertia is not None and not _has_same_inertia(stated, shape_model, body.name, robot.length)
    }
    note_paths = {segment.name: f"axis[{i}]" for i, segment in enumerate(robot.axis)}
    for i, girdle in enumerate(robot.girdles):
        note_paths |= {f"L{girdle.name}_{link.name}": f"girdles[{i}].limb.links[{k}]"
                   for k, link in enumerate(girdle.limb.links)}  # fmt: skip
    return with_inertias(differing), {
        f"{note_path}.inertia.moments" for name, note_path in note_paths.items() if name not in differing
    }


def _has_same_inertia(first_model: Any, second_model: Any, body: str, length: float) -> bool:
    """Return whether a body of two models has its mass in the same places."""
    (centre, tensor), (other_centre, other_tensor) = (_weighed(model, body) for model in (first_model, second_model))
    is_near = np.linalg.norm(centre - other_centre) <= _INERTIA_TOLERANCE * length
    return bool(is_near and np.abs(tensor - other_tensor).max() <= _INERTIA_TOLERANCE * np.abs(tensor).max())


def _weighed(model: Any, body: str) -> tuple[np.ndarray, np.ndarray]:
    body_view = model.body(body)
    turn = Rotation.from_quat(body_view.iquat, scalar_first=True).as_matrix()
    return body_view.ipos, turn @ np.diag(body_view.inertia) @ turn.T


def _legs(plan: BodyPlan, words: Words) -> tuple[BodyPlan, list[str]]:
    """Return a plan without limbs that are fins by name, or cannot carry the body, and remarks on them."""
    remarks = []
    for number in reversed(range(len(plan.pairs))):
        pair = plan.pairs[number]
        reason = _reason_against_leg(plan, words, number)
        if reason:
            parts = " and ".join(plan.tree_part(chain.parts[0]).name for chain in pair)
            remarks.append(f"{parts} {reason} and were left out; their masses went to the part that carries them.")
            plan = without_limbs(plan, pair)
    return plan, remarks


def _reason_against_leg(plan: BodyPlan, words: Words, number: int) -> str:
    """Return why a pair of limbs is no pair of legs, a predicate; empty where it is one.

    Args:
        plan: axis and limbs.
        words: what the user said.
        number: number of the pair.
    """
    chains = plan.pairs[number]
    names = [name for chain in chains for i in chain.parts for name in plan.tree_part(i).names]
    if all(
        any(is_fin_name(name) for name in names if name in plan.tree_part(chain.parts[0]).names) for chain in chains
    ):
        return "are fins, wings or the like by name,"
    if all(is_wheel(plan.tree_part(chain.parts[-1])) and len(chain.parts) == 1 for chain in chains):
        return "turn about their own middle, as wheels do, which suchus does not have,"
    state = empty_draft(plan, words)
    girdle = draft_girdle(state, number)
    depth = -lowest_foot_height(girdle)
    if depth < _LEG * state.size.length:
        return f"reach {max(depth, 0.0):.3g} m below the axis, so they are arms or fins"
    belly = max(
        state.level - float(state.plan.plane.to_robot_frame(piece.corners)[:, 2].min())
        for i in plan.axis
        for piece in plan.tree_part(i).pieces
    ) if any(plan.tree_part(i).pieces for i in plan.axis) else 0.0  # fmt: skip
    if depth + girdle.limb.foot.radius <= belly:
        return (
            f"reach {depth + girdle.limb.foot.radius:.3g} m below the axis and the belly hangs {belly:.3g} m below it, "
            "so they cannot carry it: they are arms or fins"
        )
    return ""


def is_wheel(tree_part: TreePart) -> bool:
    """Return whether a part turns all round about its own middle, and is as far across in any direction."""
    if len(tree_part.joints) != 1 or tree_part.joints[0].range is not None or not tree_part.pieces:
        return False
    joint = tree_part.joints[0]
    corners = np.concatenate([piece.corners for piece in tree_part.pieces]) - joint.anchor
    across = null_space(joint.axis[None])  # two directions, shape (3, 2)
    extents = np.array([(corners @ across).max(axis=0), -(corners @ across).min(axis=0)])
    centre = (tree_part.com - joint.anchor) @ across
    radius = float(extents.max())
    is_round = float(extents.min()) > _WHEEL_ROUNDNESS * radius
    return is_round and float(np.linalg.norm(centre)) < (1.0 - _WHEEL_ROUNDNESS) * radius


def _seated(girdle: Girdle, segment: str, front: float) -> Girdle:
    """Return a girdle on its segment, whose front end, its origin, lies at a place along the body [m]."""
    return replace(girdle, segment=segment, at=girdle.at - front)


def _balance(state: DraftState, robot: Robot) -> list[str]:
    """Return a remark if the mass of the draft differs from that of the file."""
    mass_error = abs(robot.mass / state.plan.tree.mass - 1.0)
    if mass_error > 1e-6:
        return [f"The draft weighs {robot.mass:.4g} kg, the file {np.round(state.plan.tree.mass, 6):g} kg."]
    return []


_WHEEL_ROUNDNESS = 0.7  # least extent of a wheel to any side of its hinge, over its greatest
_END = "guess: the farthest point of its shapes, frames, joints and hips"
_RADIUS_RATIO = 0.1  # radius of a segment or link without a shape, over its length
_MIN_LENGTH_RATIO = 1e-3  # of the robot's length; of a segment at an end that nothing of it reaches beyond its joint

AxisHinge = tuple[Joint, Turn, float, float]
"""A hinge of the file, what it turns, its sign, and how far it lies off the axis [m]."""


def draft_axis(state: DraftState) -> tuple[tuple[Segment, ...], str, list[float]]:
    """Return the segments, the name of the root, and where segments begin and end along x from the snout on [m].

    Raises:
        UnreadableFile: the axis is not drawn stretched.
    """
    plan = state.plan
    parts = [plan.tree_part(i) for i in plan.axis]
    root = plan.pairs[-1][0].axis_index if plan.pairs else _free_root(plan)
    groups = [_joints(state, i, root) for i in range(len(parts) - 1)]
    joint_positions = [
        float(np.mean([state.to_robot_frame(joint.anchor)[0] for joint, *_ in group])) for group in groups
    ]
    ends = _ends(state, parts, joint_positions)
    _tell_offsets(state, groups, joint_positions)
    hinges = _hinges(state, groups, root)
    segments = []
    for i, tree_part in enumerate(parts):
        length = ends[i] - ends[i + 1]
        if length <= 1e-6:
            raise UnreadableFile(
                f"{tree_part.name} is {length:.3g} m long from its front joint to its rear one; the axis must be drawn "
                "stretched, from the front to the rear, at zero posture. If it belongs to an arm or a gripper, say "
                "--leave BODY, with the first body of that."
            )
        shapes = _shapes(state, tree_part, ends[i], length, i)
        inertia = state.inertia(f"axis[{i}]", [tree_part], np.array([ends[i], 0.0, 0.0]))
        segments.append(
            Segment(name=tree_part.name, front=0.0, rear=length, shapes=shapes, hinges=hinges[i], inertia=inertia)
        )
    state.notes["axis[0].rear"] = state.notes[f"axis[{len(parts) - 1}].rear"] = _END
    state.notes["root"] = "the hindmost girdle's segment" if plan.pairs else "guess: the file's root, or the middle"
    return tuple(segments), parts[root].name, ends


def _hinges(state: DraftState, groups: Sequence[Sequence[AxisHinge]], root: int) -> list[tuple[Hinge, ...]]:
    """Return the hinges behind each segment.

    Args:
        state: the draft.
        groups: hinges behind each segment but the last.
        root: index of the root among the segments.
    """
    plan = state.plan
    front = plan.pairs[0][0].axis_index if plan.pairs else 0
    words = ["tail" if i >= root else "neck" if i < front else "spine" for i in range(len(groups))]
    order = [*range(root - 1, -1, -1), *range(root, len(groups))]
    flat = [(i, *axis_hinge) for i in order for axis_hinge in groups[i]]
    names = axis_names([(turn, words[i], joint.name) for i, joint, turn, _, _ in flat])
    hinges: list[list[Hinge]] = [[] for _ in plan.axis]
    for (i, joint, turn, sign, _), name in zip(flat, names, strict=True):
        moving_body = plan.tree_part(plan.axis[i if i < root else i + 1])
        hinge = hinge_of(name, turn, sign, joint, state.size, moving_body.mass / state.heaviest, lone=False)
        state.note_hinge(f"axis[{i}].hinges[{len(hinges[i])}]", hinge, joint, sign)
        state.matches.append(Match(hinge=name, file_hinge=joint.name, sign=sign, zero=joint.zero))
        hinges[i].append(hinge)
    return [tuple(group) for group in hinges]


def _free_root(plan: BodyPlan) -> int:
    return plan.axis.index(0) if 0 in plan.axis else len(plan.axis) // 2


def _joints(state: DraftState, i: int, root: int) -> list[AxisHinge]:
    """Return the hinges between segments i and i + 1, from the robot's root outward.

    Args:
        state: the draft.
        i: index of the front segment, from the front.
        root: index of the root among the segments.
    """
    axis, is_ahead = state.plan.axis, i < root
    inner_index, outer_index = (axis[i + 1], axis[i]) if is_ahead else (axis[i], axis[i + 1])
    hinges = []
    for joint, is_outward in links_between(state.plan, inner_index, outer_index):
        turn, sense = turn_of(joint, state.rotate_to_robot_frame(joint.axis), state.remarks)
        axis_offset = 0.0 if turn == "yaw" else abs(float(state.to_robot_frame(joint.anchor)[2]))
        hinges.append((joint, turn, axial_sign(turn, sense, is_ahead=is_ahead, is_outward=is_outward), axis_offset))
    return hinges


def _ends(state: DraftState, parts: list[TreePart], joint_positions: list[float]) -> list[float]:
    """Return where segments begin and end along x, from the snout to the tip of the tail [m].

    Args:
        state: the draft.
        parts: parts of the axis, from the front.
        joint_positions: x of the hinges between them [m].
    """
    limbs = [chain for pair in state.plan.pairs for chain in pair]

    def reach(index: int) -> list[float]:
        hips = [float(state.to_robot_frame(state.hip(chain))[0]) for chain in limbs if chain.axis_index == index]
        return [*state.to_robot_frame(parts[index].corners)[:, 0].tolist(), *hips]

    front, rear = max(reach(0)), min(reach(len(parts) - 1))
    min_length = _MIN_LENGTH_RATIO * state.size.length
    if joint_positions:
        front, rear = max(front, joint_positions[0] + min_length), min(rear, joint_positions[-1] - min_length)
    return [front, *joint_positions, rear]


def _tell_offsets(state: DraftState, groups: Sequence[Sequence[AxisHinge]], joint_positions: list[float]) -> None:
    """Add a remark on the hinges that were moved onto the straight axis, with the greatest distance."""
    offsets = [(offset, j.name) for group in groups for j, _, _, offset in group]
    for group, joint_position in zip(groups, joint_positions, strict=True):
        offsets += [
            (abs(float(state.to_robot_frame(j.anchor)[0]) - joint_position), j.name)
            for j, turn, _, _ in group
            if turn != "roll"
        ]
    max_offset = max(offsets, default=(0.0, ""))
    if max_offset[0] > JOINED * state.size.length:
        state.remarks.append(
            f"The axis of a robot is straight here: hinges of the file lie up to {max_offset[0]:.3g} m off it "
            f"({max_offset[1]}) and were moved onto it."
        )


def _shapes(
    state: DraftState, tree_part: TreePart, front: float, length: float, number: int
) -> tuple[Rod | Shell, ...]:
    """Return a segment's shapes, its mass shared among them by volume.

    Args:
        state: the draft.
        tree_part: part of the file, which becomes the segment.
        front: x of the segment's front end [m].
        length: length of the segment [m].
        number: index of the segment.
    """
    start = np.array([front, 0.0, 0.0])
    note_path = f"axis[{number}].shapes"
    pieces = [piece for piece in tree_part.pieces if _overlaps(state, piece, front, length)]
    volume = sum(piece.volume for piece in pieces)
    if not pieces or volume <= 0:
        state.notes[f"{note_path}[0].radius"] = "guess: a tenth of the segment's length; the file has no shape for it"
        state.remarks.append(f"{tree_part.name} has no shape that is read; the draft gives it a rod.")
        radius = min(max(_RADIUS_RATIO * length, 1e-5), 10.0)
        return (
            Rod(
                name=tree_part.name, start=(0.0, 0.0, 0.0), end=(-length, 0.0, 0.0), radius=radius, mass=tree_part.mass
            ),
        )
    shapes: list[Rod | Shell] = []
    for i, piece in enumerate(pieces):
        name = tree_part.name if i == 0 else f"{tree_part.name}_{i + 1}"
        mass = tree_part.mass * piece.volume / volume
        points = state.to_robot_frame(piece.ends) - start
        half = _half(state, piece)
        if len(points) == 2:
            shapes.append(Rod(name=name, start=point(points[0]), end=point(points[1]), radius=half[0], mass=mass))
        else:
            shapes.append(Shell(name=name, at=point(points[0]), half=half, mass=mass))
        if len(pieces) > 1:
            state.notes[f"{note_path}[{i}].mass"] = "guess: the segment's mass shared among its shapes by volume"
    return tuple(shapes)


def _half(state: DraftState, piece: ShapePiece) -> tuple[float, float, float]:
    """Return half axes along the robot's axes; of a turned ellipsoid those of its bounding box [m]."""
    box_half = np.abs(state.plan.plane.turn) @ piece.half
    return point(piece.half if len(piece.ends) == 2 else box_half)


def _overlaps(state: DraftState, piece: ShapePiece, front: float, length: float) -> bool:
    axial = state.to_robot_frame(piece.corners)[:, 0]
    return bool(axial.min() <= front and axial.max() >= front - length)


_NAMES = {1: "H", 2: "FH", 3: "FMH"}
_FOOT = 0.08  # radius of a foot, over the limb's reach
_FOOT_SHARE = 0.1  # of the last link's mass
_POINT = 1e-6  # m; hinges nearer to each other sit in one point
_MIN_HIP_OFFSET = 1e-5  # m; of a hip's distance from the midline
_SIDE_TOLERANCE = 0.01  # of the size, or rad; sides that differ by more are noted
_POSTURES = 256


def draft_girdle(state: DraftState, number: int) -> Girdle:
    """Return a girdle, its place along the body still from the origin of the robot's frame.

    Raises:
        UnreadableFile: left and right have other hinges, or a hinge is skew.
    """
    left_chain, right_chain = state.plan.pairs[number]
    left_joints, right_joints = (
        [j for i in chain.parts for j in state.plan.tree_part(i).joints] for chain in (left_chain, right_chain)
    )
    count = len(state.plan.pairs)
    name = _NAMES[count][number] if count in _NAMES else f"G{number + 1}"
    left_turns = [
        limb_turn(joint, state.rotate_to_robot_frame(joint.axis), 1.0, state.remarks) for joint in left_joints
    ]
    right_turns = [
        limb_turn(joint, state.rotate_to_robot_frame(joint.axis), -1.0, state.remarks) for joint in right_joints
    ]
    if [turn for turn, _ in left_turns] != [turn for turn, _ in right_turns]:
        raise UnreadableFile(
            f"the limbs of {left_joints[0].name} and {right_joints[0].name} have their hinges in another order."
        )
    labels = limb_names([j.name for j in left_joints], [j.name for j in right_joints], name) or numbered_names(
        [t for t, _ in left_turns]
    )
    _tell_sides(state, (left_joints, right_joints), [s for _, s in left_turns], [s for _, s in right_turns])
    for side, side_joints, signs in (("L", left_joints, left_turns), ("R", right_joints, right_turns)):
        state.matches += [
            Match(hinge=f"{side}{name}_{label}", file_hinge=joint.name, sign=sign, zero=joint.zero)
            for label, joint, (_, sign) in zip(labels, side_joints, signs, strict=True)
        ]
    hip = state.to_robot_frame(state.hip(left_chain))
    if hip[1] < _MIN_HIP_OFFSET:
        placement_text = f"the draft has them {_MIN_HIP_OFFSET:g} m beside it"
        state.remarks.append(f"The hips of girdle {name} lie in the midline; {placement_text}.")
    parts = _mean_parts(state, left_chain, right_chain)
    limb = _limb(state, left_chain, parts, left_turns, labels, f"girdles[{number}].limb")
    return Girdle(
        name=name,
        segment="-",
        at=float(hip[0]),
        aside=max(float(hip[1]), _MIN_HIP_OFFSET),
        above=float(hip[2]),
        limb=limb,
    )


def lowest_foot_height(girdle: Girdle) -> float:
    """Return the height above the axis of the lowest point that a limb's foot reaches within its ranges [m]."""
    lower_bounds, upper_bounds = np.array([hinge.range or (-np.pi, np.pi) for hinge in girdle.limb.hinges]).T
    angles = np.random.default_rng(0).uniform(lower_bounds, upper_bounds, (_POSTURES, len(lower_bounds)))
    return float(limb_kinematics.forward(girdle.limb, angles)[:, 2].min()) + girdle.above


_MASS_TOLERANCE = 1e-3  # relative difference of the limbs' masses from which on it is said


def _mean_parts(state: DraftState, left_chain: LimbChain, right_chain: LimbChain) -> list[TreePart]:
    """Return the parts of the left limb, each with the mean mass of its and its partner's, so that the robot's is kept.

    Args:
        state: the draft, which takes a remark where the masses differ.
        left_chain: parts of the left limb.
        right_chain: parts of the right one, as many.
    """
    left_parts, right_parts = ([state.plan.tree_part(i) for i in chain.parts] for chain in (left_chain, right_chain))
    if len(left_parts) != len(right_parts):
        return left_parts
    left_mass, right_mass = (sum(tree_part.mass for tree_part in parts) for parts in (left_parts, right_parts))
    if abs(left_mass - right_mass) > _MASS_TOLERANCE * max(left_mass, right_mass):
        state.remarks.append(
            f"The limb of {left_parts[0].name} has {left_mass:.4g} kg and that of {right_parts[0].name} "
            f"{right_mass:.4g} kg; the draft has the mean on both sides."
        )
    mean_parts = []
    for left, right in zip(left_parts, right_parts, strict=True):
        mass = (left.mass + right.mass) / 2
        tensor = left.tensor * (mass / left.mass) if left.mass > 0.0 else left.tensor
        mean_parts.append(left if left.mass == right.mass else replace(left, mass=mass, tensor=tensor))
    return mean_parts


def _limb(
    state: DraftState,
    chain: LimbChain,
    parts: Sequence[TreePart],
    turns: list[tuple[Turn, float]],
    labels: list[str],
    note_path: str,
) -> Limb:
    """Return the left limb: hinges in one point share a link, whose mass is that of the parts up to the next point.

    Args:
        state: the draft.
        chain: places of the parts in the tree.
        parts: parts of the limb, with the masses of both sides.
        turns: kind and sign of each hinge.
        labels: name of each hinge without the limb's.
        note_path: place of the limb in the robot's file.
    """
    stations: list[tuple[np.ndarray, list[tuple[int, Joint]], list[TreePart]]] = []
    number = 0
    for tree_part in parts:
        for joint in tree_part.joints:
            anchor = state.to_robot_frame(joint.anchor)
            if not stations or np.linalg.norm(anchor - stations[-1][0]) > _POINT:
                stations.append((anchor, [], []))
            stations[-1][1].append((number, joint))
            number += 1
        stations[-1][2].append(tree_part)
    foot, radius = _foot(state, parts, stations[-1][0], note_path)
    ends = [*(anchor for anchor, _, _ in stations[1:]), foot]
    links = []
    for i, ((anchor, hinges, carried_parts), end) in enumerate(zip(stations, ends, strict=True)):
        link = f"{note_path}.links[{i}]"
        link_hinges = []
        for k, (n, joint) in enumerate(hinges):
            turn, sign = turns[n]
            hinge = hinge_of(labels[n], turn, sign, joint, state.size, 1.0, lone=len(turns) == 1)
            state.note_hinge(f"{link}.hinges[{k}]", hinge, joint, sign)
            link_hinges.append(hinge)
        mass = sum(tree_part.mass for tree_part in carried_parts) or 1e-3 * state.size.mass
        if not carried_parts:
            state.notes[f"{link}.mass"] = "guess: a thousandth of the robot; the file has none between these hinges"
        is_last = i == len(stations) - 1
        links.append(
            Link(
                name=_link_name(carried_parts, i, chain, state),
                hinges=tuple(link_hinges),
                end=point(end - anchor),
                radius=_radius(state, carried_parts, float(np.linalg.norm(end - anchor)), f"{link}.radius"),
                mass=mass * (1.0 - _FOOT_SHARE) if is_last else mass,
                inertia=state.inertia(link, carried_parts, anchor),
            )
        )
    feet = _FOOT_SHARE / (1.0 - _FOOT_SHARE) * links[-1].mass
    state.notes[f"{note_path}.foot.mass"] = "guess: a tenth of the last link's mass"
    if state.words.foot_radius is not None:
        radius = state.words.foot_radius
        state.notes[f"{note_path}.foot.radius"] = "as asked (--foot-radius)"
    if links[-1].radius > radius:
        state.remarks.append(
            f"{links[-1].name} is {links[-1].radius:.3g} m thick and its foot {radius:.3g} m; the draft has the link "
            "no thicker than the foot, so that the foot carries. See --foot-radius."
        )
        state.notes[f"{note_path}.links[{len(links) - 1}].radius"] = "guess: as thick as the foot"
        links[-1] = replace(links[-1], radius=radius)
    return Limb(links=tuple(links), foot=Foot(radius=radius, mass=feet))


def _link_name(carried_parts: list[TreePart], number: int, chain: LimbChain, state: DraftState) -> str:
    """Return the name of a link: that of its part without the limb's name, if all its parts begin with that."""
    names = [state.plan.tree_part(i).name for i in chain.parts]
    part_name = carried_parts[-1].name if carried_parts else ""
    head, separator, tail = part_name.partition("_")
    has_same_head = all(name.partition("_")[0] == head for name in names)
    unique = sum(name.partition("_")[2] == tail for name in names) == 1
    return tail if separator and tail and has_same_head and unique else f"link_{number + 1}"


def _foot(state: DraftState, parts: Sequence[TreePart], knee: np.ndarray, note_path: str) -> tuple[np.ndarray, float]:
    """Return the foot's centre in the robot's frame [m] and its radius [m].

    Args:
        state: the draft.
        parts: parts of the limb, from the hip.
        knee: anchor of the last hinges in the robot's frame [m].
        note_path: place of the limb in the robot's file.
    """
    foot_part = parts[-1]
    balls = [(state.to_robot_frame(piece.centre), float(piece.half[0])) for piece in foot_part.pieces if piece.ball]
    rods = [
        (state.to_robot_frame(end), float(p.half[0])) for p in foot_part.pieces if len(p.ends) == 2 for end in p.ends
    ]
    for candidates, reason in ((balls, ""), (rods, "guess: the round end of the link's rod")):
        far_ends = [candidate for candidate in candidates if np.linalg.norm(candidate[0] - knee) > _POINT]
        if far_ends:
            if reason:
                state.notes[f"{note_path}.foot.radius"] = reason
            return max(far_ends, key=lambda candidate: float(np.linalg.norm(candidate[0] - knee)) + candidate[1])
    reach = sum(
        float(np.linalg.norm(outer.joints[0].anchor - inner.joints[0].anchor)) for inner, outer in pairwise(parts)
    )
    ends = [
        state.to_robot_frame(point) for point in (*foot_part.points, *(c for p in foot_part.pieces for c in p.corners))
    ]
    far_end = max(ends, key=lambda end: float(np.linalg.norm(end - knee)), default=knee)
    if np.linalg.norm(far_end - knee) < max(0.1 * reach, _POINT):
        far_end = knee - np.array([0.0, 0.0, reach or 0.2 * state.size.length])
        state.remarks.append(
            f"Nothing of the file says how far {foot_part.name} reaches beyond its joint; the draft has its foot "
            f"{knee[2] - far_end[2]:.3g} m below."
        )
        state.notes[f"{note_path}.links[{len(parts) - 1}].end"] = "guess: straight down, as long as the links before it"
    elif foot_part.pieces:
        mean_centre = np.mean([state.to_robot_frame(piece.centre) for piece in foot_part.pieces], axis=0)
        far_end = np.array([*mean_centre[:2], far_end[2]]) if abs(far_end[2] - knee[2]) > _POINT else far_end
        state.remarks.append(
            f"{foot_part.name} turns about its own middle, as a wheel does, which suchus does not have: the draft has "
            f"a foot at its rim. With --leave {foot_part.name} the limb ends above it."
            if is_wheel(foot_part)
            else f"{foot_part.name} has no ball for a foot; the draft has the foot at its farthest end."
        )
    radius = _FOOT * max(reach + float(np.linalg.norm(far_end - knee)), _POINT)
    state.notes[f"{note_path}.foot.radius"] = "guess: a twelfth of the limb's reach; see --foot-radius"
    return far_end, max(radius, 1e-5)


def _radius(state: DraftState, carried_parts: list[TreePart], length: float, note_path: str) -> float:
    """Return the radius of a link: of its thickest rod, else from the box around its shapes, else from its length."""
    pieces = [piece for tree_part in carried_parts for piece in tree_part.pieces]
    rods = [float(piece.half[0]) for piece in pieces if len(piece.ends) == 2]
    if rods:
        return max(rods)
    state.notes[note_path] = "guess: from its shapes" if pieces else "guess: a tenth of its length"
    return max(min([float(np.sort(piece.half)[0]) for piece in pieces], default=_RADIUS_RATIO * length), 1e-5)


def _tell_sides(
    state: DraftState, joints: tuple[list[Joint], list[Joint]], left_signs: list[float], right_signs: list[float]
) -> None:
    """Add remarks where the right limb is no exact mirror image of the left one.

    Args:
        state: the draft.
        joints: hinges of the left and of the right limb.
        left_signs: sign of each left hinge against the file.
        right_signs: sign of each right hinge against the file.
    """
    for left_joint, right_joint, a, b in zip(*joints, left_signs, right_signs, strict=True):
        gap = state.to_robot_frame(left_joint.anchor) * np.array([1.0, -1.0, 1.0]) - state.to_robot_frame(
            right_joint.anchor
        )
        line = state.rotate_to_robot_frame(right_joint.axis)
        mirror_offset = float(np.linalg.norm(gap - (gap @ line) * line))
        if mirror_offset > _SIDE_TOLERANCE * state.size.length:
            state.remarks.append(
                f"{right_joint.name} lies {mirror_offset:.3g} m off the mirror image of {left_joint.name}; "
                "the draft has the image."
            )
        if left_joint.range and right_joint.range:
            left_range, right_range = (
                sorted(sign * end for end in r) for sign, r in ((a, left_joint.range), (b, right_joint.range))
            )
            if np.abs(np.subtract(left_range, right_range)).max() > _SIDE_TOLERANCE:
                range_text = f"{right_joint.name} has another range than {left_joint.name}"
                state.remarks.append(f"{range_text}; the draft has the left one on both.")
    drives = [tuple(_drive_text(joint.drive) for joint in pair) for pair in zip(*joints, strict=True)]
    differing = [
        f"{right_joint.name} {right_drive} ({left_joint.name} {left_drive})"
        for left_joint, right_joint, (left_drive, right_drive) in zip(*joints, drives, strict=True)
        if left_drive != right_drive
    ]
    if differing:
        state.remarks.append(f"Drives differ from side to side: {'; '.join(differing)}. The draft has the left ones.")


def _drive_text(drive: Drive | None) -> str:
    """Return how a hinge is driven, as a predicate: not at all, or with which torque."""
    if drive is None or (drive.torque is None and not drive.passive):
        return "has a torque that is not stated"
    return "is passive" if drive.passive else f"has {drive.torque:.4g} N m"
