"""The salamander's own swim, joint by joint as it was filmed, and the numbers of a swim that stand beside it."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus import rotation
from suchus.design import Robot, layout
from suchus.kinematics.tree import frames, landmarks
from suchus.motion import Curve, Gait, servo_parts

# fmt: off
ANIMAL_SWIM = {
    "neck_yaw_1": (-0.133, -0.187, -0.183, -0.14, -0.073, 0.022, 0.118, 0.173, 0.197, 0.183, 0.13, 0.051, -0.024),
    "spine_yaw_2": (0.092, -0.05, -0.135, -0.203, -0.224, -0.226, -0.136, -0.046, 0.042, 0.12, 0.197, 0.202, 0.199),
    "spine_yaw_1": (0.175, 0.072, -0.03, -0.108, -0.164, -0.215, -0.219, -0.168, -0.065, 0.047, 0.13, 0.177, 0.203),
    "tail_yaw_1": (-0.217, -0.198, -0.108, 0.009, 0.109, 0.184, 0.222, 0.213, 0.162, 0.07, -0.037, -0.118, -0.18),
    "tail_yaw_2": (-0.309, -0.39, -0.339, -0.249, -0.087, 0.109, 0.274, 0.368, 0.401, 0.325, 0.196, 0.017, -0.123),
    "tail_yaw_3": (0.004, -0.327, -0.487, -0.549, -0.52, -0.378, -0.118, 0.152, 0.384, 0.498, 0.559, 0.484, 0.324),
    "tail_yaw_4": (0.404, 0.136, -0.095, -0.319, -0.427, -0.525, -0.535, -0.355, -0.077, 0.154, 0.346, 0.441, 0.489),
    "tail_yaw_5": (0.567, 0.507, 0.289, 0.03, -0.252, -0.428, -0.483, -0.54, -0.484, -0.274, 0.023, 0.268, 0.414),
}
# fmt: on
"""Joint angles over one cycle, six harmonics of the mean cycle [rad].

Source: Pleurodeles waltl; Karakasiliotis et al. 2013, Biol. Cybern. 107, 529, public data of Pleurobot.
"""
FOLDED = np.radians(-85.0)
"""How far the limbs lie back along the body; the animal holds them so, and was not filmed closer [rad]."""
STRIDE = 0.225
"""Of the swimming animal, the mean over 2.6 to 3.8 Hz [body length]. Source: that of ``ANIMAL_SWIM``."""
FREQUENCIES = (2.6, 2.9, 3.4, 3.8)
"""At which it was filmed [Hz]."""


def played(robot: Robot, frequency: float) -> Gait:
    """Return the animal's swim for a robot with its joints, limbs folded back."""
    place = layout(robot)
    angles = ANIMAL_SWIM | {f"{limb.name}_yaw": (FOLDED,) for limb in place.limbs}
    parts = servo_parts(robot)
    return Gait(
        name=f"animal_swim_{frequency:g}",
        period=1.0 / frequency,
        duty_factor=0.5,
        limb_phases=(0.0,) * len(place.limbs),
        curves=tuple(Curve(servo=name, part=parts[name], angles=curve) for name, curve in angles.items()),
    )


class Envelope(NamedTuple):
    """How far a body swings to the side."""

    place: Float[np.ndarray, " point"]
    """Behind the snout along the straight body, from 0 to 1 [body length]."""
    swing: Float[np.ndarray, " point"]
    """From end to end, across the course of each cycle, the mean over the cycles [body length]."""


def envelope(robot: Robot, record: xr.Dataset, start: float, period: float) -> Envelope:
    """Return how far snout, joints of the axis and tail tip swing in the whole cycles of one run from a time on.

    Args:
        robot: whose record it is.
        record: of one run.
        start: [s].
        period: of a cycle [s].
    """
    part = record.sel(time=slice(start - 1e-9, None))
    straight = _midline(robot, np.zeros((1, part.sizes["joint"])))[0]
    points = _midline(robot, part.joint_angle.transpose("time", "joint").values)
    turn = rotation.matrix(part.orientation.transpose("time", "wxyz").values)
    world = np.einsum("tij,tpj->tpi", turn, points) + part.position.transpose("time", "xyz").values[:, None]
    centre, every = part.centre_of_mass.transpose("time", "xyz").values, period / float(part.time[1] - part.time[0])
    swings = []
    for cycle in range(int((part.sizes["time"] - 1) / every + 1e-6)):
        first, last = round(cycle * every), round((cycle + 1) * every)
        way = (centre[last] - centre[first])[:2]
        left = np.array([-way[1], way[0]]) / np.hypot(*way)
        aside = (world[first : last + 1, :, :2] - np.linspace(0, 1, last - first + 1)[:, None, None] * way) @ left
        swings.append(np.ptp(aside, axis=0))
    return Envelope((straight[0, 0] - straight[:, 0]) / robot.length, np.mean(swings, axis=0) / robot.length)


def _midline(robot: Robot, angles: Float[np.ndarray, "time joint"]) -> Float[np.ndarray, "time point 3"]:
    """Return snout, joints of the axis and tail tip in the frame of the root [m]."""
    found, marks = frames(robot, angles), landmarks(robot, angles)
    names = [body.name for body in layout(robot).bodies]
    axis = found.places[:, [names.index(segment.name) for segment in layout(robot).robot.axis]]
    points = np.concatenate([marks.snout[:, None], axis, marks.tail[:, None]], axis=1)
    order = np.argsort(-points[0, :, 0], kind="stable")
    return np.asarray(points[:, order])
