"""Failed joints, the article's lost ones: by girdle and hinge, in one leg or both, limp or locked."""

from typing import Literal

import numpy as np

from suchus.core.errors import UnknownName
from suchus.robot.design import Robot, layout
from suchus.robot.motion import Gait, cycle_targets
from suchus.sim.fault import Fault
from suchus.sim.faults import Limp, Locked

Joint = Literal["front_yaw", "hind_yaw", "front_pitch", "hind_pitch", "front_knee", "hind_knee"]
Kind = Literal["limp", "locked"]
Legs = Literal["one", "both"]
FAILED_JOINTS: tuple[Joint, ...] = ("front_yaw", "hind_yaw", "front_pitch", "hind_pitch")
"""The joints whose failure the article reports, in the order of Figs 18 to 21."""
KINDS: tuple[Kind, ...] = ("limp", "locked")
LEGS_FAILED: tuple[Legs, ...] = ("one", "both")


def failing_joints(robot: Robot) -> tuple[str, ...]:
    """Return the joints of limbs that can fail, hinge by hinge from the hip, girdle by girdle.

    A girdle is ``front``, ``hind``, or ``middle`` with its number where there are several; only the hind one is there
    where there is one.
    """
    robot_layout = layout(robot)
    words = girdle_words(len(robot_layout.robot.girdles))
    ranked = [
        (i, number, f"{words[number]}_{name.partition('_')[2]}")
        for number in range(len(words))
        for i, name in enumerate(robot_layout.servos[robot_layout.limbs[2 * number].servos])
    ]
    return tuple(name for _, _, name in sorted(ranked))


def girdle_words(count: int) -> tuple[str, ...]:
    """Return the names of girdles from the front to the hind one."""
    middle = ("middle",) if count == 3 else tuple(f"middle{i}" for i in range(1, count - 1))
    return ("front", *middle, "hind") if count > 1 else ("hind",) * count


def joint_failure(
    robot: Robot, gait: Gait, joint: str, kind: Kind, legs: Legs = "one", *, hold: float = 0.5
) -> tuple[Fault, ...]:
    """Return the faults of a run in which joints have failed from the start; one leg is the left one.

    Args:
        robot: robot whose joints they are.
        gait: gait that it walks in.
        joint: one of ``failing_joints(robot)``.
        kind: without torque, or locked.
        legs: one or both of the girdle.
        hold: where a locked joint holds in the range that the gait asks of it, see ``angle_at``.

    Raises:
        UnknownName: the robot has no such joint.
    """
    if joint not in failing_joints(robot):
        raise UnknownName("joint of a girdle", joint, failing_joints(robot))
    robot_layout = layout(robot)
    word, _, axis = joint.partition("_")
    girdle = robot_layout.robot.girdles[girdle_words(len(robot_layout.robot.girdles)).index(word)].name
    names = [f"{side}{girdle}_{axis}" for side in ("L", "R")[: 1 if legs == "one" else 2]]
    if kind == "limp":
        return tuple(Limp(name) for name in names)
    return tuple(Locked(name, angle=angle_at(robot, gait, name, hold)) for name in names)


def angle_at(robot: Robot, gait: Gait, servo: str, fraction: float) -> float:
    """Return an angle in the range that a gait asks of a servo: 0 the least, 1 the greatest [rad]."""
    clock = np.arange(128) / 128
    angles = cycle_targets(robot, gait, clock)[:, layout(robot).servos.index(servo)]
    return float(angles.min() + fraction * (angles.max() - angles.min()))
