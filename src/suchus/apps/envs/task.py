"""A task as a frozen value: robot, ground, water, goal, faults and pushes, and what the reward is made of."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from math import pi
from types import MappingProxyType
from typing import Any, Literal, get_args

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.control.observation import (
    BASIC_READINGS,
    COMMAND_READINGS,
    FAILURE_READINGS,
    GOAL_READINGS,
    observation_layout,
)
from suchus.robot.design import (
    STANDING,
    Robot,
    check_needs,
    front_segment,
    layout,
    with_full_torque,
    with_servos,
    with_speed_lines,
)
from suchus.robot.design.scale import control_period, rescale, rescale_fields
from suchus.robot.gaits import GAITS, default_gait, suits
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault
from suchus.sim.faults import FAULTS
from suchus.sim.land import Ground, Lake, Tolerances
from suchus.sim.land.afloat import check_floats
from suchus.sim.land.lake import check_lake
from suchus.sim.land.waters import FORMS, Form, Slice, Space
from suchus.swimming.water import swim_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A point on the ground or the water, drawn anew for each episode; reached by the centre of mass."""

    distance: float = 1.2
    """Distance of the goal from the centre of mass at the beginning, 0.01 to 1000 [m]."""
    bearing: float = 0.5
    """Greatest bearing of the goal to either side of straight ahead, from which it is drawn evenly, 0 to pi [rad]."""
    within: float = 0.1
    """Horizontal distance at which the goal is reached, 0.001 to 100, less than ``distance`` [m]."""

    def __post_init__(self) -> None:
        with Checks("goal", self) as check:
            check.number("distance", 0.01, 1000.0, "m")
            check.number("bearing", 0.0, pi, "rad")
            check.number("within", 1e-3, 100.0, "m")
            check.that(
                not self.within >= self.distance,
                f"goal.within is {self.within:g} m and goal.distance {self.distance:g} m; within must be less, or the "
                "episode ends where it begins",
            )

    def check(self, ground: Ground, lake: Lake | None) -> None:
        """Accept every ground and lake."""

    def draw(self, random: np.random.Generator) -> float:
        """Return the bearing of the goal of one episode, left positive [rad]."""
        return float(random.uniform(-self.bearing, self.bearing))

    def position(
        self, begin: Float[np.ndarray, "2"], bearing: float, ground: Ground, lake: Lake | None
    ) -> Float[np.ndarray, "2"]:
        """Return where the goal of one episode is, forward and left in the world [m].

        Args:
            begin: the centre of mass at the beginning [m].
            bearing: as drawn [rad].
            ground: not looked at.
            lake: not looked at.
        """
        del ground, lake
        return begin + self.distance * np.array([np.cos(bearing), np.sin(bearing)])

    def offset(
        self, position: Float[np.ndarray, "run 2"], goal: Float[np.ndarray, "run 2"]
    ) -> Float[np.ndarray, "run 2"]:
        """Return the vectors from centres of mass to their goals [m]."""
        return goal - position


@dataclass(frozen=True, slots=True, kw_only=True)
class Landing:
    """Land beyond the water line of a shore that rises ahead; reached by the centre of mass, wherever along it."""

    beyond: float = 1.0
    """Distance beyond the water line, up the slope, 0 to 1000 [m]."""

    def __post_init__(self) -> None:
        with Checks("landing", self) as check:
            check.number("beyond", 0.0, 1000.0, "m")

    @property
    def within(self) -> float:
        """Distance from the goal at which it is reached: none [m]."""
        return 0.0

    def check(self, ground: Ground, lake: Lake | None) -> None:
        """Refuse a world without a shore ahead.

        Raises:
            InvalidDesign: there is no lake, or the ground does not rise ahead.
        """
        if lake is None or not ground.uphill > 0.0:
            raise InvalidDesign(
                f"task.goal is a Landing, task.lake is {'None' if lake is None else 'a lake'} and task.ground.uphill "
                f"{ground.uphill:g} rad; it needs a lake and ground that rises ahead: give both, or another goal."
            )

    def draw(self, random: np.random.Generator) -> float:
        """Return straight ahead, without a draw [rad]."""
        del random
        return 0.0

    def position(
        self, begin: Float[np.ndarray, "2"], bearing: float, ground: Ground, lake: Lake | None
    ) -> Float[np.ndarray, "2"]:
        """Return a point on the line that has to be reached, forward and left in the world [m].

        Args:
            begin: the centre of mass at the beginning [m].
            bearing: not looked at.
            ground: ground whose slope is the shore.
            lake: lake whose level at the beginning makes the water line.
        """
        del bearing
        assert lake is not None  # see ``check``
        return np.array([lake.shore(ground.uphill) + self.beyond, begin[1]])

    def offset(
        self, position: Float[np.ndarray, "run 2"], goal: Float[np.ndarray, "run 2"]
    ) -> Float[np.ndarray, "run 2"]:
        """Return the vectors from centres of mass straight up the shore to the line, zero beyond it [m]."""
        distance = np.maximum(goal[:, 0] - position[:, 0], 0.0)
        return np.stack([distance, np.zeros_like(distance)], axis=1)


AnyGoal = Goal | Landing


def remaining(goal: AnyGoal, offset: Float[np.ndarray, "run 2"]) -> Float[np.ndarray, " run"]:
    """Return the distance that remains until a goal is reached, 0 from then on [m].

    Args:
        goal: the goal.
        offset: offset from the centres of mass to it [m].
    """
    return np.asarray(np.maximum(np.hypot(offset[:, 0], offset[:, 1]) - goal.within, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Rewards:
    """Weights of the terms of the reward; each term is a quantity of one step in SI units, see ``Terms``.

    None of them is from the article. They were chosen so that a whole episode of the built-in motion is worth about
    ten, almost all of it from the one term that the task is about.
    """

    forward: float
    """Weight of the displacement of the centre of mass along the world's x axis, the robot's first heading [1/m]."""
    lateral_drift: float
    """Weight of the increase of the distance of the centre of mass from that axis; negative, a penalty [1/m]."""
    upright: float
    """Weight of the time with the snout above ``Task.least_height`` [1/s]."""
    work: float
    """Weight of the work of all servos, braking counted as much as driving; negative, a penalty [1/J]."""
    action_rate: float
    """Weight of the sum of the squared changes of all commanded angles between two steps; negative, a penalty
    [1/rad2]."""
    fall: float
    """Added once, when the episode ends by a fall or because the simulation diverged; negative, a penalty [-]."""
    approach: float = 0.0
    """Weight of the decrease of the distance that remains to ``Task.goal`` [1/m]."""
    goal: float = 0.0
    """Added once, when the goal is reached [-]."""
    speed_error: float = 0.0
    """Weight of the error of the speed over time; negative, a penalty [1/m]."""
    turn_error: float = 0.0
    """Weight of the error of the turning rate over time; negative, a penalty [-]."""

    def __post_init__(self) -> None:
        with Checks("rewards", self) as check:
            for f in fields(self):
                check.number(f.name, -1e4, 1e4, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """Terms of the reward of one step, for each robot; the weights of the same names are in ``Rewards``."""

    forward: Float[np.ndarray, " run"]
    """Displacement of the centre of mass along the world's x axis [m]."""
    lateral_drift: Float[np.ndarray, " run"]
    """Increase of the distance of the centre of mass from that axis, on either side [m]."""
    upright: Float[np.ndarray, " run"]
    """Time with the snout high enough at the end of the step: the whole step or nothing [s]."""
    work: Float[np.ndarray, " run"]
    """Sum of torque times speed over all servos, braking counted as much as driving [J]."""
    action_rate: Float[np.ndarray, " run"]
    """Sum of the squares of the changes of all commanded angles [rad2]."""
    approach: Float[np.ndarray, " run"]
    """Decrease of the distance that remains to the goal; 0 without a goal [m]."""
    goal: Bool[np.ndarray, " run"]
    """Whether the goal is reached [-]."""
    fall: Bool[np.ndarray, " run"]
    """Whether it fell, or the simulation diverged [-]."""
    speed_error: Float[np.ndarray, " run"]
    """Size of the error of the speed, averaged over half a cycle, times the time of the step; 0 without a command
    [m]."""
    turn_error: Float[np.ndarray, " run"]
    """Size of the error of the turning rate, averaged likewise, times the time of the step; 0 without a command
    [rad]."""

    @property
    def is_over(self) -> Bool[np.ndarray, " run"]:
        """Whether the episode ends here: by a fall, or at the goal [-]."""
        return np.asarray(self.fall | self.goal)

    def reward(self, weights: Rewards) -> Float[np.ndarray, " run"]:
        """Return the weighted sum [-]."""
        total = np.zeros(len(self.fall))
        for name in TERMS:
            total += getattr(weights, name) * getattr(self, name)
        return total


TERMS = tuple(f.name for f in fields(Terms))
"""Names of the terms, in the order in which they are summed."""


Start = Literal["lying", "upright", "swimming"]
START_NEEDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "lying": (),
        "upright": STANDING,
        "swimming": ("axis",),
    }
)
"""Capabilities that each start needs of a robot: names of ``design.NEEDS``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Breaks:
    """One servo of every episode that breaks, drawn anew each time."""

    joints: tuple[str, ...] | None = None
    """Servos among which it is drawn; None: those of the limbs, since the article breaks no others, or all of a robot
    without limbs."""
    kinds: tuple[str, ...] = ("limp", "locked")
    """How it breaks, by names of faults of servos, each as it is in the catalog: ``limp``: without torque; ``locked``:
    holding the angle that it has at that time."""
    faults: tuple[Fault, ...] = ()
    """Faults one of which is drawn instead, with all their numbers but the time; ``joints`` and ``kinds`` then do
    nothing."""
    earliest: float = 0.0
    """Earliest time of the fault [s]."""
    latest: float = 4.0
    """Latest time of the fault [s]; half of the episode then remains without the joint."""

    def __post_init__(self) -> None:
        with Checks("breaks", self) as check:
            check.that(self.joints is None or len(self.joints) > 0, "breaks.joints is empty; name one servo at least")
            check.that(len(self.kinds) > 0, "breaks.kinds is empty; name one fault at least")
            _check_times(check, "breaks", self.earliest, self.latest)
        allowed = tuple(name for name, kind in FAULTS.items() if kind.acts_on == "servo")
        for kind in self.kinds:
            if kind not in allowed:
                raise UnknownName("fault of a servo", str(kind)[:40], allowed)

    def candidate_servos(self, robot: Robot) -> tuple[str, ...]:
        """Return the servos of a robot among which it is drawn.

        Raises:
            UnknownName: the robot has no such servo.
        """
        robot_layout = layout(robot)
        if self.joints is None:
            return (
                tuple(name for limb in robot_layout.limbs for name in robot_layout.servos[limb.servos])
                or robot_layout.servos
            )
        for name in self.joints:
            if name not in robot_layout.servos:
                raise UnknownName("servo", name, robot_layout.servos)
        return self.joints

    def possible(self, robot: Robot) -> tuple[Fault, ...]:
        """Return all faults of a robot that may be drawn, each from 0 s on."""
        if self.faults:
            return self.faults
        return tuple(self._fault(kind, joint) for kind in self.kinds for joint in self.candidate_servos(robot))

    def draw(self, random: np.random.Generator, robot: Robot) -> Fault:
        """Draw the fault of one episode; spells of an intermittent fault come at other times in each episode."""
        if self.faults:
            return _with_drawn_spells(self.faults[int(random.integers(len(self.faults)))], random)
        joints = self.candidate_servos(robot)
        joint = joints[int(random.integers(len(joints)))]
        return self._fault(self.kinds[int(random.integers(len(self.kinds)))], joint)

    @staticmethod
    def _fault(kind: str, joint: str) -> Fault:
        make: Callable[[str], Fault] = FAULTS[kind]
        return make(joint)


def _with_drawn_spells(fault: Fault, random: np.random.Generator) -> Fault:
    """Return a fault whose spells have a drawn seed, if it is intermittent."""
    if fault.persistence.kind != "intermittent":
        return fault
    persistence = replace(fault.persistence, seed=int(random.integers(2**32)))
    return replace(fault, persistence=persistence)  # type: ignore[type-var]  # every fault is a dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandRanges:
    """Forward speeds and turning rates that are commanded, drawn anew from time to time."""

    forward: tuple[float, float] = (0.0, 0.2)
    """Least and greatest commanded forward speed [m/s]."""
    turn: tuple[float, float] = (-0.3, 0.3)
    """Least and greatest commanded turning rate, left positive [rad/s]."""
    interval: float = 5.0
    """Time between two commands, 0.1 to 3600 [s]."""

    def __post_init__(self) -> None:
        with Checks("commands", self) as check:
            check.range("forward", -10.0, 10.0, "m/s")
            check.range("turn", -10.0, 10.0, "rad/s")
            check.number("interval", 0.1, 3600.0, "s")

    def command(self, seed: int, time: float) -> tuple[float, float]:
        """Return the commanded speed [m/s] and turning rate [rad/s] at a time.

        Args:
            seed: seed of the episode.
            time: time since its beginning [s].
        """
        return _drawn_command(self, seed, int(time / self.interval + 1e-9))


@lru_cache(maxsize=4096)
def _drawn_command(ranges: CommandRanges, seed: int, number: int) -> tuple[float, float]:
    """Return a command of an episode: speed [m/s] and turning rate [rad/s].

    Args:
        ranges: the ranges.
        seed: seed of the episode.
        number: number of the command in it.
    """
    random = np.random.default_rng([seed, number])
    return float(random.uniform(*ranges.forward)), float(random.uniform(*ranges.turn))


@dataclass(frozen=True, slots=True, kw_only=True)
class Pushes:
    """One horizontal push in every episode; its force, direction and time are drawn anew each time."""

    most: float = 15.0
    """Greatest force [N]; the force is drawn uniformly from 0 to it. A robot that holds still falls in four of ten
    episodes."""
    earliest: float = 1.0
    """Earliest time at which the push begins [s]."""
    latest: float = 4.0
    """Latest time at which the push begins [s]; a fall takes less than 2 s, so that it still shows."""
    lasting: float = 0.2
    """Duration of the push [s], as in the experiments on standing."""
    body: str | None = None
    """Body that is pushed; None: the segment of the front girdle, or the root of a robot without limbs."""

    def __post_init__(self) -> None:
        with Checks("pushes", self) as check:
            check.number("most", 0.0, 1e3, "N")
            check.number("lasting", 1e-3, 60.0, "s")
            _check_times(check, "pushes", self.earliest, self.latest)

    def pushed_body(self, robot: Robot) -> str:
        """Return the body of a robot that is pushed."""
        if self.body is not None:
            return self.body
        return front_segment(robot)


def _check_times(check: Checks, owner: str, first_time: float, last_time: float) -> None:
    """Refuse an interval of time that is negative or ends before it begins."""
    check.number("earliest", 0.0, 3600.0, "s")
    check.number("latest", 0.0, 3600.0, "s")
    check.that(
        first_time <= last_time,
        f"{owner}.earliest is {first_time} s and {owner}.latest {last_time} s; they must not decrease",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Definition of a reinforcement learning task.

    An action is one number from -1 to 1 for each servo: its commanded angle is ``centre + span * action``, within its
    range. The actions are servo angles rather than changes to a gait, because with changes the built-in gait would be
    the action zero, and nothing would be left to learn; ``span`` keeps even random actions near a posture that carries
    the robot. An action turns a crank further, at most at its servo's no-load speed.
    """

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot; ``speed_lines`` says whether the torque of its servos falls with their speed."""
    speed_lines: bool = True
    """Whether the torque of every servo falls linearly to nothing at its no-load speed, as that of a motor does.

    Without these lines a servo gives its full torque at any speed, and what is learned lives on that: see
    ``docs/environments.md``.
    """
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """Gait whose mid-stance is the centre of the actions of a lying robot, and whose period is the clock's."""
    ground: Ground = field(default_factory=Ground)
    """The ground: its slope, friction and surface."""
    start: Start = "lying"
    """How an episode begins: in the gait's mid-stance, standing as the built-in way up leaves the robot, or floating at
    the surface, straight and with its limbs back along the body."""
    span: float = 0.8
    """How far an action of one turns a servo from its centre [rad]; the built-in crawl asks for 0.78 at its pulley."""
    decision: float = 0.05
    """Time from one action to the next [s]; a tenth of a fast walk's stance, and ten times what a servo's bus takes.

    Meanwhile the commanded angles go in a straight line from the old to the new, one control period after another.
    """
    timestep: float = 0.005
    """Time step of the physics [s]; displacements agree with those at 2 ms within 1 %."""
    jitter: float = 0.05
    """Greatest random offset of each joint at the beginning [rad], so that no two episodes are the same."""
    least_level: float = 0.3
    """Cosine of the pelvis's tilt below which a robot has fallen [-]; -1: it cannot fall. A crawl stays above 0.9."""
    least_height: float = 0.0
    """Height of the snout below which a robot has fallen [m]; 0: it cannot fall."""
    rewards: Rewards = field(
        default_factory=lambda: Rewards(
            forward=10.0, lateral_drift=-5.0, upright=0.0, work=-0.01, action_rate=-0.002, fall=-5.0
        )
    )
    """Weights of the terms of the reward."""
    breaks: Breaks | None = None
    """The fault of each episode; None: no fault."""
    pushes: Pushes | None = None
    """The push of each episode; None: no push."""
    lake: Lake | None = None
    """Water in which the robot swims or wades, its level and air fraction numbers; None on dry land."""
    water: Slice | Space | Form = "sections"
    """How the water of a ``swimming`` start acts: section by section, that of ``lake``; or a flow that is solved
    together with each robot, "slice", "space" or with settings. Such a flow has neither surface nor ground, sees the
    servos that bend the axis sideways alone, and takes some hundred times as long and more."""
    swim: Gait | None = None
    """Gait of a ``swimming`` start, whose wave the clock follows; None: that of (20), see ``water.swim_of``."""
    goal: AnyGoal | None = None
    """The goal, at which the episode ends; None: no goal."""
    commands: CommandRanges | None = None
    """Speeds and turning rates that are commanded; None: no commands."""
    shows_failures: bool = False
    """Whether the observation says which servo has failed."""
    readings: tuple[str, ...] | None = None
    """Readings of the observation, in the order of their columns; None: those of ``observed`` for the task's goal,
    commands and failures."""
    delay: float = 0.0
    """Time by which commanded angles reach the servos late, whole control periods, 0 to 0.2 [s]."""
    noise: float = 0.0
    """Standard deviation of white noise on every column of the observation, 0 to 1 [scale of the reading]."""
    tolerances: Tolerances | None = None
    """Errors of a build, drawn anew for each episode: masses, zeros and play of the servos, friction of the ground.
    None for the robot as designed."""
    slope: float = 0.0
    """Greatest slope along and across the walk, drawn for each episode beside that of ``ground``, 0 to 0.5 [rad]."""
    fast: bool = False
    """Whether contacts are solved in less time and with less accuracy, see ``suchus.simulate``; for training."""

    @property
    def body(self) -> Robot:
        """The robot as its physics has it: with the torque-speed lines if ``speed_lines`` is true."""
        return with_speed_lines(self.robot) if self.speed_lines else with_servos(self.robot, with_full_torque)

    @property
    def observed(self) -> tuple[str, ...]:
        """Readings of the observation, in the order of their columns."""
        if self.readings is not None:
            return self.readings
        return (
            *BASIC_READINGS,
            *(GOAL_READINGS if self.goal is not None else ()),
            *(COMMAND_READINGS if self.commands is not None else ()),
            *(FAILURE_READINGS if self.shows_failures else ()),
        )

    @property
    def flow(self) -> Slice | Space | None:
        """The flow that is solved together with each robot, if any is."""
        return self.water if isinstance(self.water, Slice | Space) else None

    @property
    def period(self) -> float:
        """Period of the clock, that of the swimming motion or of the gait [s]."""
        if self.start == "swimming":
            return self.swimming_gait.period
        return self.gait.period

    @property
    def swimming_gait(self) -> Gait:
        """Gait of a ``swimming`` start: ``swim``, or the wave of (20) on the robot's joints.

        Raises:
            UnsuitedRobot: no servo bends the robot sideways.
            OutsideLimits: its joints cannot make the wave of (20).
        """
        return self.swim or swim_of(self.robot)

    def for_robot(self, robot: Robot, gait: Gait | None = None) -> "Task":
        """Return the same task for another robot.

        Where the robot can follow the gait and keeps the same control period, nothing else changes. If not, the gait
        becomes its own, lengths, forces, weights of rewards and times change with its size, and the time between two
        actions is as many control periods.

        Args:
            robot: any robot.
            gait: another gait; its own if None and it cannot follow that of now.

        Raises:
            UnsuitedRobot: the robot lacks what the beginning needs, or no gait in the catalog suits it.
        """
        check_needs(robot, START_NEEDS[self.start], f"a task that begins {self.start}")
        length_factor, mass_factor = robot.length / self.robot.length, robot.mass / self.robot.mass
        time_factor = control_period(robot) / control_period(self.robot)
        changes: dict[str, Any] = {}
        if time_factor != 1.0:
            changes = {name: round(time_factor * getattr(self, name), 12) for name in ("decision", "timestep", "delay")}
        if time_factor != 1.0 or not suits(robot, self.gait):
            changes |= rescale_fields(self, ["least_height"], length_factor=length_factor, mass_factor=mass_factor)
            changes |= {"gait": gait or default_gait(robot)}
            for name in ("rewards", "breaks", "pushes", "goal", "commands"):
                if getattr(self, name) is not None:
                    changes[name] = rescale(getattr(self, name), length_factor=length_factor, mass_factor=mass_factor)
            if self.lake is not None:
                changes["lake"] = replace(
                    self.lake, level=length_factor * self.lake.state_at(0.0)[0]
                )  # the lake keeps its depth relative to the robot
        return replace(self, robot=robot, **(changes | ({"gait": gait} if gait is not None else {})))

    def __post_init__(self) -> None:
        if isinstance(self.water, str) and self.water != "sections":
            if self.water not in FORMS:
                raise UnknownName("water", self.water, ("sections", *FORMS))
            object.__setattr__(self, "water", FORMS[self.water]())
        if self.start in START_NEEDS:
            check_needs(self.robot, START_NEEDS[self.start], f"a task that begins {self.start}")
        if isinstance(self.goal, Landing):
            check_needs(self.robot, ["limbs"], "a task that ends on land")
        period = control_period(self.robot)
        with Checks("task", self) as check:
            check.that(
                isinstance(self.speed_lines, bool),
                f"task.speed_lines is {self.speed_lines!r}; true or false is allowed",
            )
            check.that(
                self.start in get_args(Start),
                f"task.start is {self.start!r}; {' or '.join(get_args(Start))} is allowed",
            )
            check.that(
                not (self.start == "swimming" and self.lake is None and self.flow is None),
                "task.lake is None; a task that begins swimming needs water: give it a land.Lake",
            )
            is_open_water = self.lake is None and self.ground == Ground() and not isinstance(self.goal, Landing)
            check.that(
                self.flow is None or (self.start == "swimming" and is_open_water),
                "task.water is a flow, which has neither surface nor ground: the task must begin swimming, without "
                'lake, ground or landing; leave them out, or take water="sections"',
            )
            check.number("span", 0.01, 3.2, "rad")
            check.number("decision", period, 100 * period, "s")
            check.number("timestep", 1e-2 * period, period, "s")
            check.number("jitter", 0.0, 0.5, "rad")
            check.number("least_level", -1.0, 1.0, "")
            check.number("least_height", 0.0, 10.0, "m")
            check.number("noise", 0.0, 1.0, "")
            check.number("slope", 0.0, 0.5, "rad")
            check.that(
                self.flow is None or (self.tolerances is None and self.slope == 0.0),
                "task.water is a flow, in which every robot is as designed; leave tolerances and slope out, or take "
                'water="sections"',
            )
            check.that(
                self.goal is None or self.slope == 0.0,
                f"task.slope is {self.slope} rad, and a goal lies on the ground as it is: leave one of them out",
            )
            check.number("delay", 0.0, 20 * period, "s")
            periods = self.delay / period
            check.that(
                abs(periods - round(periods)) < 1e-6,
                f"task.delay is {self.delay} s; whole control periods of {period} s are allowed",
            )
            without_source = [
                name
                for names, has_source in (
                    (GOAL_READINGS, self.goal is not None),
                    (COMMAND_READINGS, self.commands is not None),
                    (FAILURE_READINGS, self.shows_failures),
                )
                if not has_source
                for name in names
                if name in self.observed
            ]
            check.that(
                not without_source,
                f"task.readings has {', '.join(without_source)}, which need a goal, commands or shows_failures in the "
                "task: give it, or leave them out",
            )
            for name, multiple, divisor in (
                ("decision", self.decision, period),
                ("timestep", period, self.timestep),
            ):
                ratio = multiple / divisor if divisor > 0 else 0.0
                check.that(
                    abs(ratio - round(ratio)) < 1e-6,
                    f"task.{name} is {getattr(self, name)} s; it must fit the control period of {period} s "
                    "a whole number of times",
                )
        observation_layout(self.robot, self.observed)
        if self.breaks is not None:
            self.breaks.candidate_servos(self.robot)
        if self.lake is not None:
            check_water(self.robot, self.lake)
            if self.start == "swimming":
                check_floats(self.robot, self.lake)
        if self.flow is not None:
            check_floats(self.robot, Lake(level=self.robot.length))
        if self.goal is not None:
            self.goal.check(self.ground, self.lake)


def check_water(robot: Robot, lake: Lake) -> None:
    """Refuse water that changes while an episode lasts, or that a robot lacks the air for.

    Raises:
        InvalidDesign: level or air fraction are courses, or air is let out that there is not.
    """
    if lake.changes():
        raise InvalidDesign(
            "task.lake has a level or an air fraction that changes with time; in a task both stay, since its episodes "
            "begin at different times: give each as one number."
        )
    check_lake(robot, lake)
