"""What the experiments share that compare a crawl with spine and tail with one without."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

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
    ) -> xr.Dataset:
        """Return numbers of every condition and robot, as ``repeated_NAME`` over ``condition`` and ``repeat``.

        Args:
            runs: the conditions, each with its label; the i-th robot of each has the same errors.
            numbers: returns each number by name, over the runs of a record.
            units: units of the numbers, by name.
            duration: duration of each run [s].
            progress: told the share that is done.
            effort: whether ``numbers`` need what the servos do, see ``simulate``.
        """
        built = self.tolerances.repeats(runs, self.repeats, self.seed)
        record = simulate(
            built,
            duration=duration,
            timestep=coarse_step(self.robot),
            sample_stride=2,
            effort=effort,
            progress=progress,
        )
        shape = (len(runs), self.repeats)
        data = {
            f"repeated_{name}": (
                ("condition", "repeat"),
                values.values.reshape(shape),
                {"units": units[name].replace("-", "1")},
            )
            for name, values in numbers(record).items()
        }
        return xr.Dataset(data, coords={"condition": [run.label for run in runs]})


def of_repeats(record: xr.Dataset, units: Mapping[str, str]) -> Measures:
    """Return the middle and the interval of repeated numbers in every condition, as ``NAME_CONDITION``.

    Args:
        record: record with ``repeated_NAME`` over ``condition`` and ``repeat``.
        units: units of the numbers, by name.
    """
    measures = Measures()
    for condition in record.condition.values:
        for name, unit in units.items():
            values = record[f"repeated_{name}"].sel(condition=condition)
            measures |= estimated(f"{name}_{condition}", values, unit)
    return measures
