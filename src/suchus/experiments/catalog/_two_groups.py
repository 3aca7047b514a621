"""What the experiments share that compare a crawl with spine and tail with one without."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import compress
from typing import ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CYCLES
from suchus.core.checks import Checks
from suchus.experiments.experiment import Experiment, Measures, Progress, estimated
from suchus.robot.design import Robot
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import GAITS, control_group
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, Tolerances, simulate

STATED_ROBOTS = 6
"""Robots that walk for the verdicts in conditions that decide no word: the fewest whose median has an interval [-]."""
Numbers = Callable[[xr.Dataset], Mapping[str, xr.DataArray]]


@dataclass(frozen=True, slots=True, kw_only=True)
class TwoGroups(Experiment):
    """The article's two groups in each condition as designed, and as several robots built of the design."""

    judged_settings: ClassVar[tuple[str, ...]] = ("robot", "gait", "control_group", "cycles", "tolerances")
    judged_minima: ClassVar[Mapping[str, float]] = {"repeats": 12}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait | None = None
    """The gait of the control group, which has the same legs; None for the gait with its axis still."""
    cycles: int = int(CYCLES)
    """Number of cycles that are measured [-]."""
    repeats: int = 12
    """Robots that are built of the design and walk in each condition: the numbers are the middle of theirs [-]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """By how much they and their grounds differ from it."""
    seed: int = 0
    """Seed of their errors [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("repeats", 1, 1000)
            check.whole("seed", 0, 2**31)
            self.check(check)
        control_group(self.gait, self.control)

    def check(self, check: Checks) -> None:
        """Check what the experiment adds."""

    @property
    def control_group(self) -> Gait:
        """The gait of the control group."""
        return control_group(self.gait, self.control)

    def repeated(
        self,
        runs: Sequence[Run],
        numbers: Numbers,
        units: Mapping[str, str],
        duration: float,
        progress: Progress,
        *,
        effort: bool = True,
        stated: Collection[str] = (),
    ) -> xr.Dataset:
        """Return numbers of every condition and robot, as ``repeated_NAME`` over ``condition`` and ``repeat``.

        Args:
            runs: the conditions, each with its label; the i-th robot of each has the same errors.
            numbers: returns each number by name, over the runs of a record.
            units: units of the numbers, by name.
            duration: duration of each run [s].
            progress: told the share that is done.
            effort: whether ``numbers`` need what the servos do, see ``simulate``.
            stated: conditions in which ``STATED_ROBOTS`` walk at most.

        Returns:
            The numbers, NaN for robots that do not walk in a condition, and where not all walk in each ``robots``, how
            many do.
        """
        few = min(self.repeats, STATED_ROBOTS)
        robots = np.array([few if run.label in stated else self.repeats for run in runs])
        walks = (np.arange(self.repeats) < robots[:, None]).ravel()
        record = simulate(
            list(compress(self.tolerances.repeats(runs, self.repeats, self.seed), walks)),
            duration=duration,
            timestep=coarse_step(self.robot),
            sample_stride=2,
            effort=effort,
            progress=progress,
        )
        data = xr.Dataset(coords={"condition": [run.label for run in runs]})
        for name, values in numbers(record).items():
            every = np.full(walks.size, np.nan)
            every[walks] = values.values
            attrs = {"units": units[name].replace("-", "1")}
            data[f"repeated_{name}"] = ("condition", "repeat"), every.reshape(len(runs), self.repeats), attrs
        if not walks.all():
            data["robots"] = "condition", robots, {"units": "1", "long_name": "robots that walk"}
        return data


def of_robots(record: xr.Dataset, name: str, *conditions: str) -> tuple[xr.DataArray, ...]:
    """Return ``repeated_NAME`` in some conditions, each of the robots that walk in all of them.

    Args:
        record: record of ``TwoGroups.repeated``.
        name: name of the number.
        conditions: names of the conditions.
    """
    values = record[f"repeated_{name}"]
    count = int(record.robots.sel(condition=list(conditions)).min()) if "robots" in record else record.sizes["repeat"]
    return tuple(values.sel(condition=condition, drop=True).isel(repeat=slice(count)) for condition in conditions)


def robots_built(record: xr.Dataset) -> str:
    """Return in words how many robots of the design walked in the conditions of a record."""
    text = f"{record.sizes['repeat']} robots built of the design"
    few = int(record.robots.min()) if "robots" in record else record.sizes["repeat"]
    return text if few == record.sizes["repeat"] else f"{text} ({few} in conditions that decide no word)"


def of_repeats(record: xr.Dataset, units: Mapping[str, str]) -> Measures:
    """Return the middle and the interval of repeated numbers in every condition, as ``NAME_CONDITION``.

    Args:
        record: record with ``repeated_NAME`` over ``condition`` and ``repeat``.
        units: units of the numbers, by name.
    """
    measures = Measures()
    for condition in record.condition.values:
        for name, unit in units.items():
            (values,) = of_robots(record, name, str(condition))
            measures |= estimated(f"{name}_{condition}", values, unit)
    return measures
