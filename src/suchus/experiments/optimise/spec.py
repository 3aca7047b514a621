"""What is searched: fields of robot and gait, what is aimed at, what is allowed; and all of it as a TOML file."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from math import log
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

from suchus.core.checks import Checks, InvalidFields
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.experiments.optimise.aims import AIMS, LIMITS
from suchus.experiments.study import Arm, Vary
from suchus.robot import blueprint
from suchus.robot.control import Control, OpenLoop, Standing, Walking
from suchus.robot.design import value_at, with_values
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import gait_of
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run

BEST_ARM = Arm(name="best")
"""The only condition of a search without a comparison."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Aim:
    """A quantity that the search optimises."""

    name: str
    """Name of the quantity, a key of ``AIMS``."""
    weight: float = 1.0
    """Beside the other aims of a sum, each counted in parts of what the start has [-]."""

    def __post_init__(self) -> None:
        if self.name not in AIMS:
            raise UnknownName("aim", self.name, AIMS)
        with Checks(f"aim {self.name}", self) as check:
            check.number("weight", 1e-6, 1e6, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """What must not be exceeded, or undercut, whichever way the quantity goes wrong."""

    name: str
    """Name of the quantity, a key of ``LIMITS``."""
    value: float
    """Value of the limit, in the unit of the quantity."""

    def __post_init__(self) -> None:
        if self.name not in LIMITS:
            raise UnknownName("limit", self.name, LIMITS)
        with Checks(f"limit {self.name}", self) as check:
            check.number("value", -1e6, 1e6, LIMITS[self.name].unit)


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """What a search is besides where it starts; a file says the same."""

    name: str
    """Name, as messages, tables and files show it."""
    vary: tuple[Vary, ...]
    """Fields that may change, each with ``low`` and ``high``."""
    aims: tuple[Aim, ...]
    """Quantities that the search optimises; two or more give a front."""
    limits: tuple[Limit, ...] = ()
    """Limits of other quantities; joint limits, reach and servo speeds always hold."""
    arms: tuple[Arm, ...] = (BEST_ARM,)
    """Searched one after the other with the same budget; what a condition sets does not vary in it."""
    pareto: bool = False
    """Whether two aims are weighed against each other as a front, rather than summed."""
    evaluations: int = 1200
    """Number of candidates that each condition may try [-]; the generation in which they run out is finished."""
    population: int = 16
    """Candidates of a generation, simulated in one batch; of each point of the front, where there is one [-]."""
    points: int = 6
    """Points of the front that are pushed forward together [-]."""
    sigma: float = 0.25
    """First standard deviation of the candidates, as a part of each range [-]."""
    friction_scales: tuple[float, ...] = (1.0,)
    """Factors on the ground's friction: a candidate is run on each; aims are means, limits hold on the worst [-]."""
    seed: int = 0
    """Seed of the search."""
    duration: float = 9.0
    """Duration of each run [s]: two cycles of four seconds after the first second, in which the robot settles."""
    timestep: float = 0.005
    """Time step of the physics in the search [s]; the best are run again with 2 ms."""
    reasons: tuple[str, ...] = ()
    """Why these fields, ranges and limits, for whoever reads the results."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Optimisation(Search):
    """A search for the best among the runs that differ from one in some fields."""

    run: Run
    """Run from which the search starts."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and fields and conditions that the run cannot take."""
        with Checks("optimisation", self) as check:
            check.whole("evaluations", 1, 10_000_000)
            check.whole("population", 4, 10_000)
            check.whole("points", 2, 100)
            check.number("sigma", 0.001, 1.0, "")
            check.whole("seed", 0, 2**32 - 1)
            check.number("duration", 1.1, 86400.0, "s")
            check.number("timestep", 1e-5, control_period(self.run.robot), "s")
            check.that(len(self.vary) > 0, "optimisation.vary is empty; name at least one field")
            check.that(len(self.aims) > 0, "optimisation.aims is empty; name at least one aim")
            check.that(len(self.arms) > 0, "optimisation.arms is empty; leave it out for a single search")
            check.that(len(self.friction_scales) > 0, "optimisation.friction_scales is empty; leave it out for 1.0")
            for scale in self.friction_scales:
                check.that(0.01 <= scale <= 10.0, f"optimisation.friction_scales has {scale:g}; 0.01 to 10 is allowed")
            names = [arm.name for arm in self.arms]
            check.that(len(set(names)) == len(names), f"optimisation.arms are called {', '.join(names)}; each once")
            two = len({aim.name for aim in self.aims}) == len(self.aims)
            check.that(two, "optimisation.aims has one aim twice")
            check.that(
                not self.pareto or len(self.aims) == 2,
                f"optimisation.aims has {len(self.aims)} aims; a front needs two: weigh more than two as a sum",
            )
        for vary in self.vary:
            self._check_vary(vary)
        for arm in self.arms:
            self.for_arm(arm)

    def _check_vary(self, vary: Vary) -> None:
        """Refuse a field that does not exist, is no number, or whose range the robot or the start is not in."""
        if [v.field for v in self.vary].count(vary.field) > 1:
            raise InvalidDesign(f"optimisation {self.name!r} varies {vary.field} twice; once is allowed.")
        start_value = value_at(self.run, vary.field)
        if vary.low is None or vary.high is None or vary.mean is not None or vary.steps is not None:
            raise InvalidDesign(f"optimisation {self.name!r} needs low and high for {vary.field}, and nothing else.")
        if isinstance(start_value, bool) or not isinstance(start_value, (int, float)):
            raise InvalidDesign(f"optimisation {self.name!r} varies {vary.field}, which is no number.")
        if isinstance(start_value, int):
            raise InvalidDesign(
                f"optimisation {self.name!r} varies {vary.field}, which takes whole numbers; a search moves in real "
                "ones: make a condition of each."
            )
        if not vary.low <= start_value <= vary.high:
            raise InvalidDesign(
                f"optimisation {self.name!r} starts with {vary.field} at {start_value:g}, outside its range of "
                f"{vary.low:g} to {vary.high:g}; widen the range or start elsewhere."
            )
        for end in (vary.low, vary.high):
            try:
                with_values(self.run, {vary.field: end})
            except InvalidFields as error:
                if any(complaint.field for complaint in error.complaints):
                    raise InvalidDesign(f"optimisation {self.name!r} varies {vary.field}, but {error}") from error
            except InvalidDesign:
                continue  # wrong together with the start; it may be right together with what varies

    def for_arm(self, arm: Arm) -> "Optimisation":
        """Return the search of one condition alone: what it sets is set, and does not vary.

        Raises:
            UnknownName: it sets a field that does not exist.
            InvalidDesign: nothing is left that varies, or its values cannot be.
        """
        if self.arms == (arm,) and not arm.values:
            return self
        remaining = tuple(v for v in self.vary if v.field not in arm.values)
        if not remaining:
            raise InvalidDesign(f"arm {arm.name!r} of optimisation {self.name!r} sets every field that varies.")
        run = replace(with_values(self.run, arm.values), label=arm.name)
        return replace(self, run=run, vary=remaining, arms=(Arm(name=arm.name),))

    def candidate(self, shares: Mapping[str, float]) -> Run:
        """Return the run whose fields lie at these shares of their ranges.

        Args:
            shares: shares by field, 0 to 1.

        Raises:
            InvalidDesign: the values cannot be together.
        """
        values: dict[str, Any] = {v.field: value_at_fraction(v, shares[v.field]) for v in self.vary}
        for vary in self.vary:
            if vary.above is not None:
                path, factor = vary.above
                other_value = values[path] if path in values else value_at(self.run, path)
                values[vary.field] = max(values[vary.field], factor * other_value)
        return with_values(self.run, values)

    @property
    def start(self) -> list[float]:
        """The shares of their ranges at which the fields start [-]."""
        return [fraction_of_range(v, float(value_at(self.run, v.field))) for v in self.vary]


def value_at_fraction(vary: Vary, share: float) -> float:
    """Return the value at a share of a range."""
    assert vary.low is not None
    assert vary.high is not None
    if vary.scale == "log":
        return float(vary.low * (vary.high / vary.low) ** share)
    return float(vary.low + (vary.high - vary.low) * share)


def fraction_of_range(vary: Vary, value: float) -> float:
    """Return at which share of its range a value lies."""
    assert vary.low is not None
    assert vary.high is not None
    if vary.scale == "log":
        return log(value / vary.low) / log(vary.high / vary.low)
    return (value - vary.low) / (vary.high - vary.low)


Task = Literal["crawl", "turn", "stand"]
TASKS: Mapping[str, Control] = MappingProxyType(
    {
        "crawl": OpenLoop(),
        "turn": Walking(bend=0.4, asymmetry=0.5),
        "stand": Standing(at=1.1, hold=3.0),
    }
)
"""How the gait is carried out: as it is; with a curvature offset and unequal strokes, ``control.bend`` and
``control.asymmetry``; standing up after it, for ``control.hold``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchFile(Search):
    """The contents of the file of a search."""

    robot: str = "caiman"
    """Name in the catalog, or path of a TOML file beside this one."""
    gait: str | None = None
    """Name in the catalog, or path of a TOML file beside this one; by default the robot's own."""
    task: Task = "crawl"
    """Task: ``crawl``, ``turn`` or ``stand``."""
    ground: Ground = field(default_factory=Ground)
    """Ground: its friction scale, slopes and relief."""


EXAMPLE = SearchFile(
    name="example",
    vary=(Vary(field="gait.stroke", low=0.0, high=0.5),),
    aims=(Aim(name="displacement"),),
)
"""What a file's mistakes are mended with while the others are looked for."""


def read_optimisation(path: str | Path) -> Optimisation:
    """Read a search from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
        UnknownName: a field, an aim, a limit, a robot or a gait that does not exist.
        InvalidDesign: a range that cannot be, or that the start is not in.
    """
    path = Path(path)
    page = blueprint.read_design(path, SearchFile, {EXAMPLE.name: EXAMPLE})
    robot = ROBOTS.resolve(page.robot, path.parent)
    run = Run(
        robot=robot,
        gait=gait_of(robot, page.gait, path.parent),
        ground=page.ground,
        control=TASKS[page.task],
    )
    return Optimisation(run=run, **{f.name: getattr(page, f.name) for f in fields(Search)})
