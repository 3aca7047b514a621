"""A run without an end, of which nearly everything can be changed while it goes."""

from dataclasses import replace
from math import inf

import numpy as np

from suchus.core.errors import Diverged, InvalidDesign
from suchus.robot.control import Coordinated, Learned, Swimming
from suchus.robot.control.coordinated import Coordinator
from suchus.robot.control.learned import LearnedController
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import check_step, control_period, physics_step
from suchus.robot.motion import START, Gait, check_limits
from suchus.sim.fault import Fault, check_faults
from suchus.sim.land.lake import Lake, check_lake
from suchus.sim.land.loop import Loop, start
from suchus.sim.land.run import Push, Run, check_pushes
from suchus.sim.land.step_division import divided_step


class Live:
    """One robot that walks until commanded otherwise, one control period at a time.

    The controller hears of one cycle again and again; so the period of a gait is rounded to whole control
    periods. With an unchanged gait of such a period, all goes as in ``simulate``, up to rounding.

    Args:
        run: how it begins; its faults and pushes happen at their times.
        timestep: time step of the physics [s], a whole part of the control period; that of the robot's size if None.

    Raises:
        InvalidDesign: a time step that does not fit, servo noise, a control other than ``Coordinated``, ``Learned`` or
            a ``Swimming`` that holds nothing, or an air fraction below 1 that the robot has no air for.
        OutsideLimits: a gait that the robot's joints cannot follow.
        UnknownName: a fault of a joint, or a push on a body, that does not exist.
    """

    def __init__(self, run: Run, *, timestep: float | None = None) -> None:
        """Check the run, and start its loop and recorder."""
        swims = isinstance(run.control, Swimming) and not run.control.feels
        if run.noise > 0.0 or not (swims or isinstance(run.control, Coordinated | Learned)):
            raise InvalidDesign(
                "a live run takes no noise on its servos, and a control of type Coordinated or Learned, or a Swimming "
                "without heading and depth hold."
            )
        if run.lake is not None:
            check_lake(run.robot, run.lake)
        self._period = control_period(run.robot)
        timestep = divided_step(physics_step(run.robot) if timestep is None else timestep)
        check_step(run.robot, timestep)
        self._start = round(START / self._period)  # [control period]
        check_faults(run.faults, run.robot, inf)
        check_pushes(run.pushes, run.robot, inf)
        self.run = self._with_whole_period(run)
        self._loop = Loop([self.run], timestep, ticks=self._ticks(self.run))
        self._recorder = self._loop.recorder(1)
        self._beat = 0
        self._decide_and_read()

    @property
    def time(self) -> float:
        """Since the beginning [s]."""
        return self._loop.time

    @property
    def current_sample(self) -> dict[str, np.ndarray]:
        """What a record would hold of this instant: the variables of ``record.VARIABLES``, without run and time."""
        return self._current_sample

    @property
    def positions(self) -> np.ndarray:
        """The generalised positions, as ``mujoco.MjData.qpos``."""
        return np.array(self._loop.batch.qpos[0])

    def step(self) -> None:
        """Let one control period pass.

        Raises:
            Diverged: the simulation diverged, now or before.
        """
        self._loop.advance()
        if not self._loop.batch.alive[0]:
            time, cause = float(self._loop.batch.end_times[0]), self._loop.batch.cause[0]
            raise Diverged(f"the walk diverged at {time:.2f} s: {cause}.", time=time)
        self._beat += 1
        if self._beat >= self._start + self._cycle(self.run):
            self._beat -= self._cycle(self.run)
        self._decide_and_read()

    def walk(self, gait: Gait | None = None, control: Coordinated | Learned | Swimming | None = None) -> None:
        """Continue in another gait or with another control, from the same phase of the cycle.

        Raises:
            OutsideLimits: the robot's joints cannot follow the gait, or the rules cannot coordinate it.
            UnsuitedRobot: a policy was trained for another robot.
        """
        cycle_fraction = max(self._beat - self._start, 0) / self._cycle(self.run)
        run = self._with_whole_period(
            replace(self.run, gait=gait or self.run.gait, control=control or self.run.control)
        )
        controller = start([run], self._ticks(run), self._period)
        if isinstance(controller, Coordinator):
            if isinstance(self._loop.controller, Coordinator):
                controller.take_over(self._loop.controller)
            elif self._beat > self._start:
                controller.begin_in_motion()
        elif isinstance(controller, LearnedController):
            controller.take_over(self._loop.controller)
        self.run, self._loop.controller, self._loop.feels = run, controller, run.control.feels
        if self._beat >= self._start:
            self._beat = self._start + round(cycle_fraction * self._cycle(run)) % self._cycle(run)

    def begin(self, fault: Fault) -> None:
        """Begin a fault now, with its recovery or its spells to come; an earlier fault of the same part ends.

        The robot moves as in a run whose fault begins at this time, except that the controller senses the fault one
        control period later.

        Raises:
            UnknownName: no such part.
            InvalidDesign: a number of the fault is outside its range.
            OutsideLimits: a joint held at an angle that it cannot reach.
        """
        check_faults([replace(fault, at=0.0)], self.run.robot, inf)  # type: ignore[type-var]  # all are dataclasses
        self._loop.disturbances.begin(0, fault, int(self._loop.clocks[0]))
        self._loop.disturb()
        self._read_sample()

    def mend(self, part_name: str) -> None:
        """End the fault of a part."""
        self._loop.disturbances.mend(0, part_name)
        self._loop.disturb()
        self._read_sample()

    @property
    def broken(self) -> tuple[Fault, ...]:
        """The faults that are present now, in the order in which they began."""
        return self._loop.disturbances.injector.broken(0)

    def push(self, push: Push) -> None:
        """Add a push, which may begin now.

        Raises:
            UnknownName: the robot has no such body.
        """
        check_pushes([push], self.run.robot, inf)
        self._loop.disturbances.push(0, push)

    def tilt(self, ground: Ground) -> None:
        """Give the ground the slopes of another one; friction and relief stay."""
        self._loop.batch.tilt(0, ground)

    def fill(self, lake: Lake) -> None:
        """Replace the water: its level, its waves, the robot's air fraction.

        Raises:
            InvalidDesign: the run is on dry land, or the robot has no air that it could let out.
        """
        if self.run.lake is None:
            raise InvalidDesign("this run is on dry land; begin one with a lake to change its water.")
        check_lake(self.run.robot, lake)
        self.run = replace(self.run, lake=lake)
        self._loop.batch.waters.fill(0, lake, self.time)

    def _decide_and_read(self) -> None:
        """Let the controller decide the next command, and read all sensors."""
        self._loop.decide(self._beat)
        self._read_sample()

    def _read_sample(self) -> None:
        self._recorder.store(0, self._loop.command.phase, self._loop.command.targets)
        self._current_sample = self._recorder.sample(0, 0)

    def _cycle(self, run: Run) -> int:
        """Return the length of a cycle in control periods."""
        return max(1, round(run.gait.period / self._period))

    def _ticks(self, run: Run) -> int:
        """Return how many control periods a controller must know."""
        return self._start + self._cycle(run) + 1

    def _with_whole_period(self, run: Run) -> Run:
        """Return a run whose gait's period is a whole number of control periods, checked."""
        period = max(1, round(run.gait.period / self._period)) * self._period
        gait, control = replace(run.gait, period=period), run.control
        check_limits(run.robot, gait)
        if isinstance(control, Swimming):
            control = replace(control, ramp=min(control.ramp, START))
        return replace(run, gait=gait, control=control)
