"""The sensor readings of a batch of robots at one instant."""

from dataclasses import dataclass
from math import exp

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensed:
    """Sensor readings; nothing else reaches a controller."""

    time: float
    """Time since the beginning of the run [s]."""
    servo_position: Float[np.ndarray, "run servo"]
    """Servo angles [rad]."""
    servo_velocity: Float[np.ndarray, "run servo"]
    """Servo speeds [rad/s]."""
    servo_torque: Float[np.ndarray, "run servo"]
    """Servo torques [N m]."""
    foot_pressure: Float[np.ndarray, "run limb"]
    """Normal force under each foot [N]."""
    belly_pressure: Float[np.ndarray, "run segment"]
    """Normal force under each body of the trunk, from the hind girdle forward [N]."""
    tail_pressure: Float[np.ndarray, " run"]
    """Normal force under the tail [N]."""
    orientation: Float[np.ndarray, "run 4"]
    """Orientation of the IMU in the root, as a quaternion wxyz [-]."""
    angular_velocity: Float[np.ndarray, "run 3"]
    """Angular velocity of the IMU, in its own frame [rad/s]."""
    acceleration: Float[np.ndarray, "run 3"]
    """Acceleration of the IMU with gravity, in its own frame [m/s2]."""
    depth: Float[np.ndarray, " run"] | None = None
    """Depth of the root below the level of the water by a pressure sensor, 0 above it [m]; None on dry land."""


def finite(values: Float[np.ndarray, "*any"]) -> Float[np.ndarray, "*any"]:
    """Return readings with NaN and infinities of diverged runs replaced by zero."""
    return np.where(np.isfinite(values), values, 0.0)


def decay_factor(delay: float, period: float) -> float:
    """Return the decay factor of a low-pass filter over one control period, exp(-period / delay) [-].

    Args:
        delay: time constant of the filter [s]; 0 for none.
        period: control period [s].
    """
    return exp(-period / delay) if delay > 0.0 else 0.0
