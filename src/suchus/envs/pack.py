"""A pack: many robots at one task, each in an episode of its own, simulated as one batch."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus import rotation
from suchus.control import Sensed
from suchus.design import layout, servo_ranges
from suchus.design.scale import control_period
from suchus.envs.beginning import begin, off_by
from suchus.envs.goals import AnyGoal, remaining
from suchus.envs.reward import Terms
from suchus.envs.senses import observations, turning
from suchus.envs.task import Task
from suchus.errors import UnknownName
from suchus.fault import Fault, check_faults
from suchus.land import Run
from suchus.land.batch import SimulationBatch
from suchus.land.injector import Injector
from suchus.land.readings import Readings
from suchus.land.restarting import restart
from suchus.model import compile_model
from suchus.motion import check_limits


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """Random values that were drawn for one episode."""

    phase: float = 0.0
    """Phase of the clock at the beginning [cycle]."""
    broken: Fault | None = None
    """The fault; None: no fault."""
    breaks: int = -1
    """Index of the control period in which the fault begins; -1: never."""
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Force of the push in the world [N]."""
    pushed: int = -1
    """Index of the control period in which the push begins; -1: never."""
    bearing: float = 0.0
    """Bearing of the goal from straight ahead, left positive [rad]."""
    period: float
    """Control period [s]."""

    @property
    def fault(self) -> str:
        """Sentence that says what fails and when; empty without a fault."""
        if self.broken is None:
            return ""
        return f"{self.broken.part} {self.broken.kind()} from {self.breaks * self.period:.2f} s"


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
        self._begin = begin(task)
        self._period, place = control_period(task.robot), layout(task.robot)
        self._low, self._high = servo_ranges(task.robot).T
        self._cranks = turning(task.robot)
        self._turn = task.decision * np.array([task.robot.servo(name).speed for name in place.servos])
        self._runs = [Run(robot=task.body, gait=task.gait, ground=task.ground, lake=task.lake)] * count
        self._batch = SimulationBatch(self._runs, task.timestep)
        self._readings = Readings(self._batch, self._runs, 1)
        self._steps = round(self._period / task.timestep)
        self._check_body()
        self._goals = np.zeros((count, 2))
        self._commanded = np.tile(self._begin.commanded, (count, 1))
        self._turned = np.zeros_like(self._commanded)
        self._injector = Injector(self._batch, self._period, task.robot)
        self._tick = np.zeros(count, dtype=int)
        self._periods = 0
        self.chances = [Chance(period=self._period)] * count
        self.causes = [""] * count

    @property
    def centre(self) -> Float[np.ndarray, " servo"]:
        """Servo angles of an action of zero [rad]."""
        return self._begin.commanded

    @property
    def time(self) -> Float[np.ndarray, " run"]:
        """Time since the beginning of each episode [s]."""
        return self._tick * self._period

    @property
    def phase(self) -> Float[np.ndarray, " run"]:
        """Phase of each robot's clock [cycle]."""
        return np.array([chance.phase for chance in self.chances]) + self.time / self.task.period

    def restart(self, robots: Sequence[int], chances: Sequence[np.random.Generator]) -> None:
        """Begin new episodes.

        Args:
            robots: indices of the robots.
            chances: for each of them the random generator of its episode.
        """
        for i, random in zip(robots, chances, strict=True):
            jitter = self.task.jitter * np.asarray(random.uniform(-1.0, 1.0, self._commanded.shape[1]))
            self._injector.mend(i)
            restart(self._batch, i, off_by(self.task, self._begin, jitter))
            self._commanded[i], self._turned[i], self._tick[i] = self._begin.commanded, 0.0, 0
            self.chances[i], self.causes[i] = draw(self.task, random), ""
            self._set_goal(i)

    def feel(self) -> Float[np.ndarray, "run n"]:
        """Return the observation of each robot, see ``senses``."""
        commanded = np.where(self._cranks, self._turned / self._turn, (self._commanded - self.centre) / self.task.span)
        goal = None if self.task.goal is None else (self._offset(self.task.goal), self.remaining)
        return observations(self.task.robot, self._sensed(), self.phase, commanded, goal)

    def act(self, actions: Float[np.ndarray, "run servo"], who: Bool[np.ndarray, " run"]) -> Terms:
        """Let the chosen robots act for one step; the terms of the others have no meaning.

        A crank has no centre: an action turns it on from its last commanded angle, at most at its no-load speed.

        Args:
            actions: -1 to 1, values beyond are clipped [-].
            who: whether each robot acts [-].
        """
        shares = np.clip(np.asarray(actions, dtype=float), -1.0, 1.0)
        there = np.clip(self.centre + self.task.span * shares, self._low, self._high)
        target = np.where(self._cranks, self._commanded + self._turn * shares, there)
        target = np.where(who[:, None], target, self._commanded)
        before, work, far = self._read("centre_of_mass"), np.zeros(self.count), self.remaining
        self._batch.alive[:] = who
        periods = round(self.task.decision / self._period)
        for k in range(periods):
            self._happen(who)
            targets = self._commanded + (k + 1) / periods * (target - self._commanded)
            self._batch.advance(self._injector.command(self._periods, targets), self._steps, 0.0)
            self._periods += 1
            work += self._power() * self._period
            self._tick[who] += 1
        turned = target - self._commanded
        action_rate = (turned**2).sum(axis=1)
        self._commanded, self._turned = target, np.where(who[:, None], turned, self._turned)
        return self._terms(who, before, far, work, action_rate)

    def record(self, robot: int) -> xr.Dataset:
        """Return one robot as it is now, as a record of one sample."""
        self._batch.alive[:] = True
        self._readings.store(0, self.phase[:, None] + np.array(self.task.gait.limb_phases), self._commanded)
        return self._readings.record(np.zeros(1)).isel(run=robot).copy(deep=True)

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
        return goal.offset(self._read("centre_of_mass")[:, :2], self._goals)

    def _set_goal(self, robot: int) -> None:
        task = self.task
        if task.goal is not None:
            begin = self._read("centre_of_mass")[robot, :2]
            self._goals[robot] = task.goal.place(begin, self.chances[robot].bearing, task.ground, task.lake)

    def _terms(
        self, who: np.ndarray, before: np.ndarray, far: np.ndarray, work: np.ndarray, action_rate: np.ndarray
    ) -> Terms:
        after, diverged = self._read("centre_of_mass"), who & ~self._batch.alive
        moved = np.where(diverged[:, None], 0.0, after - before)
        drift = np.where(diverged, 0.0, np.abs(after[:, 1]) - np.abs(before[:, 1]))
        height, level = self._read("snout_position")[:, 2], rotation.upward(self._read("imu_orientation"))[:, 2]
        low = (height < self.task.least_height) & (self.task.least_height > 0.0)
        fell = low | (level < self.task.least_level)
        left = self.remaining
        there = who & (left <= 0.0) & ~(fell | diverged) & (self.task.goal is not None)
        for i in np.flatnonzero(who & (fell | diverged)):
            self.causes[i] = self._why(int(i), bool(diverged[i]), float(height[i]), float(level[i]))
        for i in np.flatnonzero(there):
            self.causes[i] = f"it reached the goal at {self.time[i]:.2f} s"
        return Terms(
            forward=moved[:, 0],
            lateral_drift=drift,
            upright=np.where(fell | diverged, 0.0, self.task.decision),
            work=np.where(diverged, 0.0, work),
            action_rate=action_rate,
            approach=np.where(diverged, 0.0, far - left),
            goal=there,
            fall=fell | diverged,
        )

    def _why(self, robot: int, diverged: bool, height: float, level: float) -> str:
        when = f"at {self.time[robot]:.2f} s"
        if diverged:
            return f"the simulation diverged {when}: {self._batch.cause[robot]}"
        if 0.0 < self.task.least_height > height:
            return f"it fell {when}: the snout is at {height:.3f} m, below {self.task.least_height:g} m"
        tilt, most = (float(np.degrees(np.arccos(np.clip(c, -1, 1)))) for c in (level, self.task.least_level))
        root = layout(self.task.robot).robot.root
        return f"it rolled over {when}: the {root} is tilted by {tilt:.0f} degrees, beyond {most:.0f}"

    def _happen(self, who: np.ndarray) -> None:
        """Begin the faults and begin and end the pushes that are due."""
        for i in np.flatnonzero(who):
            chance, tick = self.chances[i], self._tick[i]
            if tick == chance.breaks and chance.broken is not None:
                self._injector.begin(int(i), chance.broken)
            if chance.pushed >= 0 and self.task.pushes is not None:
                lasting = round(self.task.pushes.lasting / self._period)
                if tick in (chance.pushed, chance.pushed + lasting):
                    force = np.array(chance.force) * (tick == chance.pushed)
                    self._batch.push(int(i), self.task.pushes.where(self.task.robot), force)

    def _sensed(self) -> Sensed:
        return self._injector.sense(self._readings.sensed(0.0))

    def _power(self) -> Float[np.ndarray, " run"]:
        """Return torque times speed, summed over the servos [W]."""
        read = self._batch.readings
        return np.abs(read[:, self._batch.velocities] * read[:, self._batch.torques]).sum(axis=1)

    def _read(self, sensor: str) -> np.ndarray:
        where = self._batch.model.sensor(sensor)
        first = int(where.adr[0])
        return np.array(self._batch.readings[:, first : first + int(where.dim[0])])

    def _check_body(self) -> None:
        if self.task.pushes is None:
            return
        model = compile_model(self.task.body, self.task.timestep)
        bodies = [model.body(i).name for i in range(1, model.nbody)]
        where = self.task.pushes.where(self.task.robot)
        if where not in bodies:
            raise UnknownName("body", where, bodies)


def draw(task: Task, random: np.random.Generator) -> Chance:
    """Draw the random values of an episode: the phase of the clock, the bearing of the goal, the fault and the push."""
    period = control_period(task.robot)
    chance = {"phase": float(random.uniform()), "period": period}
    if task.goal is not None:
        chance["bearing"] = task.goal.draw(random)
    fault, push = task.breaks, task.pushes
    drawn: dict[str, object] = {}
    if fault is not None:
        broken = fault.draw(random, task.robot)
        drawn["breaks"] = int(np.ceil(random.uniform(fault.earliest, fault.latest) / period))
        drawn["broken"] = broken
    if push is not None:
        drawn["pushed"] = int(np.ceil(random.uniform(push.earliest, push.latest) / period))
        direction, force = random.uniform(-np.pi, np.pi), random.uniform(0.0, push.most)
        drawn["force"] = (float(force * np.cos(direction)), float(force * np.sin(direction)), 0.0)
    return Chance(**chance, **drawn)  # type: ignore[arg-type]
