"""What a learner is given: readings that the robot has, each over its scale, as one row of -1 to 1."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus import rotation
from suchus.control import Sensed
from suchus.design import GRAVITY, LEGS, Crocodile, servo_names, spine_joints

SERVOS = len(servo_names())
ANGLE = float(np.pi)
"""Scale of angles [rad]: no joint turns so far."""
SPEED = 10.0
"""Scale of servos' speeds [rad/s]; their no-load speed is 7."""
RATE = 10.0
"""Scale of the gyroscope [rad/s]; twice what a death roll reaches."""
ACCELERATION = 4 * GRAVITY
"""Scale of the accelerometer [m/s2]; the range that a cheap one is set to."""


class Sense(NamedTuple):
    """Some columns of an observation."""

    name: str
    """What they are."""
    columns: slice
    """Where they are."""
    scale: str
    """What a reading is divided by."""
    what: str
    """In words."""


_ROWS = (
    ("servo_position", SERVOS, "pi rad", "angle of each servo"),
    ("servo_velocity", SERVOS, f"{SPEED:g} rad/s", "speed of each servo"),
    ("servo_torque", SERVOS, "its limit, N m", "torque of each servo"),
    ("foot_pressure", len(LEGS), "weight, N", "normal force under each foot, the mean over a control period"),
    ("belly_pressure", len(spine_joints()) + 1, "weight, N", "the same under each body of the trunk"),
    ("tail_pressure", 1, "weight, N", "the same under the tail"),
    ("upward", 3, "1", "the world's upward direction in the pelvis, from the IMU's orientation"),
    ("ahead", 3, "1", "the world's x direction in the pelvis, from the IMU's orientation"),
    ("angular_velocity", 3, f"{RATE:g} rad/s", "of the IMU in the pelvis, in its own frame"),
    ("acceleration", 3, f"{ACCELERATION:.1f} m/s2", "of the IMU with gravity, in its own frame"),
    ("clock", 2, "1", "sine and cosine of the phase of a clock with the gait's period"),
    ("told", SERVOS, "span, rad", "angle that each servo was told last, from its centre: the last action"),
)


def _laid_out() -> tuple[Sense, ...]:
    ends = np.cumsum([size for _, size, _, _ in _ROWS]).tolist()
    return tuple(
        Sense(name, slice(end - size, end), scale, what)
        for (name, size, scale, what), end in zip(_ROWS, ends, strict=True)
    )


SENSES = _laid_out()
"""The columns of an observation, in order."""
SIZE = SENSES[-1].columns.stop
"""How many they are."""


def part(observations: Float[np.ndarray, "*b n"], name: str) -> Float[np.ndarray, "*b m"]:
    """Return some columns of observations by their name in ``SENSES``."""
    return observations[..., next(sense.columns for sense in SENSES if sense.name == name)]


def observations(
    robot: Crocodile,
    sensed: Sensed,
    phase: Float[np.ndarray, " run"],
    told: Float[np.ndarray, "run 19"],
) -> Float[np.ndarray, "run n"]:
    """Return one row for each robot; readings beyond their scales are cut off at -1 and 1, lost ones are 0.

    Args:
        robot: whose limits and weight are the scales.
        sensed: the readings.
        phase: of the clock [cycle].
        told: from the centre, over the span [-].
    """
    limits = np.array([robot.servo(name).torque for name in servo_names()])
    weight = robot.mass * GRAVITY
    upward, ahead = rotation.upward(sensed.orientation), rotation.ahead(sensed.orientation)
    turn = 2 * np.pi * phase
    rows = np.concatenate(
        [
            sensed.servo_position / ANGLE,
            sensed.servo_velocity / SPEED,
            sensed.servo_torque / limits,
            sensed.foot_pressure / weight,
            sensed.belly_pressure / weight,
            sensed.tail_pressure[:, None] / weight,
            upward,
            ahead,
            sensed.angular_velocity / RATE,
            sensed.acceleration / ACCELERATION,
            np.stack([np.sin(turn), np.cos(turn)], axis=1),
            told,
        ],
        axis=1,
    )
    return np.clip(np.where(np.isfinite(rows), rows, 0.0), -1.0, 1.0).astype(np.float32)
