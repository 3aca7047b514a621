"""What the experiments share that compare a crawl with spine and tail with one without."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from suchus.design import Robot
from suchus.design.checks import Checks
from suchus.experiment import Experiment
from suchus.gaits import GAITS, control_group
from suchus.land import Ground, Run
from suchus.motion import Gait
from suchus.paper import CYCLES
from suchus.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class TwoGroups(Experiment):
    """The article's two groups and the repeats that tell how much a result depends on servos and friction."""

    judged_with = ("robot", "gait", "control_group", "cycles")
    judged_from: ClassVar[Mapping[str, float]] = {"repeats": 8}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait | None = None
    """The gait of the control group, which has the same legs; None for the gait with its axis still."""
    cycles: int = int(CYCLES)
    """Number of cycles that are measured [-]."""
    repeats: int = 8
    """Runs per condition with noise on the servos and another friction, for the spread [-]."""
    noise: float = 0.01
    """Standard deviation of the noise on every commanded angle in the repeats [rad]; a hobby servo's dead band."""
    friction_spread: float = 0.1
    """Half-width of the uniform spread of the friction in the repeats, as a fraction of it [-]."""
    seed: int = 0
    """Seed of noise and friction [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("repeats", 1, 1000)
            check.number("noise", 0.0, 1.0, "rad")
            check.number("friction_spread", 0.0, 0.9, "")
            check.whole("seed", 0, 2**31)
            self.check(check)
        control_group(self.gait, self.control)

    def check(self, check: Checks) -> None:
        """Check what the experiment adds."""

    @property
    def control_group(self) -> Gait:
        """The gait of the control group."""
        return control_group(self.gait, self.control)

    def repeated(self, runs: Iterable[Run]) -> list[Run]:
        """Return the repeats of all conditions, run by run; the i-th has the same noise and friction in each."""
        rng = np.random.default_rng(self.seed)
        scales = rng.uniform(1 - self.friction_spread, 1 + self.friction_spread, self.repeats)
        return [
            replace(run, ground=Ground(friction_scale=float(scale)), noise=self.noise, seed=self.seed + 1 + i)
            for run in runs
            for i, scale in enumerate(scales)
        ]
