"""Observations: what the sensors of the robot measure, each divided by its scale, as one row of -1 to 1."""

from collections.abc import Mapping
from functools import lru_cache
from math import sqrt
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation

from suchus.core import rotation
from suchus.core.errors import UnknownName
from suchus.robot.control import Sensed
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
        goal: whether its task has a goal, which adds the last two readings.
    """
    robot_layout, pace = layout(robot), 1.0 / sqrt(size_relative_to_article(robot).length)
    servos, cranks = len(robot_layout.servos), bool(is_crank(robot).any())
    angle = "angle of each servo" + (", of a crank within half a turn to either side" if cranks else "")
    last_action_text = "last commanded angle of each servo, relative to its centre: the last action"
    rows: tuple[tuple[str, int, str, str], ...] = (
        ("servo_position", servos, "pi rad", angle),
        ("servo_velocity", servos, f"{SPEED * pace:.3g} rad/s", "speed of each servo"),
        ("servo_torque", servos, "its limit, N m", "torque of each servo"),
        (
            "foot_pressure",
            len(robot_layout.limbs),
            "weight, N",
            "normal force under each foot, the mean over a control period",
        ),
        ("belly_pressure", len(robot_layout.trunk), "weight, N", "the same under each body of the trunk"),
        ("tail_pressure", 1, "weight, N", "the same under the tail"),
        (
            "upward",
            3,
            "1",
            f"the world's upward direction in the {robot_layout.robot.root}, from the IMU's orientation",
        ),
        ("ahead", 3, "1", f"the world's x direction in the {robot_layout.robot.root}, from the IMU's orientation"),
        (
            "angular_velocity",
            3,
            f"{RATE * pace:.3g} rad/s",
            f"of the IMU in the {robot_layout.robot.root}, in its own frame",
        ),
        ("acceleration", 3, f"{ACCELERATION:.1f} m/s2", "of the IMU with gravity, in its own frame"),
        ("clock", 2, "1", "sine and cosine of the phase of a clock with the gait's period"),
        ("last_action", servos, "span, rad", last_action_text),
    )
    if goal:
        towards = f"level direction to the goal in the {robot_layout.robot.root}, as a beacon and the IMU give it"
        rows += (("goal_direction", 3, "1", towards),)
        rows += (
            (
                "goal_distance",
                1,
                f"{GOAL_DISTANCE_SCALE:g} L, m",
                "distance that remains to the goal, L the robot's length",
            ),
        )
    ends = np.cumsum([count for _, count, _, _ in rows]).tolist()
    return tuple(
        Sense(name, slice(end - count, end), scale, description)
        for (name, count, scale, description), end in zip(rows, ends, strict=True)
    )


def is_crank(robot: Robot) -> Bool[np.ndarray, " servo"]:
    """Return which servos are cranks, which turn round and round [-]."""
    return np.asarray(~np.isfinite(servo_ranges(robot)).all(axis=1))


SENSES = senses(_CAIMAN)
"""The columns of an observation of the article's robot."""


def reading_columns(
    observations: Float[np.ndarray, "*b n"], name: str, robot: Robot | str = _CAIMAN
) -> Float[np.ndarray, "*b m"]:
    """Return the columns of one reading of ``senses``.

    Args:
        observations: observations as an environment returns them.
        name: name of the reading, as ``clock``.
        robot: the robot that they belong to, or its name in the catalog.

    Raises:
        UnknownName: there is no such reading.
    """
    readings = senses(ROBOTS.resolve(robot))
    if observations.shape[-1] > readings[-1].columns.stop:
        readings = senses(ROBOTS.resolve(robot), goal=True)
    columns = {sense.name: sense.columns for sense in readings}
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
        }
    )


class Observer:
    """Writes the observations of robots of one kind, whose columns and scales are looked up once.

    Args:
        robot: the robot; its limits, weight and length are the scales.
        count: number of robots.
        goal: whether their task has a goal.
    """

    def __init__(self, robot: Robot, count: int, *, goal: bool) -> None:
        readings = senses(robot, goal=goal)
        self._rows = np.zeros((count, readings[-1].columns.stop))
        self._columns = {sense.name: self._rows[:, sense.columns] for sense in readings}
        self._scale = np.ones(self._rows.shape[1])
        for sense in readings:
            self._scale[sense.columns] = scales(robot).get(sense.name, 1.0)
        self._cranks = is_crank(robot)

    def observe(
        self,
        sensed: Sensed,
        phase: Float[np.ndarray, " run"],
        commanded: Float[np.ndarray, "run servo"],
        goal: tuple[Float[np.ndarray, "run 2"], Float[np.ndarray, " run"]] | None = None,
    ) -> Float[np.ndarray, "run n"]:
        """Return one row for each robot; readings beyond their scales are clipped to -1 and 1, missing ones are 0.

        Args:
            sensed: the readings of its sensors.
            phase: phase of the clock [cycle].
            commanded: angles of the servos relative to their centres, over the span [-].
            goal: vector in the world from each centre of mass to its goal, and the distance that remains [m]; None if
                the task has none.
        """
        columns, turn = self._columns, 2 * np.pi * phase
        position = sensed.servo_position
        if self._cranks.any():
            position = np.where(self._cranks, np.mod(position + np.pi, 2 * np.pi) - np.pi, position)
        upward, forward = rotation.upward(sensed.orientation), rotation.world_x(sensed.orientation)
        columns["servo_position"][:] = position
        columns["servo_velocity"][:] = sensed.servo_velocity
        columns["servo_torque"][:] = sensed.servo_torque
        columns["foot_pressure"][:] = sensed.foot_pressure
        columns["belly_pressure"][:] = sensed.belly_pressure
        columns["tail_pressure"][:, 0] = sensed.tail_pressure
        columns["upward"][:] = upward
        columns["ahead"][:] = forward
        columns["angular_velocity"][:] = sensed.angular_velocity
        columns["acceleration"][:] = sensed.acceleration
        columns["clock"][:, 0], columns["clock"][:, 1] = np.sin(turn), np.cos(turn)
        columns["last_action"][:] = commanded
        if goal is not None:
            offset, remaining = goal
            columns["goal_direction"][:] = _direction(offset, upward, forward)
            columns["goal_distance"][:, 0] = remaining
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
