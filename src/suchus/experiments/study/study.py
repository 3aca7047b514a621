"""A study: a run, what varies about it, and what is measured."""

from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Literal, get_args

from suchus.core.checks import Checks, InvalidFields
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.experiments.study.arm import Arm
from suchus.experiments.study.measures import MEASURES
from suchus.robot.design import value_at, with_values
from suchus.robot.design.scale import control_period
from suchus.robot.motion import START
from suchus.sim.land import Run

Design = Literal["factorial", "sobol", "latin"]
"""How values are put together: every combination, a Sobol sequence, or a Latin hypercube."""
MIN_DURATION = START + 0.1
"""A run that is shorter leaves nothing to measure [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Vary:
    """A field of the run and what it takes: listed values, a range, or a normal distribution within a range."""

    field: str
    """Dotted path from the run, as ``gait.stroke``, ``robot.contact.foot_friction``, ``ground.friction_scale``."""
    values: tuple[Any, ...] | None = None
    """Values to choose from: numbers, or whole robots, gaits or tuples of faults."""
    low: float | None = None
    """Least value, in the field's unit."""
    high: float | None = None
    """Greatest value, in the field's unit."""
    scale: Literal["linear", "log"] = "linear"
    """Whether a range is filled evenly in the value or in its logarithm."""
    steps: int | None = None
    """Number of values of the range that a factorial study takes, both ends included [-]."""
    mean: float | None = None
    """Mean of a normal distribution, in the field's unit; ``low`` and ``high`` then cut it off."""
    spread: float | None = None
    """Standard deviation of that distribution, in the field's unit."""
    each: bool = False
    """Run every sample with each of the values, rather than with one of them."""
    above: tuple[str, float] | None = None
    """Path of another field and a factor: a sampled range begins at that field's value times the factor, if above
    ``low``."""

    def __post_init__(self) -> None:
        field: object = self.field  # of any kind until it was looked at
        label = field if isinstance(field, str) else "a field"
        with Checks(f"what varies {label}", self) as check:
            self._check(check)

    def _check(self, check: Checks) -> None:
        """Refuse a field that has no values, or whose values, range and distribution contradict each other."""
        ends = self.low is not None and self.high is not None
        normal = self.mean is not None or self.spread is not None
        definitions = [self.values is not None, ends or (normal and self.mean is not None)]
        field: object = self.field
        label = field if isinstance(field, str) else "a field that varies"
        check.that(sum(definitions) == 1, f"{label} needs either values, or low and high, or mean and spread")
        if self.values is not None:
            check.that(len(self.values) > 0, f"{label} has no values; at least one is needed")
        for name in ("low", "high", "mean", "spread"):
            if getattr(self, name) is not None:
                check.number(name, -1e12, 1e12, "")
        if self.low is not None and self.high is not None and isfinite(self.low) and isfinite(self.high):
            check.that(self.low < self.high, f"{label} has low {self.low:g} and high {self.high:g}; low must be less")
            positive = self.scale == "linear" or self.low > 0
            check.that(positive, f"{label} has low {self.low:g}; a logarithm needs more than 0")
        if normal:
            is_valid = self.mean is not None and self.spread is not None and self.spread > 0
            check.that(is_valid, f"{label} needs a mean and a spread of more than 0")
        if self.steps is not None:
            check.whole("steps", 2, 100_000)
        listed = self.values is not None or self.steps is not None
        check.that(listed or not self.each, f"{label} is taken with each of its values; give values or steps")

    @property
    def ends(self) -> tuple[Any, ...]:
        """The values that are tried before the study begins: all that are listed, or the ends of the range."""
        if self.values is not None:
            return self.values
        return tuple(v for v in (self.low, self.high, self.mean) if v is not None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Many runs that differ from one in some fields."""

    name: str
    """Name, as messages, tables and files show it."""
    run: Run
    """The run from which all differ."""
    vary: tuple[Vary, ...]
    """Fields that vary, and over which values."""
    measure: tuple[str, ...]
    """Names of ``suchus.sim.metrics``."""
    design: Design = "factorial"
    """Sampling of the values; with ``sobol`` and ``latin``, those taken with ``each`` are still combined."""
    samples: int | None = None
    """Number of points that a Sobol sequence or a Latin hypercube has [-]."""
    seed: int = 0
    """Seed of the sampling, and of the first run's noise [-]."""
    seeds: int = 1
    """Number of runs of each point, with seeds that follow each other; it matters with ``run.noise`` only [-]."""
    duration: float = 9.0
    """Duration of each run [s]; measures begin after the first second, in which the robot settles."""
    timestep: float = 0.005
    """Time step of the physics [s]; up to 5 ms the crawl's displacement was measured to stay the same within 0.1 %."""
    chunk: int = 32
    """Most runs that are simulated together, and lost when the study is killed [-]; about 3 MB of memory for
    each."""
    arms: tuple[Arm, ...] = ()
    """Conditions of a comparison; every run is made in each of them."""
    every: int = 1
    """Measures look at one sample of so many control periods of 10 ms [-]; memory shrinks with it."""
    reasons: tuple[str, ...] = field(default=())
    """Why these fields and ranges, for whoever reads the results."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, unknown measures, and fields that the run does not have."""
        with Checks("study", self) as check:
            check.whole("seed", 0, 2**32 - 1)
            check.whole("seeds", 1, 100_000)
            check.whole("chunk", 1, 10_000)
            check.whole("every", 1, 10_000)
            check.number("duration", MIN_DURATION, 86400.0, "s")
            check.number("timestep", 1e-5, control_period(self.run.robot), "s")
            check.that(len(self.vary) > 0, "study.vary is empty; name at least one field")
            check.that(len(self.measure) > 0, "study.measure is empty; name at least one measure")
            design: object = self.design
            check.that(
                not isinstance(design, str) or design in get_args(Design),  # another kind is reported anyway
                f"study.design is {self.design!r}; {', '.join(get_args(Design))} is allowed",
            )
            if self.design in ("sobol", "latin"):
                check.that(self.samples is not None, f"study.samples is missing; a {self.design} design needs it")
            if self.samples is not None:
                check.whole("samples", 1, 10_000_000)
            names = [arm.name for arm in self.arms]
            check.that(len(set(names)) == len(names), f"study.arms are called {', '.join(names)}; each once")
        self._check_measures()
        self._check_fields()

    def takes_integers(self, field: str) -> bool:
        """Return whether a field of the run takes whole numbers only."""
        current_value = value_at(self.run, field)
        return isinstance(current_value, int) and not isinstance(current_value, bool)

    def _check_measures(self) -> None:
        for name in self.measure:
            if name not in MEASURES:
                raise UnknownName("measure", name, MEASURES)

    def _check_fields(self) -> None:
        """Refuse fields that do not exist, and values that the run refuses alone."""
        if self.seed + self.seeds > 2**32:
            raise InvalidDesign(
                f"study {self.name!r} has seed {self.seed} and {self.seeds} seeds from it on; the last may be "
                f"{2**32 - 1}: choose a smaller seed."
            )
        paths = [vary.field for vary in self.vary]
        for vary in self.vary:
            if paths.count(vary.field) > 1:
                raise InvalidDesign(f"study {self.name!r} varies {vary.field} twice; once is allowed.")
            if self.design == "factorial" and vary.values is None and vary.steps is None:
                raise InvalidDesign(f"study {self.name!r} needs values or steps for {vary.field}: it is factorial.")
            if vary.field in ("seed", "label"):
                raise InvalidDesign(
                    f"study {self.name!r} varies {vary.field}; the study sets it: choose seed and seeds."
                )
            is_whole = self.takes_integers(vary.field)
            if is_whole:
                self._check_whole(vary)
            for value in (round(end) if is_whole and vary.values is None else end for end in vary.ends):
                try:
                    with_values(self.run, {vary.field: value})
                except InvalidFields as error:
                    if any(complaint.field for complaint in error.complaints):
                        raise InvalidDesign(f"study {self.name!r} varies {vary.field}, but {error}") from error
                except InvalidDesign:
                    continue  # wrong together with what the run has now; it may be right together with what varies
        for arm in self.arms:
            with_values(self.run, arm.values)

    def _check_whole(self, vary: Vary) -> None:
        """Refuse a range of whole numbers whose ends or steps are none."""
        ends = [end for end in (vary.low, vary.high) if end is not None]
        if any(end != round(end) for end in ends):
            raise InvalidDesign(
                f"study {self.name!r} varies {vary.field}, which takes whole numbers, from {ends[0]:g} to "
                f"{ends[-1]:g}; give whole ends."
            )
        if vary.steps is not None and vary.scale == "linear" and (ends[1] - ends[0]) % (vary.steps - 1):
            raise InvalidDesign(
                f"study {self.name!r} varies {vary.field}, which takes whole numbers, in {vary.steps} steps from "
                f"{ends[0]:g} to {ends[1]:g}, which are none; give other steps, or values."
            )
