"""The salamander's swim as filmed, joint by joint, and the lateral envelope of a swim for comparison with it."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core import rotation
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import ANIMAL_SWIM
from suchus.robot.kinematics.tree import frames, landmarks
from suchus.robot.motion import Curve, Gait, servo_parts

FOLDED = np.radians(-85.0)
"""Yaw of the limbs, which lie back along the body as in the film [rad]."""
STRIDE = 0.225
"""Stride of the swimming animal, mean over 2.6 to 3.8 Hz [body length]. Source: that of ``ANIMAL_SWIM``."""
FREQUENCIES = (2.6, 2.9, 3.4, 3.8)
"""Frequencies at which the animal was filmed [Hz]."""


def animal_gait(robot: Robot, frequency: float) -> Gait:
    """Return the animal's swim for a robot with its joints, limbs folded back."""
    robot_layout = layout(robot)
    angles = ANIMAL_SWIM | {f"{limb.name}_yaw": (FOLDED,) for limb in robot_layout.limbs}
    parts = servo_parts(robot)
    return Gait(
        name=f"animal_swim_{frequency:g}",
        period=1.0 / frequency,
        duty_factor=0.5,
        limb_phases=(0.0,) * len(robot_layout.limbs),
        curves=tuple(Curve(servo=name, part=parts[name], angles=curve) for name, curve in angles.items()),
    )


class Envelope(NamedTuple):
    """Lateral swing along a body."""

    position: Float[np.ndarray, " point"]
    """Distance behind the snout along the straight body, from 0 to 1 [body length]."""
    swing: Float[np.ndarray, " point"]
    """Peak-to-peak swing across the course of each cycle, mean over the cycles [body length]."""


def envelope(robot: Robot, record: xr.Dataset, start: float, period: float) -> Envelope:
    """Return the lateral swing of snout, axis joints and tail tip over the whole cycles of one run after a time.

    Args:
        robot: robot of the record.
        record: record of one run.
        start: time from which cycles are measured [s].
        period: period of a cycle [s].
    """
    excerpt = record.sel(time=slice(start - 1e-9, None))
    straight = _midline(robot, np.zeros((1, excerpt.sizes["joint"])))[0]
    points = _midline(robot, excerpt.joint_angle.transpose("time", "joint").values)
    turn = rotation.matrix(excerpt.orientation.transpose("time", "wxyz").values)
    world = np.einsum("tij,tpj->tpi", turn, points) + excerpt.position.transpose("time", "xyz").values[:, None]
    centre, samples_per_cycle = (
        excerpt.centre_of_mass.transpose("time", "xyz").values,
        period / float(excerpt.time[1] - excerpt.time[0]),
    )
    swings = []
    for cycle in range(int((excerpt.sizes["time"] - 1) / samples_per_cycle + 1e-6)):
        start_index, end_index = round(cycle * samples_per_cycle), round((cycle + 1) * samples_per_cycle)
        displacement = (centre[end_index] - centre[start_index])[:2]
        lateral_axis = np.array([-displacement[1], displacement[0]]) / np.hypot(*displacement)
        lateral_offset = (
            world[start_index : end_index + 1, :, :2]
            - np.linspace(0, 1, end_index - start_index + 1)[:, None, None] * displacement
        ) @ lateral_axis
        swings.append(np.ptp(lateral_offset, axis=0))
    return Envelope((straight[0, 0] - straight[:, 0]) / robot.length, np.mean(swings, axis=0) / robot.length)


def _midline(robot: Robot, angles: Float[np.ndarray, "time joint"]) -> Float[np.ndarray, "time point 3"]:
    """Return snout, joints of the axis and tail tip in the frame of the root [m]."""
    body_frames, marks = frames(robot, angles), landmarks(robot, angles)
    names = [body.name for body in layout(robot).bodies]
    axis = body_frames.positions[:, [names.index(segment.name) for segment in robot.axis]]
    points = np.concatenate([marks.snout[:, None], axis, marks.tail[:, None]], axis=1)
    order = np.argsort(-points[0, :, 0], kind="stable")
    return np.asarray(points[:, order])
