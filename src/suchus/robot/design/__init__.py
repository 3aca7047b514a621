"""What a robot is: frozen values in SI units and without physics."""

from suchus.core.physics import GRAVITY, WATER_DENSITY, WATER_VISCOSITY
from suchus.robot.design.article import crocodile, tables_of
from suchus.robot.design.body import Robot
from suchus.robot.design.chosen import Assumption, unit_at, value_at, with_values
from suchus.robot.design.correction import LinkFactors, SectionCorrection
from suchus.robot.design.form import BodyForm
from suchus.robot.design.ground import Contact
from suchus.robot.design.hinge import Cable, Crank, Hinge, LinearActuator, Servo, Spring, Turn
from suchus.robot.design.hull import Chamber, Foam, Hull
from suchus.robot.design.layout import (
    LEGS,
    Layout,
    LegName,
    LimbPlace,
    behind_hips,
    cable_joints,
    front_segment,
    hips_ahead,
    hips_behind_snout,
    joint_names,
    layout,
    leg_joints,
    servo_names,
    servo_ranges,
    spine_joints,
)
from suchus.robot.design.limb import Foot, Girdle, Limb, Link
from suchus.robot.design.motor import LINE, Heat, Motor, Winding
from suchus.robot.design.needs import MEASURED, NEEDS, STANDING, check_needs, lacking
from suchus.robot.design.segment import Inertia, Rod, Segment, Shell
from suchus.robot.design.servos import (
    with_full_torque,
    with_named_servos,
    with_servos,
    with_speed_line,
    with_speed_lines,
    with_spring,
)
from suchus.robot.design.tables import Head, Leg, Pelvis, Spine, Tables, Tail, Thorax

__all__ = [
    "GRAVITY",
    "LEGS",
    "LINE",
    "MEASURED",
    "NEEDS",
    "STANDING",
    "WATER_DENSITY",
    "WATER_VISCOSITY",
    "Assumption",
    "BodyForm",
    "Cable",
    "Chamber",
    "Contact",
    "Crank",
    "Foam",
    "Foot",
    "Girdle",
    "Head",
    "Heat",
    "Hinge",
    "Hull",
    "Inertia",
    "Layout",
    "Leg",
    "LegName",
    "Limb",
    "LimbPlace",
    "LinearActuator",
    "Link",
    "LinkFactors",
    "Motor",
    "Pelvis",
    "Robot",
    "Rod",
    "SectionCorrection",
    "Segment",
    "Servo",
    "Shell",
    "Spine",
    "Spring",
    "Tables",
    "Tail",
    "Thorax",
    "Turn",
    "Winding",
    "behind_hips",
    "cable_joints",
    "check_needs",
    "crocodile",
    "front_segment",
    "hips_ahead",
    "hips_behind_snout",
    "joint_names",
    "lacking",
    "layout",
    "leg_joints",
    "servo_names",
    "servo_ranges",
    "spine_joints",
    "tables_of",
    "unit_at",
    "value_at",
    "with_full_torque",
    "with_named_servos",
    "with_servos",
    "with_speed_line",
    "with_speed_lines",
    "with_spring",
    "with_values",
]
