"""Salamandra robotica: a salamander of eight yaw joints whose four legs are cranks that turn all round."""

from dataclasses import replace
from math import cos, radians, sin

from suchus.robot.design import Crank, Foot, Hinge, Limb, Link, Robot
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.design.scale import contact_for, servo_for
from suchus.robot.robots._plans import BY_SIZE, Joint, girdle, row

_LENGTHS = (0.108, 0.066, 0.095, 0.095, 0.108, 0.095, 0.095, 0.095, 0.095)
_LENGTH, _MASS = sum(_LENGTHS), 2.0
_NAMES = ("head", "shoulder", "trunk_1", "trunk_2", "trunk_3", "pelvis", "tail_1", "tail_2", "tail_3")
_RADII = (0.026, 0.028, 0.024, 0.024, 0.024, 0.028, 0.024, 0.024, 0.022)
_LEG_MASS = 0.03
_BEND = radians(60)  # of the shank against the upper piece
_HIP = -0.020  # from the segment's joint back to the hips [m]

_servo = servo_for(_MASS, _LENGTH)
_crank = Crank(servo=replace(_servo, speed=20.0))
_limb = Limb(
    links=(
        Link(
            name="upper",
            hinges=(Hinge(name="crank", turn="roll", drive=_crank),),
            end=(0.0, 0.024, 0.0),
            radius=0.008,
            mass=0.4 * _LEG_MASS,
        ),
        Link(
            name="shank",
            hinges=(),
            end=(0.0, 0.045 * cos(_BEND), -0.045 * sin(_BEND)),
            radius=0.006,
            mass=0.4 * _LEG_MASS,
        ),
    ),
    foot=Foot(radius=0.013, mass=0.2 * _LEG_MASS),
)


def _joint(number: int) -> list[Joint]:
    word, count = ("neck", 1) if number == 0 else ("spine", 5 - number) if number < 5 else ("tail", number - 4)
    return [(f"{word}_yaw_{count}", "yaw", _servo, radians(65))]


robot = Robot(
    name="salamandra",
    root="pelvis",
    axis=row(
        _NAMES,
        _LENGTHS,
        _RADII,
        [(_MASS - 4 * _LEG_MASS) * length / _LENGTH for length in _LENGTHS],
        [_joint(i) for i in range(len(_LENGTHS) - 1)],
    ),
    girdles=(
        girdle("F", "shoulder", _HIP, 0.032, 0.0, _limb),
        girdle("H", "pelvis", _HIP, 0.032, 0.0, _limb),
    ),
    cables=(),
    contact=contact_for(_LENGTH, foot_friction=0.8, skin_friction=0.3),
)
"""The robot of Ijspeert, Crespi, Ryczko and Cabelguen 2007 after the dimensions of its public model."""

_REASONS = (
    Reason(r"\.radius$", 0.7, 1.3, "round segments of about the published height and width"),
    Reason(r"\.mass$", 0.7, 1.4, "2 kg as a whole for the published outline; legs of 30 g"),
    Reason(r"^axis.*\.(start|end)\[0\]$", 0.8, 1.2, "a rod as long as its segment, its round ends in the joints"),
)
_PUBLISHED = (
    r"^axis\[\d\]\.(front|rear)$",
    r"^girdles\[\d\]\.(at|aside|above)$",
    r"\.foot\.radius$",
    r"^girdles.*\.end\[",
)
chosen = assumptions_of(robot, (*_REASONS, *BY_SIZE), _PUBLISHED)
"""Every number that the public model does not give, with its plausible range and the reason."""
