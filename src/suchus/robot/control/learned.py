"""A trained policy as a control: a table of gait parameters over commands, corrected by a network."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from suchus.core import rotation
from suchus.core.checks import Checks, Schedule
from suchus.core.errors import Doubtful, UnknownName
from suchus.robot.control.controller import SENSED, Command, Runs, union_of_needs
from suchus.robot.control.facing import left_side_sign
from suchus.robot.control.observation import Observer
from suchus.robot.control.pattern_generator import TimeCourses, group_indices
from suchus.robot.control.policy import ACTIONS, Networks, Policy, interpolate
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.design import Robot, layout
from suchus.robot.motion import START, Batch, Steer

_SLACK = 1e-9  # [s]; times are multiples of the control period up to rounding
_SMOOTHING = 0.1  # time constant with which parameters follow the table, over the period of the gait [-]
_MAX_SMOOTHING = 0.2  # [s]; the same at most
_MAX_HEADING_ERROR = 1.0  # [rad]; the commanded heading is no further from the measured one
_ERROR_MEMORY = 0.5  # time constant of the tracking error, over the period of the gait [-]
_MAX_FAILURE_TIME = 1e6  # [s]
_READING_SENSORS = {
    "upward": ("orientation",),
    "ahead": ("orientation",),
    "heading_error": ("orientation", "servo_position"),
    "tracking_error": ("servo_position",),
    "clock": (),
    "last_action": (),
    "command": (),
    "failure": (),
}
"""Sensors of the readings that are not sensors themselves."""
_SHARED_ACTIONS = [name for name, action in ACTIONS.items() if not action.per_limb]


if TYPE_CHECKING:
    AnyPolicy = Policy  # a name or a path becomes the policy before anybody reads the field
else:
    AnyPolicy = Policy | str | Path


def _default_policy() -> Policy:
    """Return the policy ``velocity`` of the catalog."""
    from suchus.robot.policies import POLICIES  # noqa: PLC0415  the catalog reads policies, which are values of this wing

    return POLICIES["velocity"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Learned:
    """A trained policy that follows a commanded forward speed and turning rate.

    The policy brings its own gait, and plays it by a clock of its own; the gait of the run only says how high the robot
    is put down. A command beyond what the policy was trained for is replaced by the nearest one, with a warning.
    """

    policy: AnyPolicy = field(default_factory=_default_policy)
    """The policy: a value, its name in ``suchus.POLICIES``, or the path of its file."""
    forward: Schedule | None = None
    """Commanded forward speed [m/s]; None for half of the greatest one that was trained."""
    turn: Schedule = 0.0
    """Commanded turning rate, left positive [rad/s]."""
    failures: tuple[tuple[float, str], ...] = ()
    """Failures of servos of which the policy is told: the time [s] and the servo. It helps a policy that was trained
    with the reading ``failure``."""

    def __post_init__(self) -> None:
        from suchus.robot.policies import POLICIES  # noqa: PLC0415  as above

        object.__setattr__(self, "policy", POLICIES.resolve(self.policy))
        with Checks("learned", self) as check:
            if self.forward is not None:
                check.course("forward", -100.0, 100.0, "m/s", start=0.0)
            check.course("turn", -100.0, 100.0, "rad/s", start=0.0)
            early = [time for time, _ in self.failures if not 0.0 <= time <= _MAX_FAILURE_TIME]
            check.that(
                not early,
                f"learned.failures has a failure at {early[0] if early else 0} s; 0 to {_MAX_FAILURE_TIME:g} s is "
                "allowed",
            )

    @property
    def feels(self) -> bool:
        """Whether the policy has a network, which reads sensors."""
        return bool(self.policy.layers)

    @property
    def needs(self) -> tuple[str, ...]:
        """Sensors of the readings of the network."""
        readings = self.policy.readings if self.feels else ()
        return union_of_needs(*(_READING_SENSORS.get(name, (name,)) for name in readings))

    @property
    def speed_course(self) -> Schedule:
        """The commanded forward speed, within what was trained [m/s]."""
        policy = self.policy
        speed = 0.5 * policy.max_speed if self.forward is None else self.forward
        return _clip_course(speed, policy.speeds[0], policy.max_speed)

    @property
    def turn_course(self) -> Schedule:
        """The commanded turning rate, within what was trained [rad/s]."""
        return _clip_course(self.turn, -self.policy.max_turn, self.policy.max_turn)

    def clipped_sentence(self) -> str:
        """Return a sentence that says which command is beyond what was trained; empty if none is."""
        policy, parts = self.policy, []
        for quantity, course, clipped, bounds, unit in (
            ("forward", self.forward, self.speed_course, (policy.speeds[0], policy.max_speed), "m/s"),
            ("turn", self.turn, self.turn_course, (-policy.max_turn, policy.max_turn), "rad/s"),
        ):
            if course is not None and course != clipped:
                worst = max(_values(course), key=lambda value: max(value - bounds[1], bounds[0] - value))
                nearest = min(max(worst, bounds[0]), bounds[1])
                parts.append(
                    f"learned.{quantity} is {worst:g} {unit}; policy {policy.name!r} was trained for {bounds[0]:g} to "
                    f"{bounds[1]:g} {unit}, and gets {nearest:g}"
                )
        return "; ".join(parts) + "." if parts else ""

    def unread_sentence(self) -> str:
        """Return a sentence that says that failures are told which the policy does not read; empty if it does."""
        if not self.failures or "failure" in self.policy.readings:
            return ""
        return (
            f"learned.failures names {self.failures[0][1]}, and policy {self.policy.name!r} reads no failures: it acts "
            "as if it was not told. Take a policy of the task fault."
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "LearnedController":
        """Start the policies of a batch, each run with its own.

        Raises:
            UnsuitedRobot: a policy was trained for another robot.
            UnknownName: a failure of a servo that the robot lacks.

        Warns:
            Doubtful: a command is beyond what a policy was trained for, and gets the nearest one; or a policy is told
                of failures that it does not read.
        """
        sentences: dict[str, None] = {}
        for control, robot in dict.fromkeys(zip(runs.controls, runs.robots, strict=True)):
            control.policy.check_robot(robot)
            for _, servo in control.failures:
                if servo not in layout(robot).servos:
                    raise UnknownName("servo", servo, layout(robot).servos)
            sentences |= {control.clipped_sentence(): None, control.unread_sentence(): None}
        for sentence in filter(None, sentences):
            warnings.warn(Doubtful(sentence, kind="command", size=1.0), stacklevel=2)
        return LearnedController(runs.controls, runs.robots, period)


def _values(course: Schedule) -> tuple[float, ...]:
    """Return the numbers of a course."""
    return tuple(value for _, value in course) if isinstance(course, tuple) else (course,)


def _clip_course(course: Schedule, lower_bound: float, upper_bound: float) -> Schedule:
    """Return a course whose numbers lie within bounds."""
    if isinstance(course, tuple):
        return tuple((time, min(max(value, lower_bound), upper_bound)) for time, value in course)
    return min(max(course, lower_bound), upper_bound)


class LearnedController:
    """The running policies of a batch."""

    def __init__(self, controls: Sequence[Learned], robots: Sequence[Robot], period: float) -> None:
        """Start every clock at the beginning of its gait.

        Args:
            controls: settings, one for each run.
            robots: robot of each run, all of one layout.
            period: control period [s].
        """
        count, self._period = len(controls), period
        self._policies = [control.policy for control in controls]
        self._place = layout(robots[0])
        self._batch = Batch(robots, [policy.gait for policy in self._policies])
        self._sides = np.array([limb.side for limb in self._place.limbs])
        self._reaches = np.array([limb.girdle.limb.reach for limb in self._place.limbs])
        self._speed = TimeCourses([control.speed_course for control in controls])
        self._turn = TimeCourses([control.turn_course for control in controls])
        self._max_command = np.array([(policy.max_speed or 1.0, policy.max_turn or 1.0) for policy in self._policies])
        periods = self._batch.periods
        self._keep_parameters = np.array([decay_factor(min(_SMOOTHING * p, _MAX_SMOOTHING), period) for p in periods])
        self._keep_error = np.array([decay_factor(_ERROR_MEMORY * p, period) for p in periods])[:, None]
        self._failures = [
            (time, run, self._place.servos.index(servo))
            for run, control in enumerate(controls)
            for time, servo in control.failures
        ]
        self._groups = [
            _NetworkGroup([self._policies[i] for i in runs], runs, robots[0], period)
            for key, runs in group_indices([_network_shape(policy) for policy in self._policies])
            if key is not None
        ]
        self._ticks, self._walks = 0, False
        self._cycles = np.zeros(count)  # clock of the gait [cycle]
        self._command: np.ndarray | None = None
        self._base = self._of_table(0.0)
        self._correction = {
            name: np.zeros((count, len(self._sides) if action.per_limb else 1)) for name, action in ACTIONS.items()
        }
        self._last_targets = self._targets()
        self._tracking_error = np.zeros_like(self._last_targets)
        self._heading, self._facing = np.zeros(count), np.full(count, np.nan)
        self._target_heading = np.zeros(count)

    def take_over(self, predecessor: Any) -> None:
        """Continue from another controller of the same runs, whose commands or policies were others."""
        if not isinstance(predecessor, LearnedController):
            return
        self._ticks, self._walks = predecessor._ticks, predecessor._walks
        self._cycles, self._base = predecessor._cycles, predecessor._base
        self._last_targets, self._tracking_error = predecessor._last_targets, predecessor._tracking_error
        self._heading, self._facing = predecessor._heading, predecessor._facing
        self._target_heading = predecessor._target_heading
        if [g.layout_key for g in self._groups] == [g.layout_key for g in predecessor._groups]:
            self._correction = predecessor._correction
            for group, earlier_group in zip(self._groups, predecessor._groups, strict=True):
                group.take_over(earlier_group)

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture in which the gaits begin."""
        return self._targets()

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo angles of the gaits with the parameters of table and network.

        Args:
            tick: number of the control period; from ``START`` on the clocks go.
            sensed: readings; None if no policy has a network.
        """
        walks = tick * self._period >= START - _SLACK
        keep = self._keep_parameters[:, None]
        target = self._of_table(self._ticks * self._period)
        self._base = target + keep * (self._base - target)
        if sensed is not None and self._groups:
            self._observe(sensed, walks=walks)
        self._ticks += 1
        if self._walks:
            self._cycles = self._cycles + self._parameter("rate") * self._period / self._batch.periods
        self._walks = walks
        self._last_targets = self._targets()
        return Command(self._last_targets.copy(), self._phases())

    def _of_table(self, time: float) -> Float[np.ndarray, "run action"]:
        """Return the parameters of the tables for the commands at a time [s]; unchanged commands are not looked up."""
        command = np.stack([self._speed.values_at(time), self._turn.values_at(time)], axis=1)
        if self._command is None or not np.array_equal(command, self._command):
            self._command = command
            self._table_parameters = np.array(
                [interpolate(policy, *row) for policy, row in zip(self._policies, command.tolist(), strict=True)]
            )
        return self._table_parameters

    def _parameter(self, name: str) -> Float[np.ndarray, " run"]:
        """Return a parameter of the whole body, within its bounds."""
        action = ACTIONS[name]
        value = self._base[:, _SHARED_ACTIONS.index(name)]
        if self._groups:
            value = value + self._correction[name][:, 0]
        return np.clip(value, action.lower_bound, action.upper_bound)

    def _phases(self) -> Float[np.ndarray, "run limb"]:
        return self._cycles[:, None] + self._batch.phases

    def _targets(self) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles at the present clocks and parameters [rad]."""
        phases = self._phases()
        stroke = self._parameter("stroke")[:, None] * (1.0 - self._sides * self._parameter("asymmetry")[:, None])
        lowering: np.ndarray | float = 0.0
        if self._groups and len(self._sides):
            stroke = stroke + self._correction["limb_stroke"]
            lowering = self._correction["limb_lowering"] * self._reaches
        axis = self._batch.axis_phase(phases, self._cycles)
        axis = axis * self._parameter("wave") * np.exp(-2j * pi * self._parameter("lag"))
        steer = Steer(stroke=stroke, lowering=lowering, bend=self._parameter("bend"), tail=self._parameter("tail"))
        return self._batch.targets(phases, axis, steer)

    def _observe(self, sensed: Sensed, *, walks: bool) -> None:
        """Update heading and tracking error by the sensors, and let the networks answer where it is time."""
        error = np.abs(self._last_targets - finite(sensed.servo_position))
        self._tracking_error = error + self._keep_error * (self._tracking_error - error)
        bend = finite(sensed.servo_position[:, list(self._place.trunk_yaw)]).sum(axis=1)
        facing = rotation.yaw(finite(sensed.orientation)) + left_side_sign(sensed) * bend / 2
        turned = np.where(np.isnan(self._facing), 0.0, (facing - self._facing + pi) % (2 * pi) - pi)
        self._heading, self._facing = self._heading + turned, facing
        assert self._command is not None
        if not walks:
            self._target_heading = self._heading.copy()
            return
        target_heading = self._target_heading + self._command[:, 1] * self._period
        heading_error = np.clip(target_heading - self._heading, -_MAX_HEADING_ERROR, _MAX_HEADING_ERROR)
        self._target_heading = self._heading + heading_error
        failure = np.zeros_like(self._last_targets)
        for time, run, servo in self._failures:
            failure[run, servo] = float(self._ticks * self._period >= time - _SLACK)
        further = {
            "command": self._command / self._max_command,
            "heading_error": heading_error[:, None],
            "tracking_error": self._tracking_error,
            "failure": failure,
        }
        for group in self._groups:
            group.step(sensed, self._cycles, self._last_targets, further, self._correction)


def _network_shape(policy: Policy) -> Any:
    """Return what the networks of a group share; None for a policy without a network."""
    if not policy.layers:
        return None
    sizes = tuple((len(layer.weights), len(layer.bias)) for layer in policy.layers)
    return sizes, policy.readings, policy.actions, policy.decision, policy.gait.limb_phases


class _NetworkGroup:
    """Runs whose networks have the same shape, and their corrections between two answers."""

    def __init__(self, policies: list[Policy], runs: np.ndarray, robot: Robot, period: float) -> None:
        """Gather the weights, and begin without a correction.

        Args:
            policies: policies of the runs of the group.
            runs: indices of the runs in the batch.
            robot: robot whose layout the runs share.
            period: control period [s].
        """
        self.layout_key = policies[0].readings, policies[0].actions, policies[0].decision, runs.tolist()
        self._runs, self._networks = runs, Networks(policies, robot)
        self._columns = policies[0].action_columns
        self._observer = Observer(robot, len(runs), policies[0].readings)
        self._periods = max(1, round(policies[0].decision / period))
        self._elapsed = 0
        self._begin = self._end = np.zeros((len(runs), len(self._columns)))

    def take_over(self, earlier: "_NetworkGroup") -> None:
        """Continue between the same answers."""
        self._elapsed, self._begin, self._end = earlier._elapsed, earlier._begin, earlier._end

    def step(
        self,
        sensed: Sensed,
        cycles: np.ndarray,
        targets: np.ndarray,
        further: dict[str, np.ndarray],
        correction: dict[str, np.ndarray],
    ) -> None:
        """Write the corrections of one control period; they go in a straight line from one answer to the next.

        Args:
            sensed: readings of all runs.
            cycles: clocks of all runs [cycle].
            targets: last commanded angles of all runs [rad].
            further: readings that are not of sensors, of all runs, by name.
            correction: corrections of all runs by action, written to: shape (run, limb) for an action of limbs,
                (run, 1) for one of the whole body.
        """
        if self._elapsed % self._periods == 0:
            runs = self._runs
            observations = self._observer.observe(
                _sensed_of(sensed, runs),
                cycles[runs],
                targets[runs] / pi,
                further={name: values[runs] for name, values in further.items()},
            )
            self._begin, self._end = self._end, self._networks.answer(observations)
        self._elapsed += 1
        fraction = ((self._elapsed - 1) % self._periods + 1) / self._periods
        current = self._begin + fraction * (self._end - self._begin)
        for column, (name, limb) in enumerate(self._columns):
            correction[name][self._runs, max(limb, 0)] = current[:, column]


def _sensed_of(sensed: Sensed, runs: np.ndarray) -> Sensed:
    """Return the readings of some runs."""
    rows: dict[str, Any] = {
        name: None if getattr(sensed, name) is None else getattr(sensed, name)[runs] for name in SENSED
    }
    return replace(sensed, **rows)


controller = Learned
