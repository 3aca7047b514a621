"""The injector: it begins, keeps up and mends the faults of the runs of a batch, whoever steps the batch."""

from collections.abc import Iterator, Mapping, MutableMapping

import numpy as np

from suchus.control import Sensed
from suchus.design import AnyRobot, layout
from suchus.fault import Fault
from suchus.land.batch import SimulationBatch
from suchus.model import SLEW

_KINDS = {"actuator": "actuator", "geom": "geom", "body": "body", "jnt": "joint"}
"""What the rows of a model's field are, by how its name begins."""


class Injector:
    """What is broken in the runs of a batch: the one entry of faults into batches, live walks and environments.

    Args:
        batch: the simulations.
        period: of control [s].
        robot: one of the batch's robots, which share a layout.
    """

    def __init__(self, batch: SimulationBatch, period: float, robot: AnyRobot) -> None:
        self._batch, self._period = batch, period
        place = layout(robot)
        self._columns = {
            group: {name: i for i, name in enumerate(names)}
            for group, names in (
                ("servo", place.servos),
                ("foot_pressure", place.limb_names),
                ("belly_pressure", place.trunk),
            )
        }
        self._broken: dict[tuple[int, str], tuple[Fault, Site]] = {}

    def begin(self, sim: int, fault: Fault) -> None:
        """Let a fault of a run begin now, instead of what was wrong with the same part before."""
        self.mend(sim, fault.part)
        site = Site(self._batch, sim, self._columns)
        self._broken[sim, fault.part] = fault, site
        fault.apply(site)
        self._batch.commit()

    def mend(self, sim: int, part: str | None = None) -> None:
        """Mend a part of a run, or all of them; nothing happens where nothing is broken."""
        for key in [key for key in self._broken if key[0] == sim and part in (None, key[1])]:
            fault, site = self._broken.pop(key)
            fault.mend(site)
        self._batch.commit()

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
        """Return what is felt by sensors that may be broken; the arrays of ``sensed`` are written."""
        for fault, site in self._broken.values():
            site.sensed = sensed
            fault.sense(site)
        return sensed


class Site:
    """Where one fault acts: the ``fault.Plant`` of one run in a batch, with a list of what it changed there.

    Args:
        batch: the simulations.
        sim: the run.
        columns: of servos, feet and bodies of the trunk in arrays, by group.
    """

    def __init__(self, batch: SimulationBatch, sim: int, columns: Mapping[str, Mapping[str, int]]) -> None:
        self._batch, self._sim, self._groups, self._columns = batch, sim, columns, columns["servo"]
        self._since: int | None = None
        self._before: dict[tuple[str, int], np.ndarray] = {}
        self._unpowered: list[str] = []
        self.time = 0.0
        self.memory: dict[str, float] = {}
        self.targets: MutableMapping[str, float] = {}
        self.sensed: Sensed | None = None

    def enter(self, tick: int, period: float, targets: np.ndarray) -> None:
        """Begin a control period with the angles that the run's servos are commanded, shape (servo,) [rad]."""
        self._since = tick if self._since is None else self._since
        self.time, self.targets = (tick - self._since) * period, Named(self._columns, targets)

    def angle(self, servo: str) -> float:
        """Return the angle of a joint at its servo's shaft [rad]."""
        return float(self._batch.angles(self._sim)[self._columns[servo]])

    def felt(self, group: str, of: str | None = None) -> np.ndarray:
        """Return readings for writing, see ``fault.Plant.felt``."""
        whole: np.ndarray = getattr(self.sensed, group)[self._sim : self._sim + 1]
        if of is None:
            return whole[0] if whole.ndim > 1 else whole
        column = self._groups.get(group, self._columns)[of]
        return whole[0, column : column + 1]

    def parameter(self, field: str, of: str) -> np.ndarray:
        """Return a row of a model field for writing, see ``fault.Plant.parameter``."""
        kind = _KINDS.get(field.partition("_")[0], "dof")
        part = getattr(self._batch.model, "joint" if kind == "dof" else kind)(of)
        row = int(part.dofadr[0]) if kind == "dof" else int(part.id)
        view = self._batch.field(field, self._sim)[row : row + 1]
        view = view[0] if view.ndim > 1 else view
        self._before.setdefault((field, row), view.copy())
        return view

    def speed_limit(self, servo: str) -> np.ndarray:
        """Return the speed limit of a servo for writing [rad/s]."""
        return self.parameter("actuator_dynprm", servo)[SLEW : SLEW + 1]

    def unpower(self, servo: str) -> None:
        """Take the torque from a servo."""
        self._unpowered.append(servo)
        self._batch.power(self._sim, servo, on=False)

    def restore(self) -> None:
        """Undo what was written."""
        for (field, row), before in self._before.items():
            self._batch.field(field, self._sim)[row : row + 1] = before
        for servo in self._unpowered:
            self._batch.power(self._sim, servo, on=True)
        self._before, self._unpowered = {}, []


class Named(MutableMapping[str, float]):
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
