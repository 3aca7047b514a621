"""The names of legs, joints and servos, and their order: spelled once, here.

Servos: three per leg (yaw, pitch, knee) in the order of ``LEGS``, five along the spine from the pelvis
forward, the tail's pitch, the tail's cable. Joints: the same without the cable, then the cable joints, then
the passive ones. A positive angle turns a foot forward (yaw), down (pitch), a shank down (knee), the trunk's
front end left (yaw) or down (pitch), the tail's tip down (pitch) or right (yaw).
"""

from typing import Literal

from suchus.design.robot import Crocodile

LegName = Literal["LF", "RF", "LH", "RH"]
LEGS: tuple[LegName, ...] = ("LF", "RF", "LH", "RH")
SPINE = ("spine_yaw_1", "spine_pitch_1", "spine_yaw_2", "spine_pitch_2", "spine_yaw_3")


def leg_joints() -> tuple[str, ...]:
    """Return the twelve leg joints, ``LF_yaw`` to ``RH_knee``."""
    return tuple(f"{leg}_{joint}" for leg in LEGS for joint in ("yaw", "pitch", "knee"))


def spine_joints() -> tuple[str, ...]:
    """Return the five spine joints from the pelvis forward."""
    return SPINE


def cable_joints(robot: Crocodile) -> tuple[str, ...]:
    """Return the cable joints of the tail from root to tip."""
    return tuple(f"tail_yaw_{i + 1}" for i in range(robot.tail.joints))


def fin_joints(robot: Crocodile) -> tuple[str, ...]:
    """Return the passive joints of the tail from root to tip, yaw before pitch in each."""
    return tuple(f"fin_{axis}_{i + 1}" for i in range(robot.tail.fin_segments) for axis in ("yaw", "pitch"))


def servo_names() -> tuple[str, ...]:
    """Return the 19 servos, the same for every robot."""
    return (*leg_joints(), *SPINE, "tail_pitch", "tail_cable")


def joint_names(robot: Crocodile) -> tuple[str, ...]:
    """Return every hinge: the 18 that servos turn directly, the cable joints, the passive ones."""
    return (*leg_joints(), *SPINE, "tail_pitch", *cable_joints(robot), *fin_joints(robot))
