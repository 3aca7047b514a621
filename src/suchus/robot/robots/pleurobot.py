"""Pleurobot: a salamander robot with four joints in each limb and eleven along its axis."""

from math import radians

from suchus.robot.design import Robot
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.design.scale import contact_for, servo_for
from suchus.robot.robots._plans import BY_SIZE, Joint, girdle, limb, row

_NAMES = ("head", "neck", "chest", "trunk_1", "trunk_2", "trunk_3", "pelvis", *(f"tail_{i}" for i in range(1, 6)))
_LENGTHS = (0.140, 0.070, 0.110, 0.110, 0.110, 0.110, 0.110, 0.110, 0.110, 0.110, 0.110, 0.100)
_RADII = (0.040, 0.036, 0.045, 0.042, 0.042, 0.042, 0.045, 0.036, 0.032, 0.028, 0.024, 0.018)
_LENGTH, _MASS = sum(_LENGTHS), 5.5
_LIMB_MASSES = (0.18, 0.10, 0.02)
_PELVIS = _NAMES.index("pelvis")

_servo = servo_for(_MASS, _LENGTH)


def _limb(upper_length: float, lower_length: float):  # type: ignore[no-untyped-def]
    """Return a limb of yaw, pitch, roll and elbow with two lengths, above and below the elbow [m]."""
    return limb(
        upper_length,
        lower_length,
        radius=0.016,
        masses=_LIMB_MASSES,
        foot=0.016,
        servo=_servo,
        roll=True,
        limit=radians(110),
    )


def _joint(number: int) -> list[Joint]:
    if number < 2:
        return [(f"neck_yaw_{2 - number}", "yaw", _servo, radians(60))]
    word, count = ("spine", _PELVIS - number) if number < _PELVIS else ("tail", number - _PELVIS + 1)
    return [(f"{word}_yaw_{count}", "yaw", _servo, radians(60))]


_axis_mass = _MASS - 4 * sum(_LIMB_MASSES)
_volumes = [radius**2 * length for radius, length in zip(_RADII, _LENGTHS, strict=True)]
robot = Robot(
    name="pleurobot",
    root="pelvis",
    axis=row(
        _NAMES,
        _LENGTHS,
        _RADII,
        [_axis_mass * volume / sum(_volumes) for volume in _volumes],
        [_joint(i) for i in range(len(_NAMES) - 1)],
    ),
    girdles=(
        girdle("F", "chest", -0.03, 0.060, 0.0, _limb(0.143, 0.100)),
        girdle("H", "pelvis", -0.03, 0.060, 0.0, _limb(0.118, 0.100)),
    ),
    cables=(),
    contact=contact_for(_LENGTH, foot_friction=0.8, skin_friction=0.4),
)
"""The robot of Karakasiliotis et al. 2016: its bones and joints; the rest chosen."""

_REASONS = (
    Reason(r"\.radius$", 0.7, 1.4, "room for the servos between the bones"),
    Reason(r"\.mass$", 0.7, 1.4, "5.5 kg in all, spread by volume; a limb of 0.3 kg holds four servos"),
    Reason(
        r"^axis\[\d+\]\.(front|rear)$|\.(start|end)\[0\]$", 0.8, 1.2, "eleven joints over 1.3 m, the animal's trunk"
    ),
    Reason(r"^girdles\[\d\]\.(at|aside|above)$", 0.7, 1.3, "hips beside the girdles' servos"),
)
_PUBLISHED = (r"^girdles.*\.end\[1\]$",)
chosen = assumptions_of(robot, (*_REASONS, *BY_SIZE), _PUBLISHED)
"""Every number that the publication does not give, with its plausible range and the reason."""
