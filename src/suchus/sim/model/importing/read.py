"""From a file to a draft; limbs that are drawn askew get another zero posture, so that hinges lie along the axes."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from suchus.core.checks import require
from suchus.core.errors import UnreadableFile
from suchus.sim.model.importing.draft import Draft, draft_of
from suchus.sim.model.importing.loading import load
from suchus.sim.model.importing.making import SKEW
from suchus.sim.model.importing.plan import BodyPlan, LimbChain, Words, plan_of
from suchus.sim.model.importing.tree import Joint, ShapePiece, TreePart, tree_of
from suchus.sim.model.importing.upright import upright

_ANGLE_TOLERANCE = np.radians(
    10.0
)  # two turns that differ by less are alike: the one that points the limb sideways is taken


def straightened(plan: BodyPlan) -> BodyPlan:
    """Return a plan whose limbs are turned at their hinges until those that follow lie along the robot's axes.

    The leg of a hexapod that points forward and out by 45 degrees is turned at its yaw hinge until it points straight
    out. A hinge turned so calls our zero another angle. A limb of which that does not make anything straight stays.
    """
    parts, remarks = list(plan.tree.parts), list(plan.remarks)
    for pair in plan.pairs:
        for chain in pair:
            _straighten(plan, parts, chain, remarks)
    return replace(plan, tree=replace(plan.tree, parts=tuple(parts)), remarks=tuple(remarks))


def _straighten(plan: BodyPlan, parts: list[TreePart], chain: LimbChain, remarks: list[str]) -> None:
    """Turn the hinges of a limb, from the hip on, until each next hinge lies along an axis of the robot."""
    order = [(i, k) for i in chain.parts for k in range(len(parts[i].joints))]
    for number, (i, k) in enumerate(order[1:], 1):
        axis = plan.plane.turn @ parts[i].joints[k].axis
        if np.degrees(np.arccos(min(np.abs(axis).max(), 1.0))) <= SKEW:
            continue
        part_index, joint_index = order[number - 1]
        pivot = parts[part_index].joints[joint_index]
        angle = _angle(plan, parts, chain, pivot, axis)
        if angle is None:
            return
        _turn(parts, plan, part_index, joint_index, angle)
        remarks.append(
            f"The limb behind {pivot.name} is drawn askew: the draft's zero of this hinge is the file's "
            f"{parts[part_index].joints[joint_index].zero:.4g} rad, where the next hinge lies along the robot's axes."
        )


def _angle(plan: BodyPlan, parts: list[TreePart], chain: LimbChain, pivot: Joint, axis: np.ndarray) -> float | None:
    """Return the angle at a hinge that aligns the next hinge's axis with an axis of the robot [rad].

    It is None where no angle does. Of nearly equal angles the one that points the limb sideways is taken.

    Args:
        plan: axis and limbs.
        parts: parts of the tree, as turned so far.
        chain: the limb.
        pivot: the hinge that is turned.
        axis: axis of the next hinge, in the robot's frame.
    """
    rotation_axis = plan.plane.turn @ pivot.axis
    axis_index = int(np.argmax(np.abs(rotation_axis)))
    if abs(axis @ rotation_axis) > np.sin(np.radians(SKEW)) or np.abs(rotation_axis)[axis_index] < np.cos(
        np.radians(SKEW)
    ):
        return None
    flat = axis - (axis @ rotation_axis) * rotation_axis
    candidates = []
    tip = parts[chain.parts[-1]].com - pivot.anchor
    for goal in (g * s for g in np.eye(3) for s in (1.0, -1.0)):
        if abs(goal[axis_index]) < 0.5:
            angle = float(np.arctan2(np.cross(flat, goal) @ rotation_axis, flat @ goal))
            lateral = abs((Rotation.from_rotvec(angle * rotation_axis).apply(plan.plane.turn @ tip))[1])
            candidates.append((abs(angle), -lateral, angle))
    min_angle = min(candidates)[0]
    return min(
        (candidate for candidate in candidates if candidate[0] < min_angle + _ANGLE_TOLERANCE),
        key=lambda candidate: candidate[1:],
    )[2]


def _turn(parts: list[TreePart], plan: BodyPlan, part_index: int, joint_index: int, angle: float) -> None:
    """Rotate everything that a hinge carries by an angle [rad], and set the new zero of the hinge.

    Args:
        parts: parts of the tree; those that move are replaced.
        plan: the body plan.
        part_index: part that the hinge carries.
        joint_index: index of the hinge in that part.
        angle: [rad].
    """
    pivot = parts[part_index].joints[joint_index]
    rotation = Rotation.from_rotvec(angle * pivot.axis)

    def rotate_points(points: np.ndarray) -> np.ndarray:
        return np.asarray(pivot.anchor + rotation.apply(points - pivot.anchor))

    limits = None if pivot.range is None else (pivot.range[0] - angle, pivot.range[1] - angle)
    for i in plan.tree.subtree(part_index):
        joints = list(parts[i].joints)
        for k, joint in enumerate(joints):
            if i != part_index or k > joint_index:
                joints[k] = replace(joint, axis=rotation.apply(joint.axis), anchor=rotate_points(joint.anchor))
        if i == part_index:
            joints[joint_index] = replace(pivot, zero=pivot.zero + angle, range=limits)
        parts[i] = replace(
            parts[i],
            joints=tuple(joints),
            com=rotate_points(parts[i].com),
            tensor=rotation.as_matrix() @ parts[i].tensor @ rotation.as_matrix().T,
            origin=rotate_points(parts[i].origin),
            points=rotate_points(parts[i].points),
            centres=rotate_points(parts[i].centres),
            pieces=tuple(_rotated_piece(piece, rotate_points, rotation) for piece in parts[i].pieces),
        )


def _rotated_piece(
    piece: ShapePiece, rotate_points: Callable[[np.ndarray], np.ndarray], rotation: Rotation
) -> ShapePiece:
    half = piece.half if np.ptp(piece.half) == 0 else np.abs(rotation.as_matrix()) @ piece.half
    return ShapePiece(ends=rotate_points(piece.ends), half=half)


def import_robot(path: str | Path, *, name: str, words: Words | None = None) -> Draft:
    """Read a robot from a URDF or an MJCF: axis, girdles and limbs by geometry, drives and contact by its size.

    Nothing in the file is executed, and no file outside its folder and those of packages is read.

    Args:
        path: the file.
        name: name of the robot.
        words: answers to what geometry cannot say.

    Raises:
        UnreadableFile: it cannot be read, or is no tree of hinges with a mirror plane.
        UnknownName: a body that the words name is not there.
    """
    path = Path(path)
    words = words or Words()
    if words.foot_radius is not None:
        require("import", "foot_radius", words.foot_radius, 1e-5, 10.0, "m")
    if words.heading is not None:
        require("import", "heading", words.heading, -360.0, 360.0, "degree")
    loaded = load(path, packages=words.packages, without_meshes=words.without_meshes)
    try:
        tree = upright(tree_of(loaded), words.up, loaded.gravity)
        return draft_of(straightened(plan_of(tree, words)), name, words)
    except UnreadableFile as error:
        raise UnreadableFile(f"{path.name} cannot be imported: {error}") from error
