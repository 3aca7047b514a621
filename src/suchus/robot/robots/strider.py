"""A strider on six legs of yaw, pitch and knee, with two yaw joints in its trunk and no tail."""

from math import radians

from suchus.robot.design import Robot
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.design.scale import contact_for, servo_for
from suchus.robot.robots._plans import BY_SIZE, girdle, limb, row

_LENGTH, _MASS = 0.60, 3.0
_LIMB_MASSES = (0.09, 0.05, 0.01)
_servo = servo_for(_MASS, _LENGTH)
_limb = limb(0.080, 0.100, radius=0.010, masses=_LIMB_MASSES, foot=0.012, servo=_servo, roll=False, limit=radians(100))
_SEGMENT, _SEGMENT_MASS = _LENGTH / 3, (_MASS - 6 * sum(_LIMB_MASSES)) / 3

robot = Robot(
    name="strider",
    root="rear",
    axis=row(
        ("front", "middle", "rear"),
        (_SEGMENT,) * 3,
        (0.035,) * 3,
        (_SEGMENT_MASS,) * 3,
        [[("spine_yaw_2", "yaw", _servo, radians(40))], [("spine_yaw_1", "yaw", _servo, radians(40))]],
    ),
    girdles=tuple(
        girdle(name, segment, -_SEGMENT / 2, 0.050, 0.0, _limb)
        for name, segment in (("F", "front"), ("M", "middle"), ("H", "rear"))
    ),
    cables=(),
    contact=contact_for(_LENGTH, foot_friction=0.8, skin_friction=0.4),
)
"""Proof that six limbs are no more than three girdles."""

_REASONS = (
    Reason(r"\.radius$", 0.7, 1.4, "room for hobby servos"),
    Reason(r"\.mass$", 0.7, 1.4, "3 kg in all; a limb of 0.15 kg holds three small servos"),
    Reason(
        r"^axis\[\d+\]\.(front|rear)$|\.(start|end)\[\d\]$",
        0.7,
        1.4,
        "invented: three equal segments, legs that sprawl",
    ),
    Reason(r"^girdles\[\d\]\.(at|aside|above)$", 0.7, 1.4, "hips beside the body, in the middle of each segment"),
)
chosen = assumptions_of(robot, (*_REASONS, *BY_SIZE))
"""Every number, with its plausible range and the reason: the robot is invented."""
