"""Who else stands up: robots with another forebody, other servos, longer parts; and how, at once and for good."""

from operator import attrgetter

import numpy as np

from suchus.core.errors import OutsideLimits
from suchus.robot.control.standing import Balance, Standing
from suchus.robot.design import Robot, with_values
from suchus.robot.motion import Gait
from suchus.robot.motion.posture import plan
from suchus.robot.motion.rising import stand_up

SOON = 0.2
"""When standing up begins where no crawl is needed [s]."""
PARTS = {
    "leg": ("hind_leg.femur", "hind_leg.tibia", "front_leg.femur", "front_leg.tibia"),
    "spine": ("spine.base", "spine.link"),
    "head": ("head.snout",),
}
"""Names of the numbers that make up the length of a part."""


def heavier(robot: Robot, mass: float, torque: float) -> Robot:
    """Return the robot with another forebody, the pelvis taking the rest, and other pitch servos in the trunk."""
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


def lengthened(robot: Robot, body_part: str, factor: float) -> Robot:
    """Return the robot with longer legs, a longer spine, or a longer head; masses stay."""
    return with_values(robot, {path: factor * attrgetter(path)(robot) for path in PARTS[body_part]})


def length(robot: Robot, body_part: str) -> float:
    """Return the length of a part, of the hind leg for the legs [m]."""
    leg = robot.hind_leg
    return {"leg": leg.femur + leg.tibia, "spine": robot.spine.length, "head": robot.head.snout}[body_part]


def fitted(gait: Gait, robot: Robot, original: Robot) -> Gait:
    """Return the gait with its heights and reaches in proportion to a robot's legs, its strokes and lifts as before."""
    factor = length(robot, "leg") / length(original, "leg")
    return gait.with_numbers(stroke=gait.number("stroke") / factor, lift=gait.number("lift") / factor)


def stand_soon(robot: Robot, lead: float, balance: Balance | None, size: float) -> Standing | None:
    """Return a control that stands up at once and stays, or None for a robot that cannot take the postures.

    Args:
        robot: that stands up.
        lead: how far its feet are ahead of its centre of mass when it stands [m].
        balance: by which it keeps its balance.
        size: of the robot of which it is a variant, over that of the article's [-].
    """
    try:
        rise = stand_up(robot, lead=lead, size=size)
        plan(robot, rise, np.linspace(0.0, rise.duration, 200))
    except OutsideLimits:
        return None
    return Standing(at=SOON, hold=86400.0, balance=balance, rise=rise)


def up_at(robot: Robot) -> float:
    """Return when a robot that stands up at once is upright [s]."""
    return Standing(at=SOON, hold=0.0).upright_from(robot)
