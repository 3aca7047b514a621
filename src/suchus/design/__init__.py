"""What a robot is: frozen values in SI units, without defaults and without physics."""

from suchus.design.chosen import Chosen, unit_at, value_at, with_values
from suchus.design.contact import Contact
from suchus.design.joints import (
    LEGS,
    LegName,
    cable_joints,
    fin_joints,
    joint_names,
    leg_joints,
    servo_names,
    spine_joints,
)
from suchus.design.leg import Leg
from suchus.design.robot import Crocodile
from suchus.design.servo import Servo
from suchus.design.servos import with_servos, with_speed_lines
from suchus.design.spine import Spine
from suchus.design.tail import Tail
from suchus.design.trunk import Head, Pelvis, Thorax

__all__ = [
    "LEGS",
    "Chosen",
    "Contact",
    "Crocodile",
    "Head",
    "Leg",
    "LegName",
    "Pelvis",
    "Servo",
    "Spine",
    "Tail",
    "Thorax",
    "cable_joints",
    "fin_joints",
    "joint_names",
    "leg_joints",
    "servo_names",
    "spine_joints",
    "unit_at",
    "value_at",
    "with_servos",
    "with_speed_lines",
    "with_values",
]
