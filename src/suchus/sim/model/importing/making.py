"""State of a draft during its construction from a body plan: hinges, remarks, and guesses with their reasons."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import degrees, pi

import numpy as np

from suchus.core.errors import UnreadableFile
from suchus.robot.design import Crank, Hinge, Inertia, Servo, Spring
from suchus.robot.design.body import MAX_INERTIA_RATIO
from suchus.robot.design.hinge import Turn
from suchus.robot.design.layout import LIMB_AXES
from suchus.robot.design.scale import servo_for, spring_for
from suchus.robot.design.segment import Point, combine_inertias
from suchus.sim.model.importing.plan import BodyPlan, LimbChain, Words, links_between
from suchus.sim.model.importing.tree import JOINED, Joint, TreePart

SKEW = 5.0
"""Degrees by which a hinge may miss the robot's axes."""
_EXACT = 0.06  # degrees; less is not worth a word
_ARMATURE_RATIO = 0.9 * MAX_INERTIA_RATIO  # of a draft, at most: copies that are built lighter must be allowed too
_WIDEST = 3.1416  # rad; of a range in a robot's file


@dataclass(frozen=True, slots=True, kw_only=True)
class Match:
    """A hinge of the robot and the one of the file that it was read from."""

    hinge: str
    """Name in the robot's layout."""
    file_hinge: str
    """Name in the file."""
    sign: float
    """1 where positive angles turn the same way, else -1 [-]."""
    zero: float
    """Angle of the file's hinge at our zero [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Size:
    """Mass and length, from which servos and springs follow."""

    mass: float
    """Mass of the robot [kg]."""
    length: float
    """Length of the robot [m]."""
    max_armature: float
    """Rotor inertia of a servo, at most [kg m2]; less than ``design.body.MAX_INERTIA_RATIO`` allows."""


def turn_of(joint: Joint, axis: np.ndarray, remarks: list[str]) -> tuple[Turn, float]:
    """Return the kind of a hinge, and 1 where its axis points along x, y or z of the robot, else -1.

    Args:
        joint: the hinge.
        axis: its axis in the robot's frame.
        remarks: takes a sentence where the axis is rounded.

    Raises:
        UnreadableFile: it is skew.
    """
    axis_index = int(np.argmax(np.abs(axis)))
    skew = degrees(np.arccos(min(abs(axis[axis_index]), 1.0)))
    if skew > SKEW:
        raise UnreadableFile(
            f"hinge {joint.name} turns about ({', '.join(f'{v:.2f}' for v in axis)}), {skew:.0f} degrees off "
            "the robot's axes (forward, left, up) at zero posture; suchus takes hinges along them: draw its limb so."
        )
    if skew > _EXACT:
        remarks.append(f"Hinge {joint.name} is {skew:.1f} degrees skew; the draft has it along an axis of the robot.")
    turn: Turn = ("roll", "pitch", "yaw")[axis_index]
    return turn, float(np.sign(axis[axis_index]))


def limb_turn(joint: Joint, axis: np.ndarray, side: float, remarks: list[str]) -> tuple[Turn, float]:
    """Return the kind of a limb's hinge, and 1 where its positive sense is that of the robot's hinge, else -1."""
    file_turn, sense = turn_of(joint, axis, remarks)
    turn: Turn = {"roll": "pitch", "pitch": "roll", "yaw": "yaw"}[file_turn]  # type: ignore[assignment]
    robot_sign = LIMB_AXES[turn][("roll", "pitch", "yaw").index(file_turn)]
    return turn, sense * robot_sign * (side if turn != "roll" else 1.0)


def axial_sign(turn: Turn, sense: float, *, is_ahead: bool, is_outward: bool) -> float:
    """Return 1 where the positive sense of an axis hinge is that of the robot's hinge, else -1.

    Args:
        turn: what it turns.
        sense: whether its axis points along that of the robot's frame.
        is_ahead: whether it lies ahead of the root.
        is_outward: whether a positive angle of the file moves the part farther from our root.
    """
    robot_sign = 1.0 if is_ahead or turn == "yaw" else -1.0
    return sense * robot_sign * (1.0 if is_outward else -1.0)


def hinge_of(
    name: str, turn: Turn, sign: float, joint: Joint, size: Size, mass_fraction: float, *, lone: bool
) -> Hinge:
    """Return a hinge of the robot.

    Args:
        name: of it.
        turn: what it turns.
        sign: sign of its angles against those of the file.
        joint: joint of the file.
        size: size of the robot.
        mass_fraction: mass of what it carries over that of the heaviest part, for a spring.
        lone: whether it is the only hinge of a limb, which may turn all round.
    """
    servo = _servo(joint, size)
    if joint.range is None and lone and servo is not None:
        return Hinge(name=name, turn=turn, drive=Crank(servo=servo))
    lower_limit, upper_limit = sorted(sign * end for end in joint.range or (-pi, pi))
    lower_limit, upper_limit = max(lower_limit, -_WIDEST), min(upper_limit, _WIDEST)
    if not lower_limit < upper_limit:
        raise UnreadableFile(
            f"hinge {joint.name} has a range of {lower_limit:g} to {upper_limit:g} rad; give it one that is not empty."
        )
    return Hinge(
        name=name, turn=turn, drive=servo or _spring(joint, size, mass_fraction), range=(lower_limit, upper_limit)
    )


def axis_names(turns: Sequence[tuple[Turn, str, str]]) -> list[str]:
    """Return names for hinges of the axis: those of the file if all follow the rule of names, else new ones.

    Args:
        turns: what each turns, its part of the body (``spine``, ``neck`` or ``tail``), its name in the file; of each
            part of the body from the root on.
    """
    file_names = [name for _, _, name in turns]
    rule = all((turn == "yaw" and region == "spine") == name.startswith("spine_yaw_") for turn, region, name in turns)
    if rule and len(set(file_names)) == len(file_names):
        return file_names
    count: dict[tuple[str, str], int] = {}
    names = []
    for turn, region, _ in turns:
        count[region, turn] = count.get((region, turn), 0) + 1
        names.append(f"{region}_{turn}_{count[region, turn]}")
    return names


def limb_names(left_names: Sequence[str], right_names: Sequence[str], girdle: str) -> list[str] | None:
    """Return the suffixes of names as ``LF_yaw`` and ``RF_yaw``; None if names are not of this form."""
    heads = f"L{girdle}_", f"R{girdle}_"
    is_mirrored = all(
        left_name.startswith(heads[0])
        and right_name.startswith(heads[1])
        and left_name[len(heads[0]) :] == right_name[len(heads[1]) :]
        for left_name, right_name in zip(left_names, right_names, strict=True)
    )
    suffixes = [name.removeprefix(heads[0]) for name in left_names]
    return suffixes if is_mirrored and all(suffixes) and len(set(suffixes)) == len(suffixes) else None


def numbered_names(turns: Sequence[str]) -> list[str]:
    """Return a name for each hinge of a limb: what it turns, with a number from the second one on."""
    names: list[str] = []
    for i, turn in enumerate(turns):
        earlier_count = list(turns[:i]).count(turn)
        names.append(turn if not earlier_count else f"{turn}_{earlier_count + 1}")
    return names


_SERVO_LIMITS = {
    "kp": (1e-9, 1e7), "kd": (0.0, 1e6), "torque": (1e-9, 1e6), "speed": (0.01, 1e4),
    "armature": (1e-15, 100.0), "friction": (0.0, 1e4), "damping": (0.0, 1e4),
}  # fmt: skip
"""Fields of a servo that a file can state, with what a design allows."""


def stated_values(joint: Joint) -> dict[str, float]:
    """Return the fields of a servo that the file states for a hinge; a zero states nothing, but for a gain of rate.

    A file whose position servo has no gain of rate has its damping at the joint; then ``kd`` is zero.
    """
    drive = joint.drive
    values = {"armature": joint.armature, "friction": joint.friction, "damping": joint.damping}
    if drive is not None:
        values |= {"kp": drive.kp or 0.0, "torque": drive.torque or 0.0, "speed": drive.speed or 0.0}
    values = {name: value for name, value in values.items() if value > 0.0}
    if drive is not None and drive.kp and (drive.kd or joint.damping):
        values["kd"] = drive.kd or 0.0
    return {name: min(max(value, _SERVO_LIMITS[name][0]), _SERVO_LIMITS[name][1]) for name, value in values.items()}


def _servo(joint: Joint, size: Size) -> Servo | None:
    """Return a servo for the robot's size with what the file states of it; None for a passive hinge."""
    if joint.drive is not None and joint.drive.passive:
        return None
    servo = servo_for(size.mass, size.length)
    stated = stated_values(joint)
    if "kp" in stated and "kd" not in stated:  # the same ratio of gains, so that the servo is damped as before
        stated["kd"] = servo.kd / servo.kp * stated["kp"]
    servo = replace(servo, **stated)  # type: ignore[arg-type]
    return replace(servo, armature=min(servo.armature, size.max_armature))


def _spring(joint: Joint, size: Size, mass_fraction: float) -> Spring:
    """Return the spring of a passive hinge, with what the file states of it."""
    spring = spring_for(size.mass, size.length, mass_fraction)
    armature = min(joint.armature, 100.0) or spring.armature
    if joint.stiffness > 0:
        return replace(spring, stiffness=joint.stiffness, damping=joint.damping, armature=armature)
    return replace(spring, damping=joint.damping or spring.damping, armature=armature)


@dataclass(slots=True, kw_only=True, eq=False)
class DraftState:
    """A draft in the making, its frame forward, left, up with the origin on the axis."""

    plan: BodyPlan
    """Axis and limbs."""
    words: Words
    """The options that the user gave."""
    level: float
    """Height of the axis above the point of the mirror plane [m]."""
    size: Size
    """Mass and length, from which servos and springs follow."""
    heaviest: float
    """Mass of the heaviest part [kg]."""
    max_file_armature: float = 0.0
    """Greatest rotor inertia of a hinge in the file [kg m2]."""
    matches: list[Match] = field(default_factory=list)
    """Hinges so far."""
    remarks: list[str] = field(default_factory=list)
    """What was guessed and what was not taken, in sentences."""
    notes: dict[str, str] = field(default_factory=dict)
    """Guesses by the place of the number in the robot's file."""

    def to_robot_frame(self, points: np.ndarray) -> np.ndarray:
        """Return points of the file in the robot's frame, shape (..., 3) [m]."""
        return np.asarray(self.plan.plane.to_robot_frame(points) - np.array([0.0, 0.0, self.level]))

    def rotate_to_robot_frame(self, axis: np.ndarray) -> np.ndarray:
        """Return a direction of the file in the robot's frame, shape (3,) [-]."""
        return np.asarray(self.plan.plane.turn @ axis)

    def inertia(self, note_path: str, parts: Sequence[TreePart], origin: np.ndarray) -> Inertia | None:
        """Return centre and moments of the mass of parts that move as one, along the robot's axes.

        Args:
            note_path: path of the segment or link in the robot's file.
            parts: the parts.
            origin: origin of the frame, in that of the robot [m].

        Returns:
            None where the file does not say.
        """
        min_gyration = JOINED * self.size.length  # what rounding leaves of a tensor of zeros is less
        if not parts or not all(
            np.abs(tree_part.tensor).max() > tree_part.mass * min_gyration**2 for tree_part in parts
        ):
            return None
        _, com, tensor = combine_inertias([(tree_part.mass, tree_part.com, tree_part.tensor) for tree_part in parts])
        rotated_tensor = self.plan.plane.turn @ tensor @ self.plan.plane.turn.T
        self.notes[f"{note_path}.inertia.moments"] = "of the file, as its centre and its products"
        return Inertia(
            centre=point(self.to_robot_frame(com) - origin),
            moments=point(np.diag(rotated_tensor)),
            products=point(rotated_tensor[[0, 0, 1], [1, 2, 2]]),
        )

    def hip(self, chain: LimbChain) -> np.ndarray:
        """Return where a limb begins in the frame of the file, shape (3,) [m]."""
        return self.plan.tree_part(chain.parts[0]).joints[0].anchor

    def note_hinge(self, note_path: str, hinge: Hinge, joint: Joint, sign: float) -> None:
        """Add notes to a hinge: its name in the file, and which of its values are guesses."""
        turn_text = "" if sign > 0 else ", turning the other way"
        zero_text = "" if joint.zero == 0.0 else f", which calls this zero {joint.zero:.6g}"
        self.notes[f"{note_path}.name"] = f"the file's {joint.name}{turn_text}{zero_text}"
        if joint.range is None and hinge.range is not None:
            self.notes[f"{note_path}.range"] = "guess: the file gives no limits"
        if isinstance(hinge.drive, Spring):
            spring_note = "the file's stiffness and damping" if joint.stiffness > 0 else "guess: from the size"
            self.notes[f"{note_path}.drive.stiffness"] = spring_note
            return
        drive = f"{note_path}.drive" if hinge.range is not None else f"{note_path}.drive.servo"
        stated = stated_values(joint)
        guessed = next((name for name in _SERVO_LIMITS if name not in stated), None)
        if guessed is not None:
            self.notes[f"{drive}.{guessed}"] = (
                "guess: from the size, as all of this servo that has no note (design.servo_for)"
            )
        for name in stated:
            self.notes[f"{drive}.{name}"] = "of the file"
        if joint.armature > self.size.max_armature:
            self.notes[f"{drive}.armature"] = f"of the file, {joint.armature:g}, but no more than suits the body"
            self.remarks.append(
                f"The file's armature of up to {self.max_file_armature:.3g} kg m2 is more than {_ARMATURE_RATIO:g} of "
                f"the robot's mass times its length squared; the draft has {self.size.max_armature:.3g} kg m2."
            )


def empty_draft(plan: BodyPlan, words: Words) -> DraftState:
    """Return the state of a draft before its first hinge: no matches, remarks or notes yet."""
    corners = plan.plane.to_robot_frame(np.concatenate([plan.tree_part(i).corners for i in plan.axis]))
    axis_length = float(np.ptp(corners[:, 0]))
    length = max(axis_length, 0.2 * plan.tree.size)
    max_armature = max(_ARMATURE_RATIO * plan.tree.mass * axis_length**2, 1e-15)
    return DraftState(
        plan=plan,
        words=words,
        level=_level(plan),
        size=Size(mass=plan.tree.mass, length=length, max_armature=max_armature),
        heaviest=max(tree_part.mass for tree_part in plan.tree.parts),
        max_file_armature=max(joint.armature for tree_part in plan.tree.parts for joint in tree_part.joints),
    )


def point(values: np.ndarray) -> Point:
    """Return three numbers as a design has them."""
    return float(values[0]), float(values[1]), float(values[2])


def _level(plan: BodyPlan) -> float:
    """Return the height of the axis: that of its pitch and roll hinges in the middle, else of the root's origin [m]."""
    heights = [
        float(plan.plane.to_robot_frame(joint.anchor)[2])
        for inner_index, outer_index in zip(plan.axis[:-1], plan.axis[1:], strict=True)
        for joint, _ in links_between(plan, inner_index, outer_index)
        if abs((plan.plane.turn @ joint.axis)[2]) < 0.5
    ]
    if heights:
        return sorted(heights)[len(heights) // 2]
    root_index = 0 if 0 in plan.axis else plan.axis[0]
    return float(plan.plane.to_robot_frame(plan.tree_part(root_index).origin)[2])
