"""What is trained: task, robot, gait and seed, and the bounds within which parameters are searched."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, UnsuitedRobot
from suchus.robot.control.policy import ACTIONS, AXIS_ACTIONS, Policy, mirror_shift, robot_digest
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait, check_limits, max_stroke_factor, min_gait_period, trunk_amplitude
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import FAULTS
from suchus.sim.land import Ground, Lake
from suchus.sim.land.afloat import check_floats
from suchus.swimming.water import swim_of


class TaskKind(NamedTuple):
    """A task that can be trained."""

    description: str
    """What the robot learns, in a clause."""
    is_swim: bool = False
    """Whether the robot swims."""
    has_faults: bool = False
    """Whether a servo of a limb fails in each episode."""
    reports_failures: bool = False
    """Whether the policy is told which servo failed."""


TASKS: Mapping[str, TaskKind] = MappingProxyType(
    {
        "velocity": TaskKind("to walk at a commanded speed and turning rate"),
        "fault": TaskKind("the same, while a servo that it is told of fails", has_faults=True, reports_failures=True),
        "velocity_untold": TaskKind("the same, while a servo fails of which it is not told", has_faults=True),
        "swim": TaskKind("to swim at a commanded speed and turning rate", is_swim=True),
    }
)
"""Tasks by name."""

READINGS = ("command", "clock", "upward", "angular_velocity", "heading_error")
"""Readings of every network that is trained: command and clock, and what an IMU measures."""
FAULT_READINGS = ("tracking_error",)
"""Readings that a task with faults adds: what the servos on the bus report."""
FAILURE_READINGS = ("failure",)
"""Readings that a task adds in which the robot is told of its faults."""
FAULT_KINDS = ("limp", "locked")
"""Names of the faults of a servo that are drawn unless others are named."""
SEGMENTS = 2
"""Commands of an episode of the network, one after the other [-]."""
SEGMENT_PERIODS = 3.0
"""Duration of each of them, over the period of the gait [-]."""
_PERIODS_PER_DECISION = 5
_SPANS = {
    "rate": 0.5, "stroke": 0.5, "asymmetry": 0.8, "bend": 0.4, "tail": 0.4, "wave": 0.4, "lag": 0.1, "limb_stroke": 0.5,
    "limb_lowering": 0.06,
}  # fmt: skip
"""Greatest correction of each parameter by a network."""
_MAX_RATE, _MIN_RATE = 3.0, 0.4


@dataclass(frozen=True, slots=True, kw_only=True)
class Training:
    """A training, without how long it takes."""

    task: str = "velocity"
    """Name of the task, one of ``TASKS``."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot."""
    gait: Gait | None = None
    """Gait whose parameters are trained; None for the robot's own, or its own swim."""
    speed: float | None = None
    """Greatest commanded speed; None for what the robot reaches in the search [m/s]."""
    turn: float | None = None
    """Greatest commanded turning rate; None for what the robot reaches in the search [rad/s]."""
    axis: bool = True
    """Whether spine and tail take part; if not, the axis is held straight and no parameter moves it."""
    hidden: int = 0
    """Units of the hidden layer of the network; 0 for a network without one [-]."""
    seed: int = 0
    """Seed of everything that is random [-]."""
    start: Policy | None = None
    """Policy whose gait and table are taken, so that a network alone is trained; None for a table of its own."""
    faults: tuple[str, ...] = FAULT_KINDS
    """Faults of a servo one of which is drawn for each episode of a task with faults, by their names."""
    joints: tuple[str, ...] = ()
    """Servos one of which fails; empty for those of the limbs."""
    onset: tuple[float, float] | None = None
    """Earliest and latest time of the fault after the first step [s]; None for the first half of an episode."""

    def __post_init__(self) -> None:
        if self.task not in TASKS:
            raise UnknownName("task", str(self.task)[:40], TASKS)
        with Checks("training", self) as check:
            check.whole("hidden", 0, 256)
            check.whole("seed", 0, 2**31)
            for name, unit in (("speed", "m/s"), ("turn", "rad/s")):
                if getattr(self, name) is not None:
                    check.number(name, 1e-4, 100.0, unit)
        if self.start is not None:
            self._check_start(self.start)
        self._check_faults()
        place = layout(self.robot)
        if self.kind.is_swim:
            check_floats(self.robot, self.lake or Lake(level=self.robot.length))
        elif not place.limbs:
            raise UnsuitedRobot(
                f"the task {self.task} is walked on limbs, and robot {self.robot.name!r} has none: train swim."
            )
        check_limits(self.robot, self.base_gait)
        if not self.base_gait.has("steering"):
            raise OutsideLimits(
                f"gait {self.base_gait.name!r} has measured curves, whose parameters cannot be trained: give a gait of "
                "foot paths and bends."
            )

    def _check_faults(self) -> None:
        """Refuse faults that cannot be drawn, and settings of faults in a task without them.

        Raises:
            UnknownName: no such fault of a servo, or no such servo.
            InvalidDesign: the task has no faults, none is named, or the onset is beyond the episode.
        """
        changed = [
            name
            for name, default in (("faults", FAULT_KINDS), ("joints", ()), ("onset", None))
            if getattr(self, name) != default
        ]
        if changed and not self.kind.has_faults:
            with_faults = ", ".join(name for name, kind in TASKS.items() if kind.has_faults)
            raise InvalidDesign(
                f"training.{changed[0]} is given, and nothing fails in the task {self.task}: leave it out, or take one "
                f"of the tasks {with_faults}."
            )
        allowed = tuple(name for name, kind in FAULTS.items() if kind.acts_on == "servo")
        for name in self.faults:
            if name not in allowed:
                raise UnknownName("fault of a servo", str(name)[:40], allowed)
        for name in self.joints:
            if name not in layout(self.robot).servos:
                raise UnknownName("servo", str(name)[:40], layout(self.robot).servos)
        with Checks("training", self) as check:
            check.that(len(self.faults) > 0, "training.faults is empty; name one fault of a servo at least")
            if self.onset is not None:
                check.range("onset", 0.0, self.episode_duration, "s")

    def _check_start(self, start: Policy) -> None:
        """Refuse a policy whose table the training cannot take.

        Raises:
            UnsuitedRobot: it was trained for another robot.
            InvalidDesign: its task is not as much in water as this one, or a setting contradicts it.
        """
        start.check_robot(self.robot)
        is_swim = start.task in TASKS and TASKS[start.task].is_swim
        if is_swim != self.kind.is_swim:
            raise InvalidDesign(
                f"training.start was trained for the task {start.task}, and this one is {self.task}; give a policy "
                "that swims for a swim, and one that walks for a walk."
            )
        given = [name for name in ("gait", "speed", "turn") if getattr(self, name) is not None]
        if given or not self.axis:
            raise InvalidDesign(
                f"training.start brings gait and commands of its own, and {', '.join(given) or 'a still axis'} is "
                "given too; leave one of them out."
            )

    @property
    def name(self) -> str:
        """Name of the policy: the task, whether the axis is still, and the robot unless it is the caiman."""
        robot_parts = [] if self.robot.name == "caiman" else [self.robot.name]
        return "_".join([self.task, *([] if self.axis else ["still_axis"]), *robot_parts])

    @property
    def kind(self) -> TaskKind:
        """The task."""
        return TASKS[self.task]

    @property
    def base_gait(self) -> Gait:
        """The gait whose parameters are trained."""
        if self.start is not None:
            return self.start.gait
        gait = self.gait or (swim_of(self.robot) if self.kind.is_swim else default_gait(self.robot))
        return gait if self.axis else gait.without("axis")

    @property
    def episode_duration(self) -> float:
        """Duration of an episode of the network after the first step [s]."""
        return SEGMENTS * SEGMENT_PERIODS * self.base_gait.period

    @property
    def onset_range(self) -> tuple[float, float]:
        """Earliest and latest time of the fault after the first step [s]."""
        return self.onset or (0.0, 0.5 * self.episode_duration)

    @property
    def failing_servos(self) -> tuple[str, ...]:
        """Servos one of which fails in an episode."""
        place = layout(self.robot)
        return self.joints or tuple(servo for limb in place.limbs for servo in place.servos[limb.servos])

    @property
    def ground(self) -> Ground:
        """The ground: level, with the robot's own friction."""
        return Ground()

    @property
    def lake(self) -> Lake | None:
        """The water, one body length deep; None on dry land."""
        return Lake(level=self.robot.length) if self.kind.is_swim else None

    @property
    def bounds(self) -> dict[str, tuple[float, float]]:
        """Least and greatest value of each parameter that is searched for the table, for turns to the left.

        The rate is bounded by the speed of the servos, strokes by the reach of the limbs, and bends by the ranges of
        their servos.
        """
        robot, gait, place = self.robot, self.base_gait, layout(self.robot)
        max_rate = min(_MAX_RATE, gait.period / max(min_gait_period(robot, gait)[0], 1e-9))
        bounds = {"rate": (_MIN_RATE, max(max_rate, 2 * _MIN_RATE))}
        if gait.has("strokes"):
            bounds["stroke"] = (0.3, max(1.0, min(1.8, max_stroke_factor(robot, gait))))
            bounds["asymmetry"] = (-0.3, 1.3)
        if not self.axis:
            return bounds
        if place.trunk_yaw:
            ranges = np.abs(servo_ranges(robot)[list(place.trunk_yaw)]).min(axis=1, initial=inf)
            max_bend = min(0.8, max(float(ranges.sum()) - trunk_amplitude(robot, gait), 0.05))
            bounds["bend"] = (-max_bend, max_bend)
        if place.tail_yaw or place.cables:
            bounds["tail"] = (-0.6, 0.6)
        if gait.has("wave"):
            bounds |= {"wave": (0.2, 1.2), "lag": (-0.2, 0.2)}
        return bounds

    @property
    def actions(self) -> tuple[str, ...]:
        """Parameters that the network corrects."""
        whole_body = tuple(name for name in self.bounds if self.axis or name not in AXIS_ACTIONS)
        has_paths = self.base_gait.has("foot paths")
        limb_actions = ("limb_stroke", *(("limb_lowering",) if has_paths else ())) if self.base_gait.limbs else ()
        return whole_body + (limb_actions if not self.kind.is_swim else ())

    @property
    def readings(self) -> tuple[str, ...]:
        """Readings of the network."""
        kind = self.kind
        fault_readings = FAULT_READINGS if kind.has_faults else ()
        return READINGS + fault_readings + (FAILURE_READINGS if kind.reports_failures else ())

    @property
    def is_symmetric(self) -> bool:
        """Whether the mirror image of the gait is the gait at another time, so that symmetry can be used."""
        try:
            return not self.base_gait.limb_phases or mirror_shift(self.base_gait) >= 0.0
        except InvalidDesign:
            return False

    def policy(
        self,
        speeds: tuple[float, ...],
        turns: tuple[float, ...],
        parameters: tuple[str, ...],
        table: tuple[tuple[tuple[float, ...], ...], ...],
    ) -> Policy:
        """Return a policy of a table without a network.

        Args:
            speeds: commanded speeds of the table [m/s].
            turns: commanded turning rates of the table [rad/s].
            parameters: names of the parameters.
            table: their values, a row for each speed, in it one for each turning rate.
        """
        robot, place = self.robot, layout(self.robot)
        return Policy(
            name=self.name,
            task=self.task,
            robot=robot.name,
            robot_digest=robot_digest(robot),
            length=robot.length,
            mass=robot.mass,
            servos=place.servos,
            limbs=place.limb_names,
            gait=self.base_gait,
            speeds=speeds,
            turns=turns,
            parameters=parameters,
            table=table,
            decision=round(_PERIODS_PER_DECISION * control_period(robot), 12),
            is_symmetric=self.is_symmetric,
        )

    @property
    def taken_table(self) -> Policy:
        """The table of ``start``, without its network, under the name of this training."""
        assert self.start is not None
        start = self.start
        return self.policy(start.speeds, start.turns, start.parameters, start.table)

    @property
    def spans(self) -> tuple[float, ...]:
        """Greatest correction of each output of the network."""
        limbs = len(layout(self.robot).limbs)
        return tuple(_SPANS[name] for name in self.actions for _ in range(limbs if ACTIONS[name].per_limb else 1))
