"""The robot behind an emulated bus: the simulation of ``suchus.sim.land``, commanded servo by servo."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

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
from suchus.sim.land.meter import MEAN_TORQUE
from suchus.sim.land.readings import Recorder
from suchus.sim.land.step_division import divided_step

_BLOCK_SAMPLES = 1000  # samples of a block of the record
_MAX_DURATION = 86400.0  # [s]
_ROOT_DOFS = 6  # of the free joint of the root [-]
_HELD_INERTIA = 1e7  # of a root that is held [kg, kg m2]: it falls by 3 mm in a minute


@dataclass(frozen=True, slots=True)
class Commanded:
    """Control by given servo angles; it begins in the first posture of the run's gait."""

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
        first_runs = runs._replace(controls=tuple(OpenLoop() for _ in runs.robots), ticks=1)
        table = OpenLoop.start(first_runs, 1.0)
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
        gait: gait in whose first posture it begins.
        ground: ground that it stands on; level if None.
        lake: the water around it; dry land if None.
        faults: faults of its servos, each at its time.
        latency: how long a goal is on its way before it acts [s]; it is rounded to physics steps.
        timestep: time step of the physics [s]; that of the robot's size if None.
        held: whether its root is held in the air, level, so that all limbs move freely.

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
        held: bool = False,
    ) -> None:
        """Set up the simulation of the robot at rest in the first posture of its gait."""
        timestep = divided_step(physics_step(robot) if timestep is None else timestep)
        check_step(robot, timestep)
        check_faults(faults, robot, _MAX_DURATION)
        check_limits(robot, gait)
        if lake is not None:
            check_lake(robot, lake)
        run = Run(
            robot=robot, gait=gait, ground=ground or Ground(), lake=lake, faults=tuple(faults), control=Commanded(),
            label="emulated",
        )  # fmt: skip
        self.robot, self.period, self.servos = robot, control_period(robot), layout(robot).servos
        self._loop = Loop([run], timestep, ticks=1)
        if held:
            self._hold_root()
        self._latency_steps = round(latency / timestep)
        self.latency = self._latency_steps * timestep
        """Latency of goals in the end [s]."""
        controller = self._loop.controller
        assert isinstance(controller, HeldCommands)
        self._commands = controller
        self._coming: list[tuple[int, np.ndarray]] = []  # physics step from which goals act, and the goals
        self._goals = controller.rest()[0]
        self.powered = np.ones(len(self.servos))
        """Share of its torque that each servo may use, 0 to 1 [-]."""
        self._blocks: list[Recorder] = []  # full ones; a record is made of them when one is asked for
        self._recorder, self._stored_samples = self._loop.recorder(_BLOCK_SAMPLES), 0
        self._probe = self._loop.recorder(1)
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
        """Return the readings of the robot's sensors, which may have faults.

        The torque of a servo is its mean over the control period, as the current sensor of a servo filters it.
        """
        batch = self._loop.batch
        sensed = self._loop.sensors.sensed(self.time)
        if self.tick > 0:
            sensed = replace(sensed, servo_torque=batch.effort[..., MEAN_TORQUE].copy())
        return self._loop.disturbances.injector.sense(sensed)

    def _hold_root(self) -> None:
        """Lift the robot by its length, and give its root so much inertia that nothing moves it."""
        batch = self._loop.batch
        batch.field("dof_armature", 0)[:_ROOT_DOFS] = _HELD_INERTIA
        batch.commit()
        batch.qpos[0, 2] += self._loop.runs[0].robot.length
        batch.physics.forward()
        batch.read_sensors(slice(None))

    @property
    def now(self) -> Mapping[str, np.ndarray]:
        """Variables of the present instant, by the names of ``record.VARIABLES``, without run and time."""
        self._probe.store(0, self._loop.command.phase, self._loop.command.targets)
        return self._probe.sample(0, 0)

    def aim(self, goals: Mapping[int, float]) -> None:
        """Give the servos goals, which act after the latency.

        Args:
            goals: angles by the place of the servo in the layout [rad].
        """
        new_goals = (self._coming[-1][1] if self._coming else self._goals).copy()
        for place, angle in goals.items():
            new_goals[place] = angle
        due = self.tick * self._loop.steps + self._latency_steps
        if self._coming and self._coming[-1][0] == due:
            self._coming[-1] = (due, new_goals)
        else:
            self._coming.append((due, new_goals))

    def power(self, place: int, share: float) -> None:
        """Set the fraction of its torque that a servo may use, 0 to 1 [-]."""
        if share == self.powered[place]:
            return
        self.powered[place] = share
        name = self.servos[place]
        self._loop.disturbances.override(
            0, name, Limp(name) if share <= 0.0 else None, default=Weak(name, share) if share < 1.0 else None
        )

    def step(self) -> None:
        """Let one control period pass.

        Raises:
            Diverged: the simulation diverged.
        """
        begin = self.tick * self._loop.steps
        self._take(begin)
        self._loop.decide()
        self._keep()
        early_targets = np.array(self._loop.command.targets)
        split = [due for due, _ in self._coming if begin < due < begin + self._loop.steps]
        if split:
            self._take(split[0])
            self._loop.decide()
            self._loop.advance(late_command=(early_targets, split[0] - begin))
        else:
            self._loop.advance()
        if not self._loop.batch.alive[0]:
            time, cause = float(self._loop.batch.end_times[0]), self._loop.batch.cause[0]
            raise Diverged(f"the emulated robot diverged at {time:.2f} s: {cause}.", time=time)

    def record(self) -> xr.Dataset:
        """Return the true motion until now, as ``land.crawl`` does, with the present instant."""
        if self._stored_samples == _BLOCK_SAMPLES:
            self._turn_over()
        self._recorder.store(self._stored_samples, self._loop.command.phase, self._loop.command.targets)
        full = [block.record(self._times(number * _BLOCK_SAMPLES)) for number, block in enumerate(self._blocks)]
        last_block = self._recorder.record(self._times(self.tick - self._stored_samples)).isel(
            time=slice(self._stored_samples + 1)
        )
        end = last_block.ended.copy(data=np.array([float(last_block.time[-1])]))
        parts = [block_record.assign(ended=end, cause=last_block.cause) for block_record in (*full, last_block)]
        full_record = xr.concat(parts, "time", join="exact", data_vars="minimal") if len(parts) > 1 else parts[0]
        full_record.attrs.update(timestep=self.period / self._loop.steps, control_period=self.period)
        return full_record.isel(run=0)

    def _take(self, step: int) -> None:
        """Apply goals whose latency is over."""
        while self._coming and self._coming[0][0] <= step:
            self._goals = self._coming.pop(0)[1]
        self._commands.targets = self._goals[None]

    def _keep(self) -> None:
        if self._stored_samples == _BLOCK_SAMPLES:
            self._turn_over()
        self._recorder.store(self._stored_samples, self._loop.command.phase, self._loop.command.targets)
        self._stored_samples += 1

    def _turn_over(self) -> None:
        self._blocks.append(self._recorder)
        self._recorder, self._stored_samples = self._loop.recorder(_BLOCK_SAMPLES), 0

    def _times(self, first_tick: int) -> np.ndarray:
        times: np.ndarray = np.arange(first_tick, first_tick + _BLOCK_SAMPLES) * self.period
        return times
