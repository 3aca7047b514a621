"""The robot behind an emulated bus: the simulation of ``suchus.sim.land``, commanded servo by servo."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from suchus.core.errors import Diverged
from suchus.robot.control import Command, OpenLoop, Runs, Sensed
from suchus.robot.design import Robot, layout
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import check_step, control_period, physics_step
from suchus.robot.motion import Gait, check_limits
from suchus.sim.fault import Fault, check_faults
from suchus.sim.faults import Limp, Weak
from suchus.sim.land import Lake, Run
from suchus.sim.land.lake import check_lake
from suchus.sim.land.loop import Loop
from suchus.sim.land.readings import Recorder

_ROOM = 1000  # samples of a block of the record
_FOR_EVER = 86400.0  # [s]


@dataclass(frozen=True, slots=True)
class Commanded:
    """Holds the servo angles that it is given, one after another; begins in the first posture of the run's gait."""

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    @staticmethod
    def start(runs: Runs, period: float) -> "HeldCommands":
        """Start it in the posture in which an open loop would begin."""
        del period
        return HeldCommands(runs)


class HeldCommands:
    """The commands of a batch of ``Commanded``."""

    def __init__(self, runs: Runs) -> None:
        first = runs._replace(controls=tuple(OpenLoop() for _ in runs.robots), ticks=1)
        table = OpenLoop.start(first, 1.0)
        self._phase = table.command(0, None).phase
        self.targets = table.rest()

    def rest(self) -> np.ndarray:
        """Return the first posture, shape (run, servo) [rad]."""
        return np.array(self.targets)

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the angles that were given last."""
        del tick, sensed
        return Command(np.array(self.targets), self._phase)


class EmulatedBody:
    """One simulated robot, one control period at a time; its servos can lose their torque, and all of it.

    Args:
        robot: the robot.
        gait: in whose first posture it begins.
        ground: that it stands on; level if None.
        lake: the water around it; dry land if None.
        faults: of its servos, each at its time.
        latency: how long a goal is on its way before it acts [s]; it is rounded to physics steps.
        timestep: of the physics [s]; that of the robot's size if None.

    Raises:
        InvalidDesign: a time step, a lake or a fault that cannot be.
        OutsideLimits: a gait that the robot's joints cannot follow.
    """

    def __init__(
        self,
        robot: Robot,
        gait: Gait,
        *,
        ground: Ground | None = None,
        lake: Lake | None = None,
        faults: Sequence[Fault] = (),
        latency: float = 0.0,
        timestep: float | None = None,
    ) -> None:
        timestep = physics_step(robot) if timestep is None else timestep
        check_step(robot, timestep)
        check_faults(faults, robot, _FOR_EVER)
        check_limits(robot, gait)
        if lake is not None:
            check_lake(robot, lake)
        run = Run(
            robot=robot, gait=gait, ground=ground or Ground(), lake=lake, faults=tuple(faults), control=Commanded(),
            label="emulated",
        )  # fmt: skip
        self.robot, self.period, self.servos = robot, control_period(robot), layout(robot).servos
        self._loop = Loop([run], timestep, ticks=1)
        self._late = round(latency / timestep)
        self.latency = self._late * timestep
        """Latency of goals in the end [s]."""
        held = self._loop.controller
        assert isinstance(held, HeldCommands)
        self._held = held
        self._coming: list[tuple[int, np.ndarray]] = []  # physics step from which goals act, and the goals
        self._goals = held.rest()[0]
        self.powered = np.ones(len(self.servos))
        """Share of its torque that each servo may use, 0 to 1 [-]."""
        self._own = {fault.part: fault for fault in faults}
        self._blocks: list[Recorder] = []  # full ones; a record is made of them when one is asked for
        self._recorder, self._kept = self._loop.recorder(_ROOM), 0
        self._one = self._loop.recorder(1)
        self._loop.decide()

    @property
    def tick(self) -> int:
        """Control periods that have passed [-]."""
        return self._loop.tick

    @property
    def time(self) -> float:
        """Since the beginning [s]."""
        return self._loop.time

    def sensed(self) -> Sensed:
        """Return what the robot feels now, by sensors that may be broken."""
        return self._loop.sensed()

    @property
    def now(self) -> Mapping[str, np.ndarray]:
        """What a record would hold of this instant, by the names of ``record.VARIABLES`` without run and time."""
        self._one.store(0, self._loop.command.phase, self._loop.command.targets)
        return self._one.sample(0, 0)

    def aim(self, goals: Mapping[int, float]) -> None:
        """Send goals on their way.

        Args:
            goals: angles by the place of the servo in the layout [rad].
        """
        after = (self._coming[-1][1] if self._coming else self._goals).copy()
        for place, angle in goals.items():
            after[place] = angle
        due = self.tick * self._loop.steps + self._late
        if self._coming and self._coming[-1][0] == due:
            self._coming[-1] = (due, after)
        else:
            self._coming.append((due, after))

    def power(self, place: int, share: float) -> None:
        """Give a servo a share of its torque from now on, 0 to 1 [-]."""
        if share == self.powered[place]:
            return
        self.powered[place] = share
        name, injector = self.servos[place], self._loop.disturbances.injector
        if share <= 0.0:
            injector.begin(0, Limp(name))
        elif name in self._own and self._own[name].at <= self.time:
            injector.begin(0, self._own[name])
        elif share < 1.0:
            injector.begin(0, Weak(name, share))
        else:
            injector.mend(0, name)

    def step(self) -> None:
        """Let one control period pass.

        Raises:
            Diverged: the simulation diverged.
        """
        begin = self.tick * self._loop.steps
        self._take(begin)
        self._loop.decide()
        self._keep()
        early = np.array(self._loop.command.targets)
        split = [due for due, _ in self._coming if begin < due < begin + self._loop.steps]
        if split:
            self._take(split[0])
            self._loop.decide()
            self._loop.advance(before=(early, split[0] - begin))
        else:
            self._loop.advance()
        if not self._loop.batch.alive[0]:
            time, cause = float(self._loop.batch.ended[0]), self._loop.batch.cause[0]
            raise Diverged(f"the emulated robot diverged at {time:.2f} s: {cause}.", time=time)

    def record(self) -> xr.Dataset:
        """Return what truly happened until now, as ``land.crawl`` does, this instant included."""
        if self._kept == _ROOM:
            self._turn_over()
        self._recorder.store(self._kept, self._loop.command.phase, self._loop.command.targets)
        full = [block.record(self._times(number * _ROOM)) for number, block in enumerate(self._blocks)]
        last = self._recorder.record(self._times(self.tick - self._kept)).isel(time=slice(self._kept + 1))
        end = last.ended.copy(data=np.array([float(last.time[-1])]))
        parts = [part.assign(ended=end, cause=last.cause) for part in (*full, last)]
        whole = xr.concat(parts, "time", join="exact", data_vars="minimal") if len(parts) > 1 else parts[0]
        whole.attrs.update(timestep=self.period / self._loop.steps, control_period=self.period)
        return whole.isel(run=0)

    def _take(self, step: int) -> None:
        """Let goals that have arrived act."""
        while self._coming and self._coming[0][0] <= step:
            self._goals = self._coming.pop(0)[1]
        self._held.targets = self._goals[None]

    def _keep(self) -> None:
        if self._kept == _ROOM:
            self._turn_over()
        self._recorder.store(self._kept, self._loop.command.phase, self._loop.command.targets)
        self._kept += 1

    def _turn_over(self) -> None:
        self._blocks.append(self._recorder)
        self._recorder, self._kept = self._loop.recorder(_ROOM), 0

    def _times(self, first: int) -> np.ndarray:
        times: np.ndarray = np.arange(first, first + _ROOM) * self.period
        return times
