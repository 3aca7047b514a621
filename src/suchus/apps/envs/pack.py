"""A pack: many robots at one task, each in an episode of its own, simulated as one batch.

An episode begins lying in a gait's mid-stance, standing on hind legs and tail, or floating.
"""

from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import lru_cache
from math import ceil
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus.apps.envs.actor import Actor
from suchus.apps.envs.senses import Observer, is_crank
from suchus.apps.envs.tanks import Tanks
from suchus.apps.envs.task import AnyGoal, Task, Terms, remaining
from suchus.apps.envs.tracking import Tracking
from suchus.core import rotation
from suchus.core.errors import Diverged, InvalidDesign
from suchus.robot.control import Standing
from suchus.robot.control.standing import BALANCE
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.design.scale import control_period, rescale
from suchus.robot.gaits import GAITS, default_gait, suits
from suchus.robot.motion import check_limits, check_speeds, cycle_targets, hip_height
from suchus.robot.motion.rising import size_of, stretched_length
from suchus.sim.fault import Fault, check_faults
from suchus.sim.land import Ground, Push, Run
from suchus.sim.land.afloat import surfaced
from suchus.sim.land.batch import Beginning
from suchus.sim.land.lake import up_direction
from suchus.sim.land.loop import Loop
from suchus.sim.land.meter import ABSOLUTE_POWER
from suchus.sim.land.run import check_pushes
from suchus.sim.model import activations, compile_model, standing
from suchus.sim.model.export import home

STANDING_DURATION = 3.0
"""Time that a robot stands before an episode of standing begins [s]; it settles within 2 s."""
_START_DELAY = 0.2  # [s]; when standing up begins, where no crawl is needed
_MIN_STANDING_FRACTION = 0.6
"""Height of the snout of a robot that stands, over that of hind leg, trunk and head in one line [-].

The article's robot has 0.99 when it stands and 0.2 when it lies.
"""
_NOISE_STEPS = 32  # of an episode whose noise is drawn together
_STRAIGHT_GAIT = "limbs_only"  # the trunk is straight in its first posture


def begin(task: Task) -> Beginning:
    """Return how episodes of a task begin, before anything is left to chance.

    Raises:
        OutsideLimits: the robot cannot take the posture.
        Diverged: its simulation diverges as it stands up.
        InvalidDesign: it falls over as it stands up, or touches the ground where it should float.
        OutsideLimits: its joints cannot follow its swimming motion.
    """
    if task.start == "upright":
        return _standing_beginning(task.body, task.ground, task.timestep)
    model = compile_model(task.body, task.timestep)
    if task.start == "swimming":
        return _floating_beginning(task, model)
    qpos, servos = home(model, task.body, task.gait)
    return Beginning(qpos, np.zeros(model.nv), activations(model, servos), servos)


def displace_joints(task: Task, beginning: Beginning, jitter: np.ndarray) -> Beginning:
    """Return a beginning with its joints displaced; the commanded angles stay.

    A lying robot is put on the ground again. One that stands keeps what cables bend, which is
    no joint's alone.

    Args:
        task: the task.
        beginning: state and commanded angles without displacement.
        jitter: displacement of each servo's joint, shape (servo,) [rad].
    """
    model = compile_model(task.body, task.timestep)
    if task.start == "lying":
        return beginning._replace(
            qpos=standing(model, task.robot, hip_height(task.robot, task.gait), beginning.commanded + jitter)
        )
    qpos = beginning.qpos.copy()
    direct = [servo for servo, hinge in enumerate(layout(task.robot).servo_hinges) if hinge >= 0]
    qpos[model.jnt_qposadr[model.actuator_trnid[direct, 0]]] += jitter[direct]
    return beginning._replace(qpos=qpos)


def _floating_beginning(task: Task, model: Any) -> Beginning:
    """Put a robot on the water, or into a flow, in the mean posture of its swimming motion."""
    swim = task.swimming_gait
    check_limits(task.robot, swim)
    check_speeds(task.robot, swim)
    servos = cycle_targets(task.robot, swim, np.zeros(1), np.zeros(1))[0]  # limbs folded back, axis straight
    stands = standing(model, task.robot, hip_height(task.robot, task.gait), servos)
    if task.flow is not None:
        return Beginning(stands, np.zeros(model.nv), activations(model, servos), servos)
    assert task.lake is not None  # see ``Task``
    qpos = surfaced(task.body, task.lake, up_direction(task.ground), stands, task.timestep)
    if np.array_equal(qpos, stands):
        raise InvalidDesign(
            f"robot {task.robot.name!r} touches the ground where its episode begins, at the world's origin with the "
            f"level at {task.lake.state_at(0.0)[0]:g} m; a task that begins swimming needs deeper water: raise "
            "task.lake.level."
        )
    return Beginning(qpos, np.zeros(model.nv), activations(model, servos), servos)


@lru_cache(maxsize=16)
def _standing_beginning(robot: Robot, ground: Ground, timestep: float) -> Beginning:
    """Simulate how a robot stands up, and return the state in which it stands still."""
    straight, period = GAITS[_STRAIGHT_GAIT], control_period(robot)
    gait = straight if suits(robot, straight) else default_gait(robot).without("axis")
    balance = rescale(BALANCE, length_factor=size_of(robot))
    control = Standing(at=_START_DELAY, hold=STANDING_DURATION, balance=balance)
    run = Run(robot=robot, gait=gait, ground=ground, control=control)
    ticks = ceil((control.upright_from(robot) + STANDING_DURATION) / period)
    loop = Loop([run], timestep, ticks=ticks)
    for _ in range(ticks):
        loop.decide()
        loop.advance()
    batch = loop.batch
    if not batch.alive.all():
        raise Diverged(
            f"robot {robot.name!r} does not stand up: {batch.cause[0]}; an upright start needs one that does.",
            time=float(batch.end_times[0]),
        )
    height, min_height = float(loop.sensors["snout_position"][0, 2]), _MIN_STANDING_FRACTION * stretched_length(robot)
    if height < min_height:
        raise InvalidDesign(
            f"robot {robot.name!r} falls over as it stands up: its snout is {height:.3g} m high, and "
            f"{min_height:.3g} m at least are those of one that stands; an upright start needs a robot that stays up."
        )
    qpos, qvel, act = (np.array(state_array[0]) for state_array in (batch.qpos, batch.qvel, batch.activations))
    return Beginning(qpos, qvel, act, np.array(loop.command.targets[0]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """Random values that were drawn for one episode."""

    phase: float = 0.0
    """Phase of the clock at the beginning [cycle]."""
    broken: Fault | None = None
    """The fault, with the time at which it begins; None: no fault."""
    push: Push | None = None
    """The push; None: no push."""
    bearing: float = 0.0
    """Bearing of the goal from straight ahead, left positive [rad]."""
    command_seed: int = 0
    """Seed of the commands."""
    noise_seed: int = 0
    """Seed of the noise on the observations."""
    body_seed: int = 0
    """Seed of the errors of the robot as built."""
    uphill: float = 0.0
    """Slope along the walk beside that of the task's ground [rad]."""
    sideways: float = 0.0
    """Slope across the walk, likewise [rad]."""

    @property
    def fault(self) -> str:
        """Sentence that says what fails and when; empty without a fault."""
        if self.broken is None:
            return ""
        return f"{self.broken.part} {self.broken.kind()} from {self.broken.at:.2f} s"


class EpisodeHistory:
    """How the present episodes of a pack came to be: the random numbers of their beginnings, and all actions since.

    Args:
        count: number of robots.
    """

    def __init__(self, count: int) -> None:
        self.randoms: dict[int, np.random.Generator] = {}
        """Random generator of each robot's episode as it was before the beginning."""
        self._starts = np.zeros(count, dtype=int)
        self._steps: list[tuple[np.ndarray, np.ndarray]] = []
        self._first_step = 0  # number of the first one of the steps that are stored

    def begin(self, robot: int, random: np.random.Generator) -> None:
        """Note the beginning of an episode; actions that no episode needs any more are forgotten."""
        self.randoms[robot] = deepcopy(random)
        self._starts[robot] = self._first_step + len(self._steps)
        needless = int(self._starts.min()) - self._first_step
        if needless > 0:
            del self._steps[:needless]
            self._first_step += needless

    def append(self, actions: np.ndarray, active_mask: np.ndarray) -> None:
        """Note a step.

        Args:
            actions: actions of all robots, shape (run, servo) [-].
            active_mask: which of them act, shape (run,).
        """
        self._steps.append((actions.copy(), active_mask.copy()))

    def episode_actions(self, servos: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield actions and masks of steps that repeat all present episodes, each from its own beginning.

        Args:
            servos: number of servos of a robot.
        """
        rows = [
            [actions[robot] for actions, active in self._steps[start - self._first_step :] if active[robot]]
            for robot, start in enumerate(self._starts.tolist())
        ]
        lengths = np.array([len(row) for row in rows])
        for step in range(int(lengths.max(initial=0))):
            actions = np.array([row[step] if step < len(row) else np.zeros(servos) for row in rows])
            yield actions, step < lengths


class Pack:
    """Robots at one task. The result of one robot does not depend on the number of the others.

    Args:
        task: the task.
        count: number of robots.
    """

    def __init__(self, task: Task, count: int) -> None:
        self.task, self.count = task, count
        check_limits(task.robot, task.gait)
        for fault in task.breaks.possible(task.robot) if task.breaks else ():
            check_faults([fault], task.robot, np.inf)
        if task.pushes is not None:
            body = task.pushes.pushed_body(task.robot)
            check_pushes([Push(force=(0.0, 0.0, 0.0), at=0.0, body=body)], task.body, np.inf)
        self._begin = begin(task)
        self._lower_limits, self._upper_limits = servo_ranges(task.robot).T
        self._cranks = is_crank(task.robot)
        self._max_crank_turn = task.decision * np.array(
            [task.robot.servo(name).speed for name in layout(task.robot).servos]
        )
        periods = round(task.decision / control_period(task.robot))
        delay = round(task.delay / control_period(task.robot))
        self._actor = Actor(np.tile(self._begin.commanded, (count, 1)), periods, len(layout(task.robot).limbs), delay)
        if task.flow is None:
            run = Run(robot=task.body, gait=task.gait, ground=task.ground, lake=task.lake)
        else:
            run = Run(robot=task.body, gait=task.swimming_gait, water=task.flow)
        self._run, self._varies = run, task.tolerances is not None or task.slope > 0.0
        self.loop = loop = Loop([run] * count, task.timestep, ticks=0, controller=self._actor, fast=task.fast)
        self._tanks = None if task.flow is None else Tanks(run, loop.batch, periods, loop.period)
        self._observer = Observer(task.robot, count, task.observed)
        self._tracking = Tracking(task, count)
        self._needs_tracking = task.commands is not None or "tracking_error" in task.observed
        self._has_further = self._needs_tracking or task.shows_failures
        self._goals = np.zeros((count, 2))
        self._commanded = self._actor.target  # a view; the actor writes it
        self._command_change = np.zeros_like(self._commanded)
        self._phases = np.zeros(count)
        self.chances = [Chance()] * count
        self.faults = np.full(count, "", dtype=object)
        """Sentence on the fault of each episode, see ``Chance.fault``."""
        self.causes = np.full(count, "", dtype=object)
        """Why each episode ended; empty until it does."""
        self._history = EpisodeHistory(count)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy is made of: the task, and how each episode came to be as it is."""
        return {"task": self.task, "count": self.count, "history": self._history}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Become a copy: begin each episode with the same random numbers, and repeat its actions to the last bit.

        The simulation itself lies in the memory of MuJoCo, which cannot be copied as it is.
        """
        history: EpisodeHistory = state["history"]
        self.__init__(state["task"], state["count"])  # type: ignore[misc]
        for robot, random in history.randoms.items():
            self.restart([robot], [deepcopy(random)])
        for actions, active_mask in history.episode_actions(len(layout(self.task.robot).servos)):
            self.act(actions, active_mask)

    @property
    def centre(self) -> Float[np.ndarray, " servo"]:
        """Servo angles of an action of zero [rad]."""
        return self._begin.commanded

    @property
    def time(self) -> Float[np.ndarray, " run"]:
        """Time since the beginning of each episode [s]."""
        return self.loop.clocks * self.loop.period

    @property
    def phase(self) -> Float[np.ndarray, " run"]:
        """Phase of each robot's clock [cycle]."""
        return self._phases + self.time / self.task.period

    def restart(self, robots: Sequence[int], chances: Sequence[np.random.Generator]) -> None:
        """Begin new episodes.

        Args:
            robots: indices of the robots.
            chances: random generators of the episodes, one for each of them.
        """
        for i, random in zip(robots, chances, strict=True):
            self._history.begin(i, random)
            jitter = self.task.jitter * np.asarray(random.uniform(-1.0, 1.0, self._commanded.shape[1]))
            chance = draw(self.task, random)
            faults = () if chance.broken is None else (chance.broken,)
            pushes = () if chance.push is None else (chance.push,)
            beginning = displace_joints(self.task, self._begin, jitter)
            if self._varies:
                self.loop.exchange(i, self._drawn_run(chance))
            self.loop.restart(i, beginning, faults, pushes)
            if self._tanks is not None:
                self._tanks.restart(i, beginning, faults, pushes)
            self._actor.restart(i, self._begin.commanded)
            self._command_change[i] = 0.0
            self.chances[i], self.faults[i], self.causes[i] = chance, chance.fault, ""
            self._phases[i] = chance.phase
            self._set_goal(i)
            self._tracking.restart(i, self._facing()[i])

    def _drawn_run(self, chance: Chance) -> Run:
        """Return the run of an episode: a robot with the errors of a build, on a slope."""
        ground, tolerances = self._run.ground, self.task.tolerances
        ground = replace(ground, uphill=ground.uphill + chance.uphill, sideways=ground.sideways + chance.sideways)
        run = replace(self._run, ground=ground)
        return run if tolerances is None else tolerances.draw_run(run, chance.body_seed)

    def feel(self) -> Float[np.ndarray, "run n"]:
        """Return the observation of each robot, see ``senses``."""
        commanded = np.where(
            self._cranks, self._command_change / self._max_crank_turn, (self._commanded - self.centre) / self.task.span
        )
        goal = None if self.task.goal is None else (self._offset(self.task.goal), self.remaining)
        further = self._tracking.readings(self.command, self._failure_mask()) if self._has_further else None
        rows = self._observer.observe(self.loop.sensed(), self.phase, commanded, goal, further)
        return rows if self.task.noise == 0.0 else np.clip(rows + self._noise(rows.shape[1]), -1.0, 1.0)

    @property
    def command(self) -> Float[np.ndarray, "run 2"]:
        """Commanded speed [m/s] and turning rate [rad/s] of each robot now; zeros without commands."""
        if self.task.commands is None:
            return np.zeros((self.count, 2))
        times = self.time.tolist()
        return np.array(
            [
                self.task.commands.command(chance.command_seed, time)
                for chance, time in zip(self.chances, times, strict=True)
            ]
        )

    def _facing(self) -> Float[np.ndarray, " run"]:
        """Return the yaw of each robot's IMU [rad]."""
        return rotation.yaw(self.loop.sensors["imu_orientation"])

    def _failure_mask(self) -> Float[np.ndarray, "run servo"]:
        """Return 1 for each servo whose fault has begun [-]."""
        mask, servos = np.zeros_like(self._commanded), layout(self.task.robot).servos
        for i, chance in enumerate(self.chances):
            if chance.broken is not None and chance.broken.part in servos:
                mask[i, servos.index(chance.broken.part)] = float(self.time[i] >= chance.broken.at - 1e-9)
        return mask

    def _noise(self, columns: int) -> Float[np.ndarray, "run n"]:
        """Return the noise on the observations of this instant; it depends on each robot's seed and time alone."""
        steps = (self.loop.clocks // self._actor.periods).tolist()
        rows = [
            _noise_block(chance.noise_seed, step // _NOISE_STEPS, columns)[step % _NOISE_STEPS]
            for chance, step in zip(self.chances, steps, strict=True)
        ]
        return np.asarray(self.task.noise * np.array(rows), dtype=np.float32)

    def act(self, actions: Float[np.ndarray, "run servo"], active_mask: Bool[np.ndarray, " run"]) -> Terms:
        """Let the chosen robots act for one step; the terms of the others have no meaning.

        A crank has no centre: an action turns it on from its last commanded angle, at most at its no-load speed.

        Args:
            actions: -1 to 1, values beyond are clipped [-].
            active_mask: whether each robot acts [-].
        """
        clipped = np.clip(np.asarray(actions, dtype=float), -1.0, 1.0)
        self._history.append(clipped, active_mask)
        angles = np.clip(self.centre + self.task.span * clipped, self._lower_limits, self._upper_limits)
        target = np.where(self._cranks, self._commanded + self._max_crank_turn * clipped, angles)
        target = np.where(
            active_mask[:, None] & (True if self._tanks is None else self._tanks.is_lateral_servo),
            target,
            self._commanded,
        )
        command_change = target - self._commanded
        last_position, work, last_goal_distance = (
            self.loop.sensors["centre_of_mass"].copy(),
            np.zeros(self.count),
            self.remaining,
        )
        self.loop.choose(active_mask)
        self._actor.aim(target)
        if self._tanks is not None:
            work = self._tanks.act(target, active_mask)
            self.loop.skip(self._actor.periods)
        elif (powers := self.loop.advance_many(self._actor.periods)) is not None:
            for power in powers:
                work += power * self.loop.period
        else:
            for period in range(1, self._actor.periods + 1):
                self.loop.decide()
                self.loop.advance(
                    need_forces=period == self._actor.periods, only_power=True
                )  # contact loads are read at the end of the action only
                work += self.loop.batch.effort[..., ABSOLUTE_POWER].sum(axis=1) * self.loop.period
        self._command_change = np.where(active_mask[:, None], command_change, self._command_change)
        if self._needs_tracking:
            step_displacement = self.loop.sensors["centre_of_mass"] - last_position
            lag = self._commanded - self.loop.sensed().servo_position
            self._tracking.step(active_mask, step_displacement, self._facing(), self.command, lag)
        return self._terms(active_mask, last_position, last_goal_distance, work, (command_change**2).sum(axis=1))

    def record(self, robot: int) -> xr.Dataset:
        """Return one robot as it is now, as a record of one sample."""
        self.loop.choose(np.ones(self.count, dtype=bool))
        recorder = self.loop.recorder(1)
        recorder.store(0, self.phase[:, None] + np.array(self.task.gait.limb_phases), self._commanded)
        return recorder.record(np.zeros(1)).isel(run=robot).copy(deep=True)

    @property
    def goals(self) -> Float[np.ndarray, "run 2"]:
        """Where the goals are, forward and left in the world; zeros without a goal [m]."""
        return self._goals.copy()

    @property
    def remaining(self) -> Float[np.ndarray, " run"]:
        """Distance that remains from each centre of mass to its goal; 0 without a goal [m]."""
        goal = self.task.goal
        return np.zeros(self.count) if goal is None else remaining(goal, self._offset(goal))

    def _offset(self, goal: AnyGoal) -> np.ndarray:
        """Return the vector in the world from each centre of mass to its goal, shape (run, 2) [m]."""
        return goal.offset(self.loop.sensors["centre_of_mass"][:, :2], self._goals)

    def _set_goal(self, robot: int) -> None:
        task = self.task
        if task.goal is not None:
            begin = self.loop.sensors["centre_of_mass"][robot, :2]
            self._goals[robot] = task.goal.position(begin, self.chances[robot].bearing, task.ground, task.lake)

    def _terms(
        self,
        active_mask: np.ndarray,
        last_position: np.ndarray,
        last_goal_distance: np.ndarray,
        work: np.ndarray,
        action_rate: np.ndarray,
    ) -> Terms:
        """Return the terms of the reward of one step, and note why episodes ended.

        Args:
            active_mask: which robots acted, (run,).
            last_position: centres of mass before the step, (run, 3) [m].
            last_goal_distance: distances to the goals before the step, (run,) [m].
            work: work of the servos in the step, (run,) [J].
            action_rate: squared change of the commanded angles, summed over the servos, (run,) [rad2].
        """
        position, diverged = self.loop.sensors["centre_of_mass"], active_mask & ~self.loop.batch.alive
        displacement = np.where(diverged[:, None], 0.0, position - last_position)
        drift = np.where(diverged, 0.0, np.abs(position[:, 1]) - np.abs(last_position[:, 1]))
        height, level = (
            self.loop.sensors["snout_position"][:, 2],
            rotation.upward(self.loop.sensors["imu_orientation"])[:, 2],
        )
        is_low = (height < self.task.least_height) & (self.task.least_height > 0.0)
        has_fallen = is_low | (level < self.task.least_level)
        goal_distance = self.remaining
        has_reached = active_mask & (goal_distance <= 0.0) & ~(has_fallen | diverged) & (self.task.goal is not None)
        tracking_errors = self._tracking.errors(self.command)
        for i in np.flatnonzero(active_mask & (has_fallen | diverged)):
            self.causes[i] = self._end_cause(int(i), bool(diverged[i]), float(height[i]), float(level[i]))
        for i in np.flatnonzero(has_reached):
            self.causes[i] = f"it reached the goal at {self.time[i]:.2f} s"
        return Terms(
            forward=displacement[:, 0],
            lateral_drift=drift,
            upright=np.where(has_fallen | diverged, 0.0, self.task.decision),
            work=np.where(diverged, 0.0, work),
            action_rate=action_rate,
            approach=np.where(diverged, 0.0, last_goal_distance - goal_distance),
            goal=has_reached,
            fall=has_fallen | diverged,
            speed_error=np.where(diverged, 0.0, tracking_errors[:, 0]),
            turn_error=np.where(diverged, 0.0, tracking_errors[:, 1]),
        )

    def _end_cause(self, robot: int, diverged: bool, height: float, level: float) -> str:
        """Return the sentence that says why a robot's episode ended: divergence, a low snout or a tilt.

        Args:
            robot: index of the robot.
            diverged: whether its simulation diverged.
            height: height of its snout [m].
            level: cosine of the tilt of its root [-].
        """
        time_text = f"at {self.time[robot]:.2f} s"
        if diverged:
            return f"the simulation diverged {time_text}: {self.loop.batch.cause[robot]}"
        if 0.0 < self.task.least_height > height:
            return f"it fell {time_text}: the snout is at {height:.3f} m, below {self.task.least_height:g} m"
        tilt, max_tilt = (float(np.degrees(np.arccos(np.clip(c, -1, 1)))) for c in (level, self.task.least_level))
        root = self.task.robot.root
        return f"it rolled over {time_text}: the {root} is tilted by {tilt:.0f} degrees, beyond {max_tilt:.0f}"


@lru_cache(maxsize=1024)
def _noise_block(seed: int, block: int, columns: int) -> Float[np.ndarray, "step n"]:
    """Return the noise of some steps of an episode in a row, of unit variance.

    Args:
        seed: seed of the episode's noise.
        block: number of the row of steps in it.
        columns: columns of an observation.
    """
    return np.random.default_rng([seed, block]).standard_normal((_NOISE_STEPS, columns))


def draw(task: Task, random: np.random.Generator) -> Chance:
    """Draw the random values of an episode: the phase of the clock, the bearing of the goal, the fault and the push.

    Faults and pushes begin and end with control periods.
    """
    period = control_period(task.robot)
    chance = Chance(phase=float(random.uniform()), bearing=0.0 if task.goal is None else task.goal.draw(random))
    if task.breaks is not None:
        broken: Any = task.breaks.draw(random, task.robot)
        begins = np.ceil(random.uniform(task.breaks.earliest, task.breaks.latest) / period)
        chance = replace(chance, broken=replace(broken, at=float(begins * period)))
    if task.pushes is not None:
        begins = np.ceil(random.uniform(task.pushes.earliest, task.pushes.latest) / period)
        ends = begins + max(round(task.pushes.lasting / period), 1)
        direction, force = random.uniform(-np.pi, np.pi), random.uniform(0.0, task.pushes.most)
        push = Push(
            force=(float(force * np.cos(direction)), float(force * np.sin(direction)), 0.0),
            at=float(begins * period),
            duration=float(ends * period - begins * period),
            body=task.pushes.pushed_body(task.robot),
        )
        chance = replace(chance, push=push)
    if task.commands is not None:
        chance = replace(chance, command_seed=int(random.integers(2**31)))
    if task.noise > 0.0:
        chance = replace(chance, noise_seed=int(random.integers(2**31)))
    if task.tolerances is not None:
        chance = replace(chance, body_seed=int(random.integers(2**31)))
    if task.slope > 0.0:
        uphill, sideways = random.uniform(-task.slope, task.slope, 2).tolist()
        chance = replace(chance, uphill=uphill, sideways=sideways)
    return chance
