"""What goes wrong in the runs of a batch: faults, which the injector begins and mends, pushes, errors of servos."""

from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from math import floor

import numpy as np

from suchus.robot.control import Sensed
from suchus.robot.design import Robot, layout
from suchus.sim.fault import Fault
from suchus.sim.land.batch import SimulationBatch
from suchus.sim.land.run import Push, Run
from suchus.sim.model import slew_column

_KINDS = {"actuator": "actuator", "geom": "geom", "body": "body", "jnt": "joint"}
"""What the rows of a model's field are, by how its name begins."""


class Injector:
    """What is broken in the runs of a batch: the one entry of faults into batches, live walks and environments.

    Args:
        batch: the simulations.
        period: control period [s].
        robot: one of the batch's robots, which share a layout.
    """

    def __init__(self, batch: SimulationBatch, period: float, robot: Robot) -> None:
        """Note which columns of the sensors belong to which servo, limb and trunk body."""
        self._batch, self._period = batch, period
        robot_layout = layout(robot)
        self._columns = {
            group: {name: i for i, name in enumerate(names)}
            for group, names in (
                ("servo", robot_layout.servos),
                ("foot_pressure", robot_layout.limb_names),
                ("belly_pressure", robot_layout.trunk),
            )
        }
        self._broken: dict[tuple[int, str], tuple[Fault, Site]] = {}

    def begin(self, sim: int, fault: Fault) -> None:
        """Begin a fault of a run now; an earlier fault of the same part ends."""
        self.mend(sim, fault.part)
        site = Site(self._batch, sim, self._columns)
        self._broken[sim, fault.part] = fault, site
        fault.apply(site)
        self._batch.commit()

    def mend(self, sim: int, part_name: str | None = None) -> None:
        """Mend a part of a run, or all of them; nothing happens where nothing is broken."""
        for key in [key for key in self._broken if key[0] == sim and part_name in (None, key[1])]:
            fault, site = self._broken.pop(key)
            fault.mend(site)
        self._batch.commit()

    @property
    def is_broken(self) -> bool:
        """Whether anything is broken in any run."""
        return bool(self._broken)

    def broken(self, sim: int) -> tuple[Fault, ...]:
        """Return the faults that a run has now, in the order in which they began."""
        return tuple(fault for (owner, _), (fault, _) in self._broken.items() if owner == sim)

    def command(self, tick: int, targets: np.ndarray) -> np.ndarray:
        """Return the angles that the servos are commanded in the end, a new array of shape (run, servo) [rad].

        Args:
            tick: number of the control period.
            targets: what they are commanded by the controllers, shape (run, servo) [rad].
        """
        targets = np.array(targets)
        for (sim, _), (fault, site) in self._broken.items():
            site.enter(tick, self._period, targets[sim])
            fault.command(site)
        self._batch.commit()
        return targets

    def sense(self, sensed: Sensed) -> Sensed:
        """Apply the sensor faults to readings and return them; the arrays of ``sensed`` are written."""
        for fault, site in self._broken.values():
            site.sensed = sensed
            fault.sense(site)
        return sensed


class Site:
    """Where one fault acts: the ``fault.Plant`` of one run in a batch, with a list of what it changed there.

    Args:
        batch: the simulations.
        sim: the run.
        columns: columns of servos, feet and bodies of the trunk in arrays, by group.
    """

    def __init__(self, batch: SimulationBatch, sim: int, columns: Mapping[str, Mapping[str, int]]) -> None:
        """Begin without changes: nothing is written to the model yet."""
        self._batch, self._sim, self._groups, self._columns = batch, sim, columns, columns["servo"]
        self._since: int | None = None
        self._original_rows: dict[tuple[str, int], np.ndarray] = {}
        self._unpowered: list[str] = []
        self.time = 0.0
        self.memory: dict[str, float] = {}
        self.targets: MutableMapping[str, float] = {}
        self.sensed: Sensed | None = None

    def enter(self, tick: int, period: float, targets: np.ndarray) -> None:
        """Begin a control period with the angles that the run's servos are commanded, shape (servo,) [rad]."""
        self._since = tick if self._since is None else self._since
        self.time, self.targets = (tick - self._since) * period, NamedRow(self._columns, targets)

    def angle(self, servo: str) -> float:
        """Return the angle of a joint at its servo's shaft [rad]."""
        return float(self._batch.angles(self._sim)[self._columns[servo]])

    def felt(self, group: str, part_name: str | None = None) -> np.ndarray:
        """Return readings for writing, see ``fault.Plant.felt``."""
        readings: np.ndarray = getattr(self.sensed, group)[self._sim : self._sim + 1]
        if part_name is None:
            return readings[0] if readings.ndim > 1 else readings
        column = self._groups.get(group, self._columns)[part_name]
        return readings[0, column : column + 1]

    def parameter(self, field: str, element: str) -> np.ndarray:
        """Return a row of a model field for writing, see ``fault.Plant.parameter``."""
        kind = _KINDS.get(field.partition("_")[0], "dof")
        accessor = getattr(self._batch.model, "joint" if kind == "dof" else kind)(element)
        row = int(accessor.dofadr[0]) if kind == "dof" else int(accessor.id)
        view = self._batch.field(field, self._sim)[row : row + 1]
        view = view[0] if view.ndim > 1 else view
        self._original_rows.setdefault((field, row), view.copy())
        return view

    def speed_limit(self, servo: str) -> np.ndarray:
        """Return the speed limit of a servo for writing [rad/s]."""
        column = slew_column(self._batch.model, servo)
        return self.parameter("actuator_dynprm", servo)[column : column + 1]

    def unpower(self, servo: str) -> None:
        """Take the torque from a servo."""
        self._unpowered.append(servo)
        self._batch.power(self._sim, servo, is_powered=False)

    def restore(self) -> None:
        """Undo what was written."""
        for (field, row), original in self._original_rows.items():
            self._batch.field(field, self._sim)[row : row + 1] = original
        for servo in self._unpowered:
            self._batch.power(self._sim, servo, is_powered=True)
        self._original_rows, self._unpowered = {}, []


class NamedRow(MutableMapping[str, float]):
    """A row of an array, read and written by name; no name can be added or taken away."""

    def __init__(self, columns: Mapping[str, int], row: np.ndarray) -> None:
        self._columns, self._row = columns, row

    def __getitem__(self, name: str) -> float:
        return float(self._row[self._columns[name]])

    def __setitem__(self, name: str, value: float) -> None:
        self._row[self._columns[name]] = value

    def __delitem__(self, name: str) -> None:
        raise TypeError(f"{name} cannot be taken away.")

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


_NO_TICK = np.iinfo(np.int64).max
_TICK_TOLERANCE = 1e-6
"""Rounding tolerance of the time of a push; it is expected rather too early than too late [control period]."""


@dataclass(slots=True)
class _Spells:
    """A fault with the spells in which it is present."""

    fault: Fault
    """The fault."""
    coming: Iterator[tuple[int, int | None]]
    """First control period of each spell to come, and the first one after it."""
    end: int | None = None
    """First control period after the present spell; None where it does not end."""
    is_present: bool = False
    """Whether it is in a spell."""


class Disturbances:
    """The faults, the pushes and the servos' errors of all runs of a batch, each run by a clock of its own.

    Args:
        runs: runs of the batch.
        batch: the simulations.
        ticks: number of control periods for which there is noise.
        period: control period [s].
    """

    def __init__(self, runs: Sequence[Run], batch: SimulationBatch, ticks: int, period: float) -> None:
        """Draw the servo noise of each run, and schedule its faults and pushes."""
        self._batch, self._period = batch, period
        self.injector = Injector(batch, period, runs[0].robot)
        self._changes: list[dict[int, list[_Spells]]] = [{} for _ in runs]
        self._present: list[dict[str, Fault]] = [{} for _ in runs]
        self._overriding: list[dict[str, Fault]] = [{} for _ in runs]
        self._default: list[dict[str, Fault]] = [{} for _ in runs]
        self._pushes: list[list[Push]] = [[] for _ in runs]
        self._next_ticks, self._has_pending = np.full(len(runs), _NO_TICK), False
        servos = len(layout(runs[0].robot).servos)
        self._noise = {
            sim: run.noise * np.random.default_rng(run.seed).standard_normal((ticks, servos))
            for sim, run in enumerate(runs)
            if run.noise > 0
        }
        self._inexact_sims = [sim for sim, run in enumerate(runs) if any(run.zero_error) or any(run.play)]
        zeros = (0.0,) * servos
        self._zero_error = np.array([runs[sim].zero_error or zeros for sim in self._inexact_sims])
        self._half_play = np.array([runs[sim].play or zeros for sim in self._inexact_sims]) / 2
        self._reached_angles = np.full(
            (len(runs), servos), np.nan
        )  # angle that each servo with play reached last [rad]
        for sim, run in enumerate(runs):
            self.schedule(sim, run.faults, run.pushes)

    def set_errors(self, sim: int, zero_error: Sequence[float], play: Sequence[float]) -> None:
        """Replace the errors of a run's servos, and mend what is broken.

        Args:
            sim: the run.
            zero_error: error of the zero of each servo; empty for none [rad].
            play: play of each servo, whole width; empty for none [rad].
        """
        self.injector.mend(sim)
        servos = self._reached_angles.shape[1]
        if sim not in self._inexact_sims:
            self._inexact_sims.append(sim)
            self._zero_error = np.vstack([self._zero_error.reshape(-1, servos), np.zeros(servos)])
            self._half_play = np.vstack([self._half_play.reshape(-1, servos), np.zeros(servos)])
        row = self._inexact_sims.index(sim)
        self._zero_error[row] = np.array(zero_error) if len(zero_error) else 0.0
        self._half_play[row] = np.array(play) / 2 if len(play) else 0.0
        self._reached_angles[sim] = np.nan

    def schedule(self, sim: int, faults: Sequence[Fault], pushes: Sequence[Push]) -> None:
        """Replace the future faults and pushes of a run, whose clock is at 0; faults that act already are repaired.

        Args:
            sim: the run.
            faults: what breaks, each at its time.
            pushes: forces from outside, each at its time.
        """
        self.injector.mend(sim)
        self._reached_angles[sim] = np.nan
        self._changes[sim], self._pushes[sim] = {}, list(pushes)
        self._present[sim], self._overriding[sim], self._default[sim] = {}, {}, {}
        for fault in faults:
            self._plan(sim, _Spells(fault, fault.persistence.spell_ticks(fault.part, fault.at, self._period)))
        self._update_next_tick(sim, -1)

    def begin(self, sim: int, fault: Fault, clock: int) -> None:
        """Begin a fault of a run now, with its recovery or its spells to come; another fault of the same part ends.

        Args:
            sim: the run.
            fault: the fault; its ``at`` does nothing.
            clock: number of the control period of the run since it began.
        """
        self._forget(sim, fault.part)
        onset = clock * self._period
        self._plan(sim, _Spells(fault, fault.persistence.spell_ticks(fault.part, onset, self._period)))
        self._change(sim, clock)
        self._update_next_tick(sim, clock)

    def mend(self, sim: int, part_name: str) -> None:
        """End the fault of a part for good, its spells to come included."""
        self._forget(sim, part_name)
        self._present[sim].pop(part_name, None)
        self._settle(sim, part_name)

    def override(self, sim: int, part_name: str, fault: Fault | None, *, default: Fault | None = None) -> None:
        """Break a part from outside, whatever is scheduled, or leave it to its schedule.

        Args:
            sim: the run.
            part_name: the part.
            fault: fault that it has while any scheduled one waits; None: the scheduled one counts.
            default: fault that it has where neither counts; None: it is intact.
        """
        for faults, value in ((self._overriding[sim], fault), (self._default[sim], default)):
            faults.pop(part_name, None)
            if value is not None:
                faults[part_name] = value
        self._settle(sim, part_name)

    def push(self, sim: int, push: Push) -> None:
        """Add a push to the future ones of a run."""
        self._pushes[sim].append(push)
        self._update_next_tick(sim, -1)

    def is_eventless(self, clocks: np.ndarray, going: np.ndarray, periods: int) -> bool:
        """Return whether nothing is broken, and no fault or push is due in the next control periods.

        Args:
            clocks: number of the control period of each run since it began, shape (run,).
            going: whether each run goes on, shape (run,).
            periods: number of the control periods.
        """
        if self.injector.is_broken:
            return False
        return not (self._has_pending and bool(((self._next_ticks < clocks + periods) & going).any()))

    def happen(self, clocks: np.ndarray, going: np.ndarray) -> None:
        """Let the faults of this control period begin, and push.

        Args:
            clocks: number of the control period of each run since it began, shape (run,).
            going: whether each run goes on in it, shape (run,).
        """
        if self._has_pending:
            for sim in np.flatnonzero((self._next_ticks <= clocks) & going):
                self._apply_events(int(sim), int(clocks[sim]))

    def disturb(self, clocks: np.ndarray, tick: int, targets: np.ndarray) -> np.ndarray:
        """Return the angles that the servos are commanded in the end, a new array of shape (run, servo) [rad].

        Args:
            clocks: number of the control period of each run since it began, shape (run,).
            tick: number of the control period of the batch.
            targets: what the controllers command, shape (run, servo) [rad].
        """
        if self._noise:
            targets = targets.copy()
            for sim, noise in self._noise.items():
                targets[sim] += noise[clocks[sim]]
        if self._inexact_sims:
            targets = targets.copy()
            target_angles, reached_angles = (
                targets[self._inexact_sims] + self._zero_error,
                self._reached_angles[self._inexact_sims],
            )
            reached_angles = np.where(np.isnan(reached_angles), target_angles, reached_angles)
            answer = np.clip(reached_angles, target_angles - self._half_play, target_angles + self._half_play)
            targets[self._inexact_sims] = self._reached_angles[self._inexact_sims] = answer
        return self.injector.command(tick, targets)

    def _apply_events(self, sim: int, tick: int) -> None:
        """Apply the mean pushes of a control period to a run, and begin the faults that are due in it."""
        start, end = tick * self._period, (tick + 1) * self._period
        forces: dict[str, np.ndarray] = {}
        for push in self._pushes[sim]:
            force = push.overlap_fraction(start, end) * np.array(push.force)
            forces[push.body] = forces.get(push.body, np.zeros(3)) + force
        for body, force in forces.items():
            self._batch.push(sim, body, force)
        self._pushes[sim] = [push for push in self._pushes[sim] if push.at + push.duration > start]
        self._change(sim, tick)
        self._update_next_tick(sim, tick)

    def _plan(self, sim: int, spells: _Spells) -> None:
        """Note when the next spell of a fault begins, if there is one."""
        begin, spells.end = next(spells.coming, (None, None))
        if begin is not None:
            self._changes[sim].setdefault(begin, []).append(spells)

    def _change(self, sim: int, tick: int) -> None:
        """Begin and end the spells of a run that begin or end with a control period."""
        for spells in self._changes[sim].pop(tick, ()):
            fault, spells.is_present = spells.fault, not spells.is_present
            if spells.is_present:
                self._present[sim][fault.part] = fault
                if spells.end is not None:
                    self._changes[sim].setdefault(spells.end, []).append(spells)
            else:
                del self._present[sim][fault.part]
                self._plan(sim, spells)
            self._settle(sim, fault.part)

    def _forget(self, sim: int, part_name: str) -> None:
        """Remove what will happen to a part of a run."""
        for tick, changes in list(self._changes[sim].items()):
            remaining = [spells for spells in changes if spells.fault.part != part_name]
            if remaining:
                self._changes[sim][tick] = remaining
            else:
                del self._changes[sim][tick]

    def _settle(self, sim: int, part_name: str) -> None:
        """Break a part of a run anew as it is broken now, or mend it."""
        for faults in (self._overriding[sim], self._present[sim], self._default[sim]):
            if part_name in faults:
                fault = faults[part_name]
                if not any(fault is broken for broken in self.injector.broken(sim)):
                    self.injector.begin(sim, fault)
                return
        self.injector.mend(sim, part_name)

    def _update_next_tick(self, sim: int, tick: int) -> None:
        """Store the next control period after ``tick`` in which a fault or a push of a run may begin."""
        begins = [floor(push.at / self._period - _TICK_TOLERANCE) for push in self._pushes[sim]]
        self._next_ticks[sim] = max(min([*self._changes[sim], *begins], default=_NO_TICK), tick + 1)
        self._has_pending = bool((self._next_ticks < _NO_TICK).any())
