"""How well the robots of a pack follow their commands, and the readings that follow from it."""

from math import pi

import numpy as np
from jaxtyping import Bool, Float

from suchus.apps.envs.task import Task
from suchus.robot.control.sensed import decay_factor
from suchus.robot.design import layout

_MAX_HEADING_ERROR = 1.0  # [rad]; the commanded heading is no further from the measured one
_MEMORY = 0.5  # time constant of the means, over the period of the clock [-]


class Tracking:
    """Mean speed and turning rate of each robot, its heading against the commanded one, and its servos' lag.

    Args:
        task: the task.
        count: number of robots.
    """

    def __init__(self, task: Task, count: int) -> None:
        self._task, servos = task, len(layout(task.robot).servos)
        self._keep = decay_factor(_MEMORY * task.period, task.decision)
        commands = task.commands
        self._max_command = np.ones(2)
        if commands is not None:
            bounds = np.abs([commands.forward, commands.turn]).max(axis=1)
            self._max_command = np.where(bounds > 0.0, bounds, 1.0)
        self._motion = np.zeros((count, 2))  # mean speed [m/s] and turning rate [rad/s]
        self._facing, self._heading_error = np.zeros(count), np.zeros(count)
        self._tracking_error = np.zeros((count, servos))

    def restart(self, robot: int, facing: float) -> None:
        """Let a robot begin anew, at rest and in its commanded heading, with a yaw [rad]."""
        self._motion[robot], self._tracking_error[robot] = 0.0, 0.0
        self._facing[robot], self._heading_error[robot] = facing, 0.0

    def step(
        self,
        active_mask: Bool[np.ndarray, " run"],
        displacement: Float[np.ndarray, "run 3"],
        facing: Float[np.ndarray, " run"],
        command: Float[np.ndarray, "run 2"],
        lag: Float[np.ndarray, "run servo"],
    ) -> None:
        """Take in what a step did.

        Args:
            active_mask: which robots acted.
            displacement: displacement of each centre of mass in the world [m].
            facing: yaw of each robot [rad].
            command: commanded speed [m/s] and turning rate [rad/s].
            lag: commanded minus measured angle of each servo [rad].
        """
        step = self._task.decision
        facing = np.where(np.isfinite(facing), facing, self._facing)
        turned = (facing - self._facing + pi) % (2 * pi) - pi
        forward = displacement[:, 0] * np.cos(facing) + displacement[:, 1] * np.sin(facing)
        motion = _finite(np.stack([forward, turned], axis=1) / step)
        error = self._heading_error + command[:, 1] * step - turned
        lag = _finite(np.abs(lag))
        active = active_mask[:, None]
        self._motion = np.where(active, motion + self._keep * (self._motion - motion), self._motion)
        self._tracking_error = np.where(active, lag + self._keep * (self._tracking_error - lag), self._tracking_error)
        clipped_error = np.clip(error, -_MAX_HEADING_ERROR, _MAX_HEADING_ERROR)
        self._heading_error = np.where(active_mask, clipped_error, self._heading_error)
        self._facing = np.where(active_mask, facing, self._facing)

    def readings(
        self, command: Float[np.ndarray, "run 2"], failure: Float[np.ndarray, "run servo"]
    ) -> dict[str, np.ndarray]:
        """Return the readings that are not of sensors, by name.

        Args:
            command: commanded speed [m/s] and turning rate [rad/s].
            failure: 1 for each servo that has failed [-].
        """
        return {
            "command": command / self._max_command,
            "heading_error": self._heading_error[:, None],
            "tracking_error": self._tracking_error,
            "failure": failure,
        }

    def errors(self, command: Float[np.ndarray, "run 2"]) -> Float[np.ndarray, "run 2"]:
        """Return the sizes of the errors of speed and turning rate, times the time of a step; 0 without commands."""
        if self._task.commands is None:
            return np.zeros_like(command)
        return np.abs(self._motion - command) * self._task.decision


def _finite(values: np.ndarray) -> np.ndarray:
    """Return an array whose numbers that are not finite are 0."""
    is_finite = np.isfinite(values)
    return values if is_finite.all() else np.where(is_finite, values, 0.0)
