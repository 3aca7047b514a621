"""How far a gait asks for more than joints and servos give: what a search needs to find back."""

import numpy as np

from suchus.design import AnyRobot, servo_names, servo_ranges
from suchus.errors import UnsuitedRobot
from suchus.motion import AnyGait, Gait, foot_targets, servo_targets
from suchus.motion.targets import legs_for

PHASES = 128
"""Looks over a cycle."""
_LENGTH, _ANGLE, _SPEED = 0.01, 0.1, 1.0  # [m], [rad], [rad/s]; what counts as one


def excess(robot: AnyRobot, gait: AnyGait) -> float:
    """Return how far a gait is from what a robot can follow; zero where it can [-].

    Counted are the distance by which feet lie outside their legs' reach, in centimetres, the angles by which joints
    leave their range, in tenths of a radian, and the speeds by which servos turn too fast, in radians a second.
    """
    if not isinstance(gait, Gait):
        raise UnsuitedRobot(f"the search is for gaits of four legs; {gait.name!r} is a pattern: choose another gait.")
    phase = np.arange(PHASES)[:, None] / PHASES + np.array(gait.limb_phases)
    targets = servo_targets(robot, gait, phase, clip=True)
    ranges = servo_ranges(robot)
    beyond = np.maximum(np.maximum(ranges[:, 0] - targets, targets - ranges[:, 1]), 0.0).max(axis=0)
    turned = np.abs(np.diff(targets, axis=0, append=targets[:1])).max(axis=0) * PHASES / gait.period
    fast = np.array([robot.servo(name).speed for name in servo_names(robot)])
    return float(
        _out_of_reach(robot, gait, phase) / _LENGTH
        + beyond.sum() / _ANGLE
        + np.maximum(turned - fast, 0.0).sum() / _SPEED
    )


def _out_of_reach(robot: AnyRobot, gait: Gait, phase: np.ndarray) -> float:
    """Return the sum over the legs of how far their feet's paths lie outside their reach [m]."""
    feet, total = foot_targets(robot, gait, phase), 0.0
    for i, leg in enumerate(legs_for(robot, gait)):
        near, far = leg.reach
        away = np.linalg.norm(feet[:, i] - np.array([leg.hip_offset, 0.0, 0.0]), axis=-1)
        total += float(np.maximum(np.maximum(near - away, away - far), 0.0).max())
    return total
