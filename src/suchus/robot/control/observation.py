"""Observations: what the sensors of the robot measure, each divided by its scale, as one row of -1 to 1."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import sqrt
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from suchus.core import rotation
from suchus.core.errors import UnknownName
from suchus.robot.control.sensed import Sensed
from suchus.robot.design import GRAVITY, Robot, layout, servo_ranges
from suchus.robot.robots import ROBOTS, size_relative_to_article

_CAIMAN = ROBOTS["caiman"]
ANGLE = float(np.pi)
"""Scale of angles [rad]: no joint turns further, and the angle of a crank is given within half a turn."""
SPEED = 10.0
"""Scale of servos' speeds [rad/s] for a body as long as the article's; their no-load speed is 7."""
RATE = 10.0
"""Scale of the gyroscope [rad/s] for a body as long as the article's; twice what a death roll reaches."""
ACCELERATION = 4 * GRAVITY
"""Scale of the accelerometer [m/s2]; the range that a cheap one is set to."""
GOAL_DISTANCE_SCALE = 4.0
"""Scale of the distance to a goal, over the robot's length [-]."""
TRACKING_ERROR_SCALE = 0.5
"""Scale of the tracking error of a servo [rad]."""
BASIC_READINGS = (
    "servo_position",
    "servo_velocity",
    "servo_torque",
    "foot_pressure",
    "belly_pressure",
    "tail_pressure",
    "upward",
    "ahead",
    "angular_velocity",
    "acceleration",
    "clock",
    "last_action",
)
"""Readings of a task without a goal or a command."""
GOAL_READINGS = ("goal_direction", "goal_distance")
"""Readings that a task with a goal adds."""
COMMAND_READINGS = ("command", "heading_error")
"""Readings that a task with commands adds; the heading error is that of the IMU."""
FAILURE_READINGS = ("failure",)
"""Readings that a task adds in which the robot is told which servos have failed."""
ROBOT_READINGS = (
    "servo_position",
    "servo_velocity",
    "servo_torque",
    "upward",
    "angular_velocity",
    "acceleration",
    "clock",
    "last_action",
    *COMMAND_READINGS,
    "tracking_error",
    *FAILURE_READINGS,
)
"""Readings of a robot with servos on a bus and an IMU, without sensors of contact and without a compass."""


class Sense(NamedTuple):
    """Columns of an observation that belong together."""

    name: str
    """Name of the reading."""
    columns: slice
    """Columns of the reading in an observation."""
    scale: str
    """Scale by which it is divided, with its unit."""
    description: str
    """Description of the measured quantity."""


@lru_cache(maxsize=64)
def senses(robot: Robot, *, goal: bool = False) -> tuple[Sense, ...]:
    """Return the columns of an observation of a robot, in order.

    Args:
        robot: the robot.
        goal: whether its task has a goal, which adds two readings.
    """
    return observation_layout(robot, (*BASIC_READINGS, *(GOAL_READINGS if goal else ())))


@lru_cache(maxsize=64)
def observation_layout(robot: Robot, readings: tuple[str, ...]) -> tuple[Sense, ...]:
    """Return the columns of some readings of a robot, one reading after the other.

    Args:
        robot: the robot.
        readings: names of the readings, in the order of their columns.

    Raises:
        UnknownName: there is no such reading.
    """
    all_readings = _all_readings(robot)
    for name in readings:
        if name not in all_readings:
            raise UnknownName("reading", name, all_readings)
    counts = [all_readings[name][0] for name in readings]
    ends = np.cumsum(counts).tolist()
    return tuple(
        Sense(name, slice(end - count, end), *all_readings[name][1:])
        for name, count, end in zip(readings, counts, ends, strict=True)
    )


def _all_readings(robot: Robot) -> dict[str, tuple[int, str, str]]:
    """Return number of columns, scale and description of every reading of a robot by its name."""
    robot_layout, pace = layout(robot), 1.0 / sqrt(size_relative_to_article(robot).length)
    servos, cranks, root = len(robot_layout.servos), bool(is_crank(robot).any()), robot_layout.robot.root
    angle = "angle of each servo" + (", of a crank within half a turn to either side" if cranks else "")
    last_action_text = "last commanded angle of each servo, relative to its centre: the last action"
    pressure_text = "normal force under each foot, the mean over a control period"
    return {
        "servo_position": (servos, "pi rad", angle),
        "servo_velocity": (servos, f"{SPEED * pace:.3g} rad/s", "speed of each servo"),
        "servo_torque": (servos, "its limit, N m", "torque of each servo"),
        "foot_pressure": (len(robot_layout.limbs), "weight, N", pressure_text),
        "belly_pressure": (len(robot_layout.trunk), "weight, N", "the same under each body of the trunk"),
        "tail_pressure": (1, "weight, N", "the same under the tail"),
        "upward": (3, "1", f"the world's upward direction in the {root}, from the IMU's orientation"),
        "ahead": (3, "1", f"the world's x direction in the {root}, from the IMU's orientation"),
        "angular_velocity": (3, f"{RATE * pace:.3g} rad/s", f"of the IMU in the {root}, in its own frame"),
        "acceleration": (3, f"{ACCELERATION:.1f} m/s2", "of the IMU with gravity, in its own frame"),
        "clock": (2, "1", "sine and cosine of the phase of a clock with the gait's period"),
        "last_action": (servos, "span, rad", last_action_text),
        "goal_direction": (3, "1", f"level direction to the goal in the {root}, as a beacon and the IMU give it"),
        "goal_distance": (
            1,
            f"{GOAL_DISTANCE_SCALE:g} L, m",
            "distance that remains to the goal, L the robot's length",
        ),
        "command": (2, "its greatest value, m/s and rad/s", "commanded forward speed and turning rate"),
        "heading_error": (1, "1 rad", "commanded heading minus that of the IMU, left positive"),
        "tracking_error": (
            servos,
            f"{TRACKING_ERROR_SCALE:g} rad",
            "commanded minus measured angle of each servo, its size through a low pass",
        ),
        "failure": (servos, "1", "1 for each servo that is known to have failed, else 0"),
    }


def is_crank(robot: Robot) -> Bool[np.ndarray, " servo"]:
    """Return which servos are cranks, which turn round and round [-]."""
    return np.asarray(~np.isfinite(servo_ranges(robot)).all(axis=1))


SENSES = senses(_CAIMAN)
"""The columns of an observation of the article's robot."""


def reading_columns(
    observations: Float[np.ndarray, "*b n"],
    name: str,
    robot: Robot | str = _CAIMAN,
    readings: tuple[str, ...] | None = None,
) -> Float[np.ndarray, "*b m"]:
    """Return the columns of one reading of ``senses``.

    Args:
        observations: observations as an environment returns them.
        name: name of the reading, as ``clock``.
        robot: the robot that they belong to, or its name in the catalog.
        readings: readings of the observations, as ``Task.observed``; None for those of a task with or without a goal.

    Raises:
        UnknownName: there is no such reading.
    """
    resolved = ROBOTS.resolve(robot)
    rows = senses(resolved) if readings is None else observation_layout(resolved, readings)
    if readings is None and observations.shape[-1] > rows[-1].columns.stop:
        rows = senses(resolved, goal=True)
    columns = {sense.name: sense.columns for sense in rows}
    if name not in columns:
        raise UnknownName("reading", name, columns)
    return observations[..., columns[name]]


@lru_cache(maxsize=64)
def scales(robot: Robot) -> Mapping[str, float | Float[np.ndarray, " servo"]]:
    """Return the scale of every reading of a robot by its name, in SI units; numbers or one for each servo."""
    weight, time_factor = robot.mass * GRAVITY, sqrt(size_relative_to_article(robot).length)
    limits = np.array([robot.servo(name).torque for name in layout(robot).servos])
    limits.flags.writeable = False
    return MappingProxyType(
        {
            "servo_position": ANGLE,
            "servo_velocity": SPEED / time_factor,
            "servo_torque": limits,
            "foot_pressure": weight,
            "belly_pressure": weight,
            "tail_pressure": weight,
            "angular_velocity": RATE / time_factor,
            "acceleration": ACCELERATION,
            "goal_distance": GOAL_DISTANCE_SCALE * robot.length,
            "tracking_error": TRACKING_ERROR_SCALE,
        }
    )


class Observer:
    """Writes the observations of robots of one kind, whose columns and scales are looked up once.

    Args:
        robot: the robot; its limits, weight and length are the scales.
        count: number of robots.
        readings: names of the readings, in the order of their columns.
    """

    def __init__(self, robot: Robot, count: int, readings: Sequence[str] = BASIC_READINGS) -> None:
        columns = observation_layout(robot, tuple(readings))
        self._rows = np.zeros((count, columns[-1].columns.stop if columns else 0))
        self._columns = {sense.name: self._rows[:, sense.columns] for sense in columns}
        self._scale = np.ones(self._rows.shape[1])
        for sense in columns:
            self._scale[sense.columns] = scales(robot).get(sense.name, 1.0)
        self._cranks = is_crank(robot)

    def observe(
        self,
        sensed: Sensed,
        phase: Float[np.ndarray, " run"],
        commanded: Float[np.ndarray, "run servo"],
        goal: tuple[Float[np.ndarray, "run 2"], Float[np.ndarray, " run"]] | None = None,
        further: Mapping[str, Float[np.ndarray, "run _"]] | None = None,
    ) -> Float[np.ndarray, "run n"]:
        """Return one row for each robot; readings beyond their scales are clipped to -1 and 1, missing ones are 0.

        Args:
            sensed: the readings of its sensors.
            phase: phase of the clock [cycle].
            commanded: angles of the servos relative to their centres, over the span [-].
            goal: vector in the world from each centre of mass to its goal, and the distance that remains [m]; None if
                the task has none.
            further: readings that are not of sensors, by name, in SI units: ``command``, ``heading_error``,
                ``tracking_error``, ``failure``.
        """
        turn = 2 * np.pi * phase
        position = sensed.servo_position
        if self._cranks.any():
            position = np.where(self._cranks, np.mod(position + np.pi, 2 * np.pi) - np.pi, position)
        upward, forward = rotation.upward(sensed.orientation), rotation.world_x(sensed.orientation)
        values: dict[str, np.ndarray] = {
            "servo_position": position,
            "servo_velocity": sensed.servo_velocity,
            "servo_torque": sensed.servo_torque,
            "foot_pressure": sensed.foot_pressure,
            "belly_pressure": sensed.belly_pressure,
            "tail_pressure": sensed.tail_pressure[:, None],
            "upward": upward,
            "ahead": forward,
            "angular_velocity": sensed.angular_velocity,
            "acceleration": sensed.acceleration,
            "clock": np.stack([np.sin(turn), np.cos(turn)], axis=1),
            "last_action": commanded,
            **(further or {}),
        }
        if goal is not None:
            offset, remaining = goal
            values["goal_direction"] = _direction(offset, upward, forward)
            values["goal_distance"] = remaining[:, None]
        for name, column in self._columns.items():
            column[:] = values[name]
        rows = self._rows
        rows /= self._scale
        if not np.isfinite(rows).all():
            rows[~np.isfinite(rows)] = 0.0
        return np.clip(rows, -1.0, 1.0).astype(np.float32)


def decode_observations(observations: Float[np.ndarray, "run n"], robot: Robot, time: float) -> Sensed:
    """Return the sensor readings from which observations were made; clipped readings stay clipped.

    Args:
        observations: one row for each robot.
        robot: the robot that they belong to.
        time: time of the readings [s].
    """
    readings = {sense.name: reading_columns(observations, sense.name, robot).astype(float) for sense in senses(robot)}
    scale = scales(robot)
    rows = np.stack([readings["ahead"], np.cross(readings["upward"], readings["ahead"]), readings["upward"]], axis=1)
    return Sensed(
        time=time,
        servo_position=scale["servo_position"] * readings["servo_position"],
        servo_velocity=scale["servo_velocity"] * readings["servo_velocity"],
        servo_torque=scale["servo_torque"] * readings["servo_torque"],
        foot_pressure=scale["foot_pressure"] * readings["foot_pressure"],
        belly_pressure=scale["belly_pressure"] * readings["belly_pressure"],
        tail_pressure=scale["tail_pressure"] * readings["tail_pressure"][:, 0],
        orientation=Rotation.from_matrix(rows).as_quat(scalar_first=True),
        angular_velocity=scale["angular_velocity"] * readings["angular_velocity"],
        acceleration=scale["acceleration"] * readings["acceleration"],
    )


def _direction(offset: np.ndarray, upward: np.ndarray, forward: np.ndarray) -> np.ndarray:
    """Return the direction to the goal in the root, shape (run, 3), 0 at the goal [-]."""
    distance = np.linalg.norm(offset, axis=1, keepdims=True)
    unit = np.divide(offset, distance, out=np.zeros_like(offset), where=distance > 0.0)
    return np.asarray(unit[:, :1] * forward + unit[:, 1:] * np.cross(upward, forward))
