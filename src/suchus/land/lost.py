"""Joints lost as the article speaks of them: by girdle and axis, in one leg or both, limp or locked."""

from typing import Literal

import numpy as np

from suchus.design import Crocodile, servo_names
from suchus.fault import Fault
from suchus.faults import Limp, Locked
from suchus.motion import Gait, servo_targets

Joint = Literal["front_yaw", "hind_yaw", "front_pitch", "hind_pitch", "front_knee", "hind_knee"]
Kind = Literal["limp", "locked"]
Legs = Literal["one", "both"]
LOST: tuple[Joint, ...] = ("front_yaw", "hind_yaw", "front_pitch", "hind_pitch")
"""The joints whose loss the article reports, in the order of Figs 18 to 21."""
KNEES: tuple[Joint, ...] = ("front_knee", "hind_knee")
"""The second pitch joint of each leg (III.D), of whose loss the article says nothing."""
KINDS: tuple[Kind, ...] = ("limp", "locked")
LEGS_LOST: tuple[Legs, ...] = ("one", "both")


def lost(
    robot: Crocodile, gait: Gait, joint: Joint, kind: Kind, legs: Legs = "one", *, hold: float = 0.5
) -> tuple[Fault, ...]:
    """Return the faults of a run in which joints are lost from the start; one leg is the left one.

    Args:
        robot: whose joints they are.
        gait: that it walks in.
        joint: which.
        kind: without torque, or held.
        legs: one or both of the girdle.
        hold: where a locked joint holds in the range that the gait asks of it, see ``angle_at``.
    """
    girdle, _, axis = joint.partition("_")
    names = [f"{side}{girdle[0].upper()}_{axis}" for side in ("L", "R")[: 1 if legs == "one" else 2]]
    if kind == "limp":
        return tuple(Limp(name) for name in names)
    return tuple(Locked(name, angle=angle_at(robot, gait, name, hold)) for name in names)


def angle_at(robot: Crocodile, gait: Gait, servo: str, share: float) -> float:
    """Return an angle in the range that a gait asks of a servo: 0 the least, 1 the greatest [rad]."""
    phase = np.arange(128)[:, None] / 128 + np.array(gait.limb_phases)
    asked = servo_targets(robot, gait, phase)[:, servo_names().index(servo)]
    return float(asked.min() + share * (asked.max() - asked.min()))
