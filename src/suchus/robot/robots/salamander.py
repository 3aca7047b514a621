"""A salamander, the animal: eight yaw joints, six passive pitch joints, four joints a limb; 0.1 m and 3 g."""

from itertools import pairwise
from math import radians

from suchus.core.physics import GRAVITY
from suchus.robot.design import Robot, Spring
from suchus.robot.design.reasons import Reason, assumptions_of
from suchus.robot.design.scale import contact_for, gravity_time, servo_for
from suchus.robot.robots._plans import BY_SIZE, Joint, girdle, limb, row

_JOINTS = (0.0150, 0.0257, 0.0364, 0.0471, 0.0579, 0.0686, 0.0793, 0.0900)  # m from the snout
_MASSES = (0.331e-3, 0.514e-3, 0.630e-3, 0.528e-3, 0.267e-3, 0.209e-3, 0.157e-3, 0.119e-3, 0.075e-3)  # kg
_RADII = (5.0e-3, 4.6e-3, 5.0e-3, 4.6e-3, 3.4e-3, 3.0e-3, 2.6e-3, 2.2e-3, 1.6e-3)
_LENGTH, _MASS = 0.100, 3.0e-3
_PITCH_BESIDE = (2, 4, 5, 6, 7, 8)  # the yaw joints beside which a passive pitch joint sits, counted from 1
_LIMB_MASSES = (0.012e-3, 0.008e-3, 0.002e-3)
_HIP_PLACE = 0.0461  # m from the snout

_servo = servo_for(_MASS, _LENGTH)
_ends = (0.0, *_JOINTS, _LENGTH)
_NAMES = ("head", "chest", "trunk", "waist", "tail_1", "tail_2", "tail_3", "tail_4", "tail_5")
_HIPS = 3  # place of the segment that carries the hind limbs


def _passive(stiffness: float) -> Spring:
    """Return a passive joint after the published model.

    Args:
        stiffness: stiffness over the body's weight times its length [-].
    """
    torque = _MASS * GRAVITY * _LENGTH
    return Spring(
        stiffness=stiffness * torque,
        damping=0.036 * torque * gravity_time(_LENGTH),
        armature=2.8e-5 * _MASS * _LENGTH**2,
    )


def _joints(number: int) -> list[Joint]:
    """Return the joints behind a segment: a yaw joint, and perhaps a passive pitch joint."""
    is_trunk = number < _HIPS
    word = ("neck" if number == 0 else "spine") if is_trunk else "tail"
    count = 1 if number == 0 else abs(number - _HIPS) + (not is_trunk)
    joints: list[Joint] = [(f"{word}_yaw_{count}", "yaw", _servo, radians(90))]
    if number + 1 in _PITCH_BESIDE:
        joints.append((f"{word}_pitch_{count}", "pitch", _passive(0.11 if is_trunk else 0.036), radians(40)))
    return joints


_limb = limb(0.005, 0.006, radius=0.9e-3, masses=_LIMB_MASSES, foot=1.2e-3, servo=_servo, roll=True, limit=radians(110))
robot = Robot(
    name="salamander",
    root="waist",
    axis=row(
        _NAMES,
        [b - a for a, b in pairwise(_ends)],
        _RADII,
        _MASSES,
        [_joints(i) for i in range(len(_JOINTS))],
    ),
    girdles=(
        girdle("F", "chest", 0.0, 0.004, -0.002, _limb),
        girdle("H", "waist", _JOINTS[2] - _HIP_PLACE, 0.003, -0.002, _limb),
    ),
    cables=(),
    contact=contact_for(_LENGTH, foot_friction=0.7, skin_friction=0.7),
)

"""After the model of a Pleurodeles scaled to 0.10 m that is used with SalamandraSNN (MIT)."""

_REASONS = (
    Reason(
        r"^axis\[\d\]\.hinges\[1\]\.drive\.(stiffness|damping)$",
        0.5,
        5.0,
        "of the model of the animal that the robot is after, in parts of weight, length and gravity time; half to five "
        "times the stiffness changes the stride by a tenth",
    ),
    Reason(r"^contact\.(foot|skin)_friction$", 0.7, 1.4, "that of the same model, feet and skin alike"),
    Reason(r"\.radius$", 0.7, 1.4, "the animal's outline; a belly that clears the ground by a fifth of the body"),
    Reason(r"^girdles\[\d\]\.limb.*\.mass$", 0.5, 2.0, "a limb of 22 mg: 0.7 % of the body"),
    Reason(r"^axis.*\.(start|end)\[0\]$", 0.8, 1.2, "a rod as long as its segment, its round ends in the joints"),
)
_PUBLISHED = (
    r"^axis\[\d\]\.(front|rear)$",
    r"^axis\[\d\]\.shapes\[0\]\.mass$",
    r"^girdles\[\d\]\.(at|aside|above)$",
    r"\.foot\.radius$",
    r"^girdles.*\.end\[",
)
chosen = assumptions_of(robot, (*_REASONS, *BY_SIZE), _PUBLISHED)
"""Every number that the model does not give, with its plausible range and the reason."""
