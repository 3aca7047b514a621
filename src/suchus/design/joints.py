"""The names of legs, joints and servos of crocodile-like robots; ``design.layout`` has those of any robot."""

from typing import Literal

from suchus.design.body import Robot
from suchus.design.layout import layout

LegName = Literal["LF", "RF", "LH", "RH"]
LEGS: tuple[LegName, ...] = ("LF", "RF", "LH", "RH")
_SPINE = ("spine_yaw_1", "spine_pitch_1", "spine_yaw_2", "spine_pitch_2", "spine_yaw_3")


def leg_joints() -> tuple[str, ...]:
    """Return the twelve leg joints, ``LF_yaw`` to ``RH_knee``."""
    return tuple(f"{leg}_{joint}" for leg in LEGS for joint in ("yaw", "pitch", "knee"))


def spine_joints() -> tuple[str, ...]:
    """Return the five spine joints of the article from the pelvis forward."""
    return _SPINE


def cable_joints(robot: Robot) -> tuple[str, ...]:
    """Return the driven yaw joints of the tail from root to tip."""
    return robot.tail.driven


def fin_joints(robot: Robot) -> tuple[str, ...]:
    """Return the passive joints of the tail from root to tip, yaw before pitch in each."""
    return robot.tail.passive


def servo_names(robot: Robot | None = None) -> tuple[str, ...]:
    """Return the servos of a robot; without one, those of the article's."""
    if robot is not None:
        return layout(robot).servos
    return (*leg_joints(), *_SPINE, "tail_pitch", "tail_cable")


def joint_names(robot: Robot) -> tuple[str, ...]:
    """Return every hinge of a robot."""
    return layout(robot).hinges
