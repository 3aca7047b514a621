"""What is gathered while a robot is drafted from a body plan."""

from dataclasses import dataclass, field

import numpy as np

from suchus.design import Hinge, Spring
from suchus.design.segment import Point
from suchus.model.importing.draft_hinges import Match, Size
from suchus.model.importing.options import Words
from suchus.model.importing.plan import BodyPlan, LimbChain, links_between
from suchus.model.importing.tree import Joint


@dataclass(slots=True, kw_only=True, eq=False)
class Making:
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
    matches: list[Match] = field(default_factory=list)
    """Hinges so far."""
    remarks: list[str] = field(default_factory=list)
    """What was guessed and what was not taken, in sentences."""
    notes: dict[str, str] = field(default_factory=dict)
    """Guesses by the place of the number in the robot's file."""

    def into(self, points: np.ndarray) -> np.ndarray:
        """Return points of the file in the robot's frame, shape (..., 3) [m]."""
        return np.asarray(self.plan.plane.into(points) - np.array([0.0, 0.0, self.level]))

    def turned(self, axis: np.ndarray) -> np.ndarray:
        """Return a direction of the file in the robot's frame, shape (3,) [-]."""
        return np.asarray(self.plan.plane.turn @ axis)

    def hip(self, chain: LimbChain) -> np.ndarray:
        """Return where a limb begins in the frame of the file, shape (3,) [m]."""
        return self.plan.part(chain.parts[0]).joints[0].anchor

    def note_hinge(self, place: str, hinge: Hinge, joint: Joint, sign: float) -> None:
        """Say beside a hinge which one of the file it is, and what of it is guessed."""
        turned = "" if sign > 0 else ", turning the other way"
        drawn = "" if joint.zero == 0.0 else f", which calls this zero {joint.zero:.6g}"
        self.notes[f"{place}.name"] = f"the file's {joint.name}{turned}{drawn}"
        if joint.range is None and hinge.range is not None:
            self.notes[f"{place}.range"] = "guess: the file gives no limits"
        if isinstance(hinge.drive, Spring):
            known = "the file's stiffness and damping" if joint.stiffness > 0 else "guess: from the size"
            self.notes[f"{place}.drive.stiffness"] = known
            return
        at = f"{place}.drive" if hinge.range is not None else f"{place}.drive.servo"
        self.notes[f"{at}.kp"] = "guess: from the size, as all of this servo that has no note (design.servo_for)"
        for name in ("torque", "speed"):
            if joint.drive is not None and getattr(joint.drive, name):
                self.notes[f"{at}.{name}"] = "of the file"


def making_of(plan: BodyPlan, words: Words) -> Making:
    """Return a draft that has not begun."""
    corners = plan.plane.into(np.concatenate([plan.part(i).corners for i in plan.axis]))
    length = max(float(np.ptp(corners[:, 0])), 0.2 * plan.tree.size)
    return Making(
        plan=plan,
        words=words,
        level=_level(plan),
        size=Size(mass=plan.tree.mass, length=length),
        heaviest=max(part.mass for part in plan.tree.parts),
    )


def point(values: np.ndarray) -> Point:
    """Return three numbers as a design has them."""
    return float(values[0]), float(values[1]), float(values[2])


def _level(plan: BodyPlan) -> float:
    """Return the height of the axis: that of its pitch and roll hinges in the middle, else of the root's origin [m]."""
    heights = [
        float(plan.plane.into(joint.anchor)[2])
        for near, far in zip(plan.axis[:-1], plan.axis[1:], strict=True)
        for joint, _ in links_between(plan, near, far)
        if abs((plan.plane.turn @ joint.axis)[2]) < 0.5
    ]
    if heights:
        return sorted(heights)[len(heights) // 2]
    place = 0 if 0 in plan.axis else plan.axis[0]
    return float(plan.plane.into(plan.part(place).origin)[2])
