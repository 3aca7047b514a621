"""The loop: what is due happens, the controller decides, the physics goes on; one control period after the other.

A batch of runs, a live walk and the learning environments are its clients.
"""

from collections.abc import Sequence
from functools import partial
from math import floor

import numpy as np
from jaxtyping import Bool, Float, Int

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.robot.control import Amphibious, Command, Control, Controller, Runs, Sensed, Swimming
from suchus.robot.design import servo_ranges
from suchus.robot.design.scale import control_period
from suchus.robot.motion import hip_height
from suchus.sim.fault import Fault
from suchus.sim.land.afloat import check_afloat
from suchus.sim.land.batch import Beginning, SimulationBatch
from suchus.sim.land.injector import Disturbances
from suchus.sim.land.meter import joint_effort
from suchus.sim.land.readings import Recorder, Sensors
from suchus.sim.land.run import Push, Run

CONTROL_PERIOD = 0.01
"""Control period of the article's robot [s]: 100 Hz, what a bus of hobby servos sustains; ``design.scale`` has
those of others."""


def physics_steps(timestep: float, period: float = CONTROL_PERIOD) -> int:
    """Return the number of physics steps in a control period.

    Args:
        timestep: time step of the physics [s].
        period: control period [s].

    Raises:
        InvalidDesign: the time step does not divide the control period.
    """
    require("simulate", "timestep", timestep, 1e-6, period, "s")
    steps = round(period / timestep)
    if abs(steps * timestep - period) > 1e-9:
        raise InvalidDesign(f"simulate.timestep is {timestep} s; it must divide the control period of {period} s.")
    return steps


def start(runs: Sequence[Run], ticks: int, period: float = CONTROL_PERIOD) -> Controller:
    """Start the controller of a group of runs that share one.

    Args:
        runs: runs with equal controls, or with controls that can be joined.
        ticks: number of control periods to come.
        period: control period [s].
    """
    control = runs[0].control
    group = Runs(
        controls=tuple(run.control for run in runs),
        robots=tuple(run.robot for run in runs),
        gaits=tuple(run.gait for run in runs),
        seeds=tuple(run.seed for run in runs),
        ticks=ticks,
    )
    return control.start(group, period)


class Loop:
    """Robots on their grounds, their controller, their faults and pushes, for a group of runs that share a controller.

    In each control period ``decide`` comes first, then ``advance``. Each run has a clock of its own, since single runs
    can begin anew; its faults and pushes happen by it.

    Args:
        runs: runs of the group.
        timestep: time step of the physics [s], a whole part of the control period.
        ticks: number of control periods for which controllers and noise are prepared.
        controller: what decides; None for the one that the runs name.
        fast: whether contacts are solved in less time and with less accuracy, see ``simulate``.

    Raises:
        InvalidDesign: the time step does not divide the control period.
    """

    def __init__(
        self,
        runs: Sequence[Run],
        timestep: float,
        *,
        ticks: int,
        controller: Controller | None = None,
        fast: bool = False,
    ) -> None:
        """Build the batch, start the controller, and place each robot in its first posture."""
        self.runs = runs
        self.period = control_period(runs[0].robot)
        self.steps = physics_steps(timestep, self.period)
        """Physics steps of a control period [-]."""
        self.batch = SimulationBatch(runs, timestep, fast=fast)
        self.sensors = Sensors(self.batch, runs[0].robot)
        self.feels = any(run.control.feels for run in runs)
        self.controller = start(runs, ticks, self.period) if controller is None else controller
        initial_angles = self.controller.rest()
        for run, posture in zip(runs, initial_angles, strict=True):
            if run.lake is not None and _swims(run.control):
                check_afloat(run.robot, run.lake, posture)
        self.batch.place_robots(runs, initial_angles)
        self._deduplication = Deduplication(runs, initial_angles, self.period)
        self.disturbances = Disturbances(runs, self.batch, ticks, self.period)
        self.tick = 0
        """Number of the control period."""
        self.clocks: Int[np.ndarray, " run"] = np.zeros(len(runs), dtype=int)
        """Number of the control period of each run since it began."""
        self._going = np.ones(len(runs), dtype=bool)
        self.has_ended: Bool[np.ndarray, " run"] = np.zeros(len(runs), dtype=bool)
        """Whether each run has ended without failing."""
        self._unbounded = np.isinf(servo_ranges(runs[0].robot)).any(axis=1)
        self._intended_command = Command(initial_angles, np.zeros((len(runs), 0)))

    @property
    def time(self) -> float:
        """Time since the beginning [s]."""
        return self.tick * self.period

    @property
    def intended_targets(self) -> Float[np.ndarray, "run servo"]:
        """Servo angles that the controller commands, before noise and faults [rad]."""
        return self._intended_command.targets

    def recorder(self, samples: int, *, has_effort: bool = True) -> Recorder:
        """Return what keeps samples of this batch, with room for so many; what servos do if ``has_effort``."""
        return Recorder(self.batch, self.sensors, self.runs, samples, has_effort=has_effort)

    def sensed(self) -> Sensed:
        """Return the present sensor readings of the robots, with their sensor faults."""
        return self.disturbances.injector.sense(self.sensors.sensed(self.time))

    def decide(self, beat: int | None = None) -> None:
        """Begin due faults and pushes, call the controller, and disturb its command: ``command`` is the result.

        Args:
            beat: number of the control period that is passed to the controller; ``tick`` if None.
        """
        self.disturbances.happen(self.clocks, self._going)
        sensed = self.sensed() if self.feels else None
        command = self.controller.command(self.tick if beat is None else beat, sensed)
        self._intended_command = command if beat is None else self._continued(command)
        self.disturb()

    def _continued(self, command: Command) -> Command:
        """Return a command whose unbounded servos go on from the last command.

        A beat that begins anew with each cycle would turn a crank back by a whole turn.
        """
        if not self._unbounded.any():
            return command
        previous, targets = self._intended_command.targets, command.targets.copy()
        turns = np.round((previous - targets) / (2 * np.pi))
        targets[:, self._unbounded] += 2 * np.pi * turns[:, self._unbounded]
        return command._replace(targets=targets)

    def disturb(self) -> None:
        """Disturb the last command of the controller again: with noise and with the present faults."""
        targets = self.disturbances.disturb(self.clocks, self.tick, self._intended_command.targets)
        self.command = Command(targets, self._intended_command.phase, self._intended_command.air_fraction)

    def advance(
        self,
        *,
        need_forces: bool = True,
        need_readings: bool = True,
        need_effort: bool = True,
        only_power: bool = False,
        late_command: tuple[np.ndarray, int] | None = None,
    ) -> None:
        """Let one control period pass in which the servos do as they are commanded.

        Args:
            need_forces: whether contact forces will be read after it, see ``SimulationBatch.advance``.
            need_readings: whether any sensor will be.
            need_effort: whether the effort of the servos will be.
            only_power: whether of the effort the size of the power alone will be.
            late_command: servo angles that still act at the beginning, shape (run, servo) [rad], and for how many
                physics steps, fewer than the period has, where a command arrives late; of a loop of one run.
        """
        if late_command is not None:
            self._advance_late(*late_command)
            return
        targets, _, air_fraction = self.command
        advance = partial(
            self.batch.advance,
            need_forces=need_forces,
            need_readings=need_readings,
            need_effort=need_effort,
            only_power=only_power,
        )
        shared = self._deduplication
        shared.separate(self.tick, targets if air_fraction is None else np.column_stack([targets, air_fraction]))
        self.batch.waters.flood(self.time, air_fraction)
        if shared.followers.size:
            advance(targets, self.steps, self.time, shared.is_leader)
            self.batch.copy(shared.followers, shared.leader_of)
        else:
            advance(targets, self.steps, self.time)
        self._count()

    def _advance_late(self, previous_targets: np.ndarray, steps: int) -> None:
        """Let a control period pass whose command acts after some physics steps; forces are means over all of it."""
        targets, _, air_fraction = self.command
        self.batch.waters.flood(self.time, air_fraction)
        self.batch.advance(previous_targets, steps, self.time)
        means, early_fraction = (self.batch.pressed, self.batch.period_means), steps / self.steps
        early_means, early_effort = [early_fraction * mean for mean in means], self.batch.effort.copy()
        self.batch.advance(targets, self.steps - steps, self.time)
        for mean, early_mean in zip(means, early_means, strict=True):
            mean[:] = early_mean + (1.0 - early_fraction) * mean
        self.batch.effort[:] = joint_effort([early_effort, self.batch.effort], [early_fraction, 1.0 - early_fraction])
        self._count()

    def advance_many(self, periods: int) -> Float[np.ndarray, "period run"] | None:
        """Let the controller decide and the physics go on for some control periods, and return the servos' powers [W].

        Results are those of as many ``decide`` and ``advance``, in less time, for a controller that senses nothing.

        Args:
            periods: number of control periods.

        Returns:
            Sums of the sizes of the powers of all servos of each run in each period; None where faults, pushes, water
            or equal runs need each control period for itself, and nothing was done.
        """
        shared, disturbances = self._deduplication, self.disturbances
        is_simple = not (self.feels or self.batch.waters or shared.followers.size or shared.has_groups)
        if not is_simple or not disturbances.is_eventless(self.clocks, self._going, periods):
            return None
        commands, times, clocks = [], [], self.clocks.copy()
        for period in range(periods):
            self._intended_command = self.controller.command(self.tick + period, None)
            commands.append(disturbances.disturb(clocks, self.tick + period, self._intended_command.targets))
            times.append((self.tick + period) * self.period)
            clocks += self._going
        self.command = self._intended_command._replace(targets=commands[-1])
        powers = self.batch.advance_periods(np.array(commands), self.steps, times, self._going)
        self.skip(periods)
        return powers

    def skip(self, periods: int) -> None:
        """Advance the clocks by some control periods, in which other code moves the robots."""
        for _ in range(periods):
            self._count()

    def _count(self) -> None:
        self.tick += 1
        self.clocks += self._going

    def choose(self, going: Bool[np.ndarray, " run"]) -> None:
        """Choose which runs go on from now, whether or not they have diverged; the others wait."""
        self._going[:] = self.batch.alive[:] = going

    def end(self, sims: Int[np.ndarray, " n"]) -> None:
        """Let some runs end now that have shown what they were to show; the others go on.

        Args:
            sims: the runs.
        """
        for sim in sims.tolist():
            self._deduplication.leave(sim)
            self.batch.end(sim, self.time)
        self.has_ended[sims] = True

    def exchange(self, sim: int, run: Run) -> None:
        """Give a run another robot of the same design and another ground; ``restart`` it after this.

        Args:
            sim: the run.
            run: run whose masses, errors of servos, slope and friction it gets.
        """
        self.disturbances.set_errors(sim, run.zero_error, run.play)
        self.batch.exchange(sim, run)

    def restart(self, sim: int, begin: Beginning, faults: Sequence[Fault] = (), pushes: Sequence[Push] = ()) -> None:
        """Let one run begin anew; the others go on.

        Args:
            sim: the run.
            begin: the state in which it begins.
            faults: what breaks, each at its time since this beginning.
            pushes: forces from outside, likewise.
        """
        self._deduplication.leave(sim)
        self.disturbances.schedule(sim, faults, pushes)
        self.batch.restart(sim, begin)
        self.clocks[sim] = 0


def _swims(control: Control) -> bool:
    """Return whether a run begins with a swim."""
    return isinstance(control, Swimming) or (isinstance(control, Amphibious) and control.begins == "swimming")


_TICK_TOLERANCE = 1e-6
"""Rounding tolerance of the time of a fault or push; it is expected rather too early than too late [control period]."""


class Deduplication:
    """Groups of runs that have been identical for the physics so far, so that one run of a group is computed.

    Such are the runs of one robot that is pushed in many ways, up to the push. Members of a group have the same robot,
    ground, supply and first posture, and had the same commanded servo angles to the last bit; a run with another
    command, or is about to break or be pushed, leaves.

    Args:
        runs: the runs.
        initial_angles: the servo angles at the start, shape (run, servo) [rad].
        period: control period [s].
    """

    def __init__(self, runs: Sequence[Run], initial_angles: np.ndarray, period: float) -> None:
        """Group the runs that begin equal, and note in which control period a fault or push separates each."""
        groups: dict[object, list[int]] = {}
        for sim, run in enumerate(runs):
            world = (run.ground, run.afloat, run.lake, run.supply)
            key = (run.robot, *world, hip_height(run.robot, run.gait), initial_angles[sim].tobytes())
            groups.setdefault(key, []).append(sim)
        self._groups = [members for members in groups.values() if len(members) > 1]
        self._leaves: dict[int, set[int]] = {}
        for sim, run in enumerate(runs):
            times = [*(fault.at for fault in run.faults), *(push.at for push in run.pushes)]
            if times:
                self._leaves.setdefault(max(floor(min(times) / period - _TICK_TOLERANCE), 0), set()).add(sim)
        self._count = len(runs)
        self._number()

    def separate(self, tick: int, targets: np.ndarray) -> None:
        """Remove runs from their groups whose first fault or push is due, or whose commands differ.

        Args:
            tick: number of the control period.
            targets: commanded servo angles in it, shape (run, servo) [rad].
        """
        if not self._groups:
            return
        leaving = self._leaves.get(tick, ())
        parted: list[list[int]] = []
        for members in self._groups:
            by_command: dict[object, list[int]] = {}
            for sim in members:
                by_command.setdefault(sim if sim in leaving else targets[sim].tobytes(), []).append(sim)
            parted += by_command.values()
        if len(parted) > len(self._groups):
            self._groups = [members for members in parted if len(members) > 1]
            self._number()

    def leave(self, sim: int) -> None:
        """Let a run go on alone."""
        if self._groups:
            remaining_groups = [[member for member in members if member != sim] for members in self._groups]
            self._groups = [members for members in remaining_groups if len(members) > 1]
            self._number()

    @property
    def has_groups(self) -> bool:
        """Whether some runs have been identical so far."""
        return bool(self._groups)

    def _number(self) -> None:
        """Select the first run of each group as its leader, and note the leader of each other run."""
        self.is_leader = np.ones(self._count, dtype=bool)
        self.followers = np.array([sim for members in self._groups for sim in members[1:]], dtype=int)
        self.leader_of = np.array([members[0] for members in self._groups for _ in members[1:]], dtype=int)
        self.is_leader[self.followers] = False
