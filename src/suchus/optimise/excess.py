"""How far a gait asks for more than joints and servos give: what a search needs to find back."""

import numpy as np

from suchus.design import Robot, servo_names, servo_ranges
from suchus.motion import AnyGait, Gait, foot_targets, servo_targets
from suchus.motion.any_body import check_limbs, pattern_targets
from suchus.motion.targets import legs_for

PHASES = 128
"""Looks over a cycle."""
_LENGTH, _ANGLE, _SPEED = 0.01, 0.1, 1.0  # [m], [rad], [rad/s]; what counts as one


def excess(robot: Robot, gait: AnyGait) -> float:
    """Return how far a gait is from what a robot can follow; zero where it can [-].

    Counted are the distance by which feet lie outside their legs' reach, in centimetres, the angles by which joints
    leave their range, in tenths of a radian, and the speeds by which servos turn too fast, in radians a second. A
    pattern or a table says joints' angles, whose feet reach wherever they are.

    Raises:
        SuchusError: the gait is for other limbs, or asks a foot of a pattern for a place beyond its limb's reach.
    """
    if isinstance(gait, Gait):
        phase = np.arange(PHASES)[:, None] / PHASES + np.array(gait.limb_phases)
        targets, away = servo_targets(robot, gait, phase, clip=True), _out_of_reach(robot, gait, phase)
    else:
        check_limbs(robot, gait)
        targets, away = pattern_targets(robot, gait, np.arange(PHASES) / PHASES), 0.0
    ranges = servo_ranges(robot)
    beyond = np.maximum(np.maximum(ranges[:, 0] - targets, targets - ranges[:, 1]), 0.0).max(axis=0)
    turns = np.diff(targets, axis=0, append=targets[:1])
    endless = np.isinf(ranges).any(axis=1)
    turns[:, endless] = (turns[:, endless] + np.pi) % (2 * np.pi) - np.pi  # a crank's angle jumps once a turn
    turned = np.abs(turns).max(axis=0) * PHASES / gait.period
    fast = np.array([robot.servo(name).speed for name in servo_names(robot)])
    return float(away / _LENGTH + beyond.sum() / _ANGLE + np.maximum(turned - fast, 0.0).sum() / _SPEED)


def _out_of_reach(robot: Robot, gait: Gait, phase: np.ndarray) -> float:
    """Return the sum over the legs of how far their feet's paths lie outside their reach [m]."""
    feet, total = foot_targets(robot, gait, phase), 0.0
    for i, leg in enumerate(legs_for(robot, gait)):
        near, far = leg.reach
        away = np.linalg.norm(feet[:, i] - np.array([leg.hip_offset, 0.0, 0.0]), axis=-1)
        total += float(np.maximum(np.maximum(near - away, away - far), 0.0).max())
    return total
