"""Joint angles of an animal as a gait of a robot: every column of the table to the servo that it belongs to."""

import re

import numpy as np

from suchus.capture.angle_table import AngleCycle
from suchus.design import Layout, LimbPlace, Robot, layout
from suchus.errors import OutsideLimits, UnknownName
from suchus.kinematics import limb as limb_kinematics
from suchus.motion import AngleTable, Curve
from suchus.motion.angle_table import table_targets

_AXIS = re.compile(r"^axis (\d+)$", re.IGNORECASE)
_LIMB = re.compile(r"^(left|right) (shoulder|hip)-(yaw|pitch|roll)$|^(left|right) (elbow|knee)$", re.IGNORECASE)
_FRONT = ("shoulder", "elbow")
_STEPS = 200  # of the cycle, to see when a foot goes forward


def to_angle_table(cycle: AngleCycle, robot: Robot, *, name: str, period: float) -> AngleTable:
    """Return the gait that plays measured joint angles on a robot; nothing is fitted.

    A column is called after the robot's servo, or as in tables of animals: ``Axis 3``, the third lateral hinge from
    the head, positive where the body is concave on its right; ``Left Shoulder-yaw``, ``-pitch``, ``-roll`` and ``Left
    Elbow`` of a fore limb, ``Hip`` and ``Knee`` of a hind limb, positive as the hinges of a limb are: forward, down,
    the lower limb forward, bent. A limb swings while its foot goes forward in its girdle's frame.

    Args:
        cycle: the angles, as ``read_angles`` returns them.
        robot: who plays them.
        name: of the gait.
        period: of its cycle [s].

    Raises:
        UnknownName: a column belongs to no servo of the robot.
        OutsideLimits: two columns belong to the same servo.
    """
    place = layout(robot)
    found = [_servo(place, joint) for joint in cycle.joints]
    twice = next((number for number, _ in found if [n for n, _ in found].count(number) > 1), None)
    if twice is not None:
        raise OutsideLimits(f"{cycle.source} has two columns for servo {place.servos[twice]}; leave one of them.")
    count = 2 * cycle.harmonics.shape[1] - 1  # as many samples as the harmonics have numbers
    angles = cycle.at(np.arange(count) / count)
    curves = tuple(
        Curve(servo=place.servos[number], angles=tuple(round(float(one), 3) for one in sign * angles[:, i]))
        for i, (number, sign) in enumerate(found)
    )
    table = AngleTable(name=name, period=period, duty_factor=0.5, limb_phases=(), curves=curves)
    swings = [_swing(robot, table, limb) for limb in place.limbs]
    duty = 1.0 - float(np.mean([share for _, share in swings])) if swings else 0.5
    return AngleTable(
        name=name,
        period=period,
        duty_factor=round(min(max(duty, 0.05), 0.95), 3),
        limb_phases=tuple(round((1.0 - start) % 1.0, 3) for start, _ in swings),
        curves=curves,
    )


def _servo(place: Layout, joint: str) -> tuple[int, float]:
    """Return the number of the servo that a column belongs to, and the sign of its angle."""
    word = " ".join(joint.split())
    if word in place.servos:
        return place.servos.index(word), 1.0
    axis, limb = _AXIS.match(word), _LIMB.match(word)
    if axis and 1 <= int(axis[1]) <= len(place.axial_yaw):
        number = int(axis[1]) - 1
        return place.axial_yaw[number], -place.axial_left[number]
    if limb and place.limbs:
        side, part, turn = limb[1] or limb[4], limb[2] or limb[5], limb[3]
        girdle = 0 if part.lower() in _FRONT else place.limbs[-1].number
        mine = next(one for one in place.limbs if one.number == girdle and (one.side > 0) == (side.lower() == "left"))
        hinges = mine.girdle.limb.hinges
        names = [hinge.name for hinge in hinges if turn is None or hinge.turn == turn.lower()]
        wanted = f"{mine.name}_{names[0] if turn else names[-1]}" if names else ""
        if wanted in place.servos:
            return place.servos.index(wanted), 1.0
    raise UnknownName(f"joint of robot {place.robot.name!r}", joint, (*place.servos, *_spelled(place)))


def _spelled(place: Layout) -> tuple[str, ...]:
    """Return further names of columns that a robot could play, as an example of each kind."""
    axis = (f"Axis 1 to {len(place.axial_yaw)}",) if place.axial_yaw else ()
    return (*axis, *(("Left Shoulder-yaw", "Left Hip-yaw", "Left Elbow", "Left Knee") if place.limbs else ()))


def _swing(robot: Robot, table: AngleTable, limb: LimbPlace) -> tuple[float, float]:
    """Return when the foot of a limb begins to go forward, and for which share of the cycle it does [cycle]."""
    clock = np.arange(_STEPS) / _STEPS
    design, place = limb.girdle.limb, layout(robot)
    targets, angles = table_targets(robot, table, clock), np.zeros((_STEPS, len(design.hinges)))
    for i, hinge in enumerate(design.hinges):
        if hinge.servo is not None:
            angles[:, i] = targets[:, place.servos.index(f"{limb.name}_{hinge.name}")]
    ahead = limb_kinematics.forward(design, angles)[:, 0]
    start, end = int(np.argmin(ahead)), int(np.argmax(ahead))
    return start / _STEPS, ((end - start) % _STEPS) / _STEPS
