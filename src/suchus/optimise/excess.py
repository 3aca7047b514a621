"""How far a gait asks for more than joints and servos give: what a search needs to find its way back."""

import numpy as np

from suchus.design import LEGS, Crocodile, servo_names
from suchus.motion import Gait, foot_targets, servo_targets
from suchus.motion.targets import servo_range

PHASES = 128
"""Looks over a cycle."""
_LENGTH, _ANGLE, _SPEED = 0.01, 0.1, 1.0  # [m], [rad], [rad/s]; what counts as one


def excess(robot: Crocodile, gait: Gait) -> float:
    """Return how far a gait is from what a robot can follow; zero where it can [-].

    Counted are the way by which feet lie outside their legs' reach, in centimetres, the angles by which joints leave
    their range, in tenths of a radian, and the speeds by which servos turn too fast, in radians a second.
    """
    phase = np.arange(PHASES)[:, None] / PHASES + np.array(gait.limb_phases)
    targets = servo_targets(robot, gait, phase, clip=True)
    ranges = np.array([servo_range(robot, name) for name in servo_names()])
    beyond = np.maximum(np.maximum(ranges[:, 0] - targets, targets - ranges[:, 1]), 0.0).max(axis=0)
    turned = np.abs(np.diff(targets, axis=0, append=targets[:1])).max(axis=0) * PHASES / gait.period
    fast = np.array([robot.servo(name).speed for name in servo_names()])
    return float(
        _out_of_reach(robot, gait, phase) / _LENGTH
        + beyond.sum() / _ANGLE
        + np.maximum(turned - fast, 0.0).sum() / _SPEED
    )


def _out_of_reach(robot: Crocodile, gait: Gait, phase: np.ndarray) -> float:
    """Return the sum over the legs of how far their feet's paths lie outside their reach [m]."""
    feet, total = foot_targets(robot, gait, phase), 0.0
    for i, name in enumerate(LEGS):
        leg = robot.leg(name)
        near, far = leg.reach
        away = np.linalg.norm(feet[:, i] - np.array([leg.hip_offset, 0.0, 0.0]), axis=-1)
        total += float(np.maximum(np.maximum(near - away, away - far), 0.0).max())
    return total
