"""Robots with another forebody, other servos or longer parts, and the control that lets them stand up at once."""

from operator import attrgetter

import numpy as np

from suchus.core.errors import OutsideLimits
from suchus.robot.control.standing import Balance, Standing
from suchus.robot.design import Robot, with_values
from suchus.robot.motion import Gait
from suchus.robot.motion.posture import sample_postures
from suchus.robot.motion.rising import stand_up

START_TIME = 0.2
"""Start of standing up in runs without a crawl [s]."""
PARTS = {
    "leg": ("hind_leg.femur", "hind_leg.tibia", "front_leg.femur", "front_leg.tibia"),
    "spine": ("spine.base", "spine.link"),
    "head": ("head.snout",),
}
"""Fields of the robot that make up the length of each body part."""


def with_forebody(robot: Robot, mass: float, torque: float) -> Robot:
    """Return the robot with another forebody mass and another torque of the trunk's pitch servos.

    Args:
        robot: robot that is changed; its pelvis takes up the difference in mass.
        mass: mass of thorax and head together [kg].
        torque: torque limit of the trunk's pitch servos [N m].
    """
    forebody_mass = robot.thorax.mass + robot.head.mass
    return with_values(
        robot,
        {
            "thorax.mass": robot.thorax.mass * mass / forebody_mass,
            "head.mass": robot.head.mass * mass / forebody_mass,
            "pelvis.mass": max(robot.pelvis.mass + forebody_mass - mass, 0.02),
            "spine.pitch_servo.torque": torque,
        },
    )


def with_length(robot: Robot, body_part: str, factor: float) -> Robot:
    """Return the robot with one body part scaled in length; its masses do not change."""
    return with_values(robot, {path: factor * attrgetter(path)(robot) for path in PARTS[body_part]})


def length(robot: Robot, body_part: str) -> float:
    """Return the length of a body part [m]; for the legs that of the hind leg."""
    leg = robot.hind_leg
    return {"leg": leg.femur + leg.tibia, "spine": robot.spine.length, "head": robot.head.snout}[body_part]


def fit_gait_to_legs(gait: Gait, robot: Robot, original: Robot) -> Gait:
    """Return the gait with heights and reaches in proportion to a robot's legs; strokes and lifts stay the same."""
    factor = length(robot, "leg") / length(original, "leg")
    return gait.with_numbers(stroke=gait.number("stroke") / factor, lift=gait.number("lift") / factor)


def stand_control(robot: Robot, lead: float, balance: Balance | None, size: float) -> Standing | None:
    """Return a control that stands up at once and keeps standing; None where the joints cannot take the postures.

    Args:
        robot: robot that stands up.
        lead: distance of its feet ahead of its centre of mass when it stands [m].
        balance: feedback rule by which it keeps its balance; None for no feedback.
        size: size of the design from which it is varied, over that of the article's robot [-].
    """
    try:
        rise = stand_up(robot, lead=lead, size=size)
        sample_postures(robot, rise, np.linspace(0.0, rise.duration, 200))
    except OutsideLimits:
        return None
    return Standing(at=START_TIME, hold=86400.0, balance=balance, rise=rise)


def upright_time(robot: Robot) -> float:
    """Return the time at which a robot that stands up at once is upright [s]."""
    return Standing(at=START_TIME, hold=0.0).upright_from(robot)
