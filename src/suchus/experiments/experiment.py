"""The contract of an experiment: a frozen question, its outcome, and verdicts on claims."""

import re
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cache
from math import ceil, floor, isfinite, log10, nan
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
import xarray as xr
from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError, TemplateNotFound
from jinja2.ext import Extension

from suchus.article.verdict import Rule, Verdict, comparison_word, judge, listed, word_of, write
from suchus.core.errors import AmbiguousName, BrokenFile, InvalidDesign
from suchus.core.intervals import CONFIDENCE, fraction_interval, median_interval
from suchus.core.progress import Progress, silent, staged
from suchus.experiments import time_steps
from suchus.experiments.claims import check_claims, known_claims, rules_of
from suchus.robot.design import Robot, check_needs, lacking
from suchus.robot.design.meaning import meanings, unit
from suchus.robot.design.scale import coarse_step, control_period, rescale_fields
from suchus.robot.gaits import default_gait, in_size
from suchus.robot.motion import Gait, check_limits, suits

__all__ = [
    "Experiment", "Extent", "Measure", "Measures", "Outcome", "Progress", "Replay", "SimulationResult", "ends",
    "estimated", "estimated_fraction", "ranged", "silent", "staged", "stopwatch", "templates", "write",
]  # fmt: skip
ALTERNATIVES = ("displacement", "speed_range", "swim_free", "floating")
"""Experiments that a robot is referred to if it lacks what another one needs; the last takes any robot."""
Extent = Literal["whole", "verdicts"]
"""How much of a question is simulated: all of it, or what its verdicts, their reasons and its answers need.

What is left out has no measure, no figure and no sentence. ``Experiment.for_verdicts`` sets it in experiments that have
a field ``extent``.
"""
EXPLANATION = "explanation.md"
"""Template of what an experiment in a folder says decided its outcome."""
_NUMBER = re.compile(r"\{\{ ([^{}]+?):([a-zA-Z]*\+?(?:\.\d+)?[a-z%]) \}\}")


@dataclass(frozen=True, slots=True)
class Measure:
    """A number with its unit."""

    value: float
    unit: str
    """SI unit, ``-`` for none."""
    step_change: float = 0.0
    """Greatest change with smaller time steps, in its unit, see ``time_steps``; 0 where that is within its tolerance or
    not known, infinite where there is no number at some steps."""


class Measures(dict[str, Measure]):
    """Numbers by name. A second number with the same name is refused and never overwrites the first.

    This holds for ``Measures(one, other)``, ``one | other``, ``one |= other`` and ``one[name] = number``.
    """

    def __init__(self, *parts: Mapping[str, Measure] | Iterable[tuple[str, Measure]]) -> None:
        super().__init__()
        for group in parts:
            self |= group

    def __setitem__(self, name: str, measure: Measure) -> None:
        """Add a number.

        Raises:
            AmbiguousName: a number has this name already.
        """
        if name in self:
            existing_text, new_text = (f"{number.value:g} {number.unit}" for number in (self[name], measure))
            raise AmbiguousName("measure", name, existing_text, new_text)
        super().__setitem__(name, measure)

    def __ior__(self, numbers: Mapping[str, Measure] | Iterable[tuple[str, Measure]]) -> Self:  # type: ignore[override]
        for name, measure in numbers.items() if isinstance(numbers, Mapping) else numbers:
            self[name] = measure
        return self

    def __or__(self, numbers: Mapping[str, Measure]) -> "Measures":  # type: ignore[override]
        return Measures(self, numbers)

    def __ror__(self, numbers: Mapping[str, Measure]) -> "Measures":  # type: ignore[override]
        return Measures(numbers, self)

    def update(self, *parts: Any, **measures: Measure) -> None:
        """Add numbers, as ``|=``."""
        self |= Measures(*parts, measures)


def estimated(name: str, repeats: Any, unit: str, *, confidence: float = CONFIDENCE) -> Measures:
    """Return the median of an ensemble as ``NAME``, and its 95 % interval as ``NAME_low`` and ``NAME_high``.

    The interval is that of order statistics, see ``median_interval``: it is the uncertainty of the median, holds for
    any distribution, and becomes narrower with the number of repeats. With fewer than six repeats both ends are NaN,
    which is unknown: such a measure decides no clause.

    Args:
        name: name of the measure.
        repeats: number of every repeat; if one is not finite, measure and interval are NaN.
        unit: unit of the numbers.
        confidence: least probability of coverage; that of ``look_confidence`` for sequential sampling [-].
    """
    values = np.asarray(repeats, float).ravel()
    lower_bound, upper_bound = median_interval(values, confidence=confidence)
    return _measure_with_interval(name, float(np.median(values)), lower_bound, upper_bound, unit)


def estimated_fraction(name: str, outcomes: Any, *, confidence: float = CONFIDENCE) -> Measures:
    """Return the fraction of repeats in which an event occurred as ``NAME``, and its exact 95 % interval.

    The ends are ``NAME_low`` and ``NAME_high``, after Clopper and Pearson, see ``fraction_interval``.

    Args:
        name: of the measure.
        outcomes: whether the event occurred, of every repeat; if one is NaN, measure and interval are NaN.
        confidence: least probability of coverage; that of ``look_confidence`` for sequential sampling [-].
    """
    values = np.asarray(outcomes, float).ravel()
    if not np.isfinite(values).all():
        return _measure_with_interval(name, nan, nan, nan, "-")
    lower_bound, upper_bound = fraction_interval(int(values.sum()), values.size, confidence=confidence)
    return _measure_with_interval(name, float(values.mean()), lower_bound, upper_bound, "-")


def _measure_with_interval(name: str, center: float, lower_bound: float, upper_bound: float, unit: str) -> Measures:
    """Return a measure with the ends of its interval."""
    numbers = {name: center, f"{name}_low": lower_bound, f"{name}_high": upper_bound}
    return Measures({key: Measure(value, unit) for key, value in numbers.items()})


def ranged(name: str, value: Any, repeats: Any, unit: str) -> Measures:
    """Return a number as ``NAME``, and the range of its repeats as ``NAME_low`` and ``NAME_high``."""
    return Measures({name: Measure(float(value), unit)}, ends(name, repeats, unit))


def ends(name: str, values: Any, unit: str) -> Measures:
    """Return the least and the greatest of some values as ``NAME_low`` and ``NAME_high``."""
    minimum, maximum = (Measure(float(end(values)), unit) for end in (np.min, np.max))
    return Measures({f"{name}_low": minimum, f"{name}_high": maximum})


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """A page that plays a run in a browser."""

    caption: str
    """Caption: what the replay shows."""
    make: Callable[[], str]
    """Makes the page on first use. See ``suchus.visual.replay``."""

    @property
    def html(self) -> str:
        """The page, without references to other files."""
        return self.make()


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulationResult:
    """Record and files of a simulated experiment, before anything is measured."""

    record: xr.Dataset
    """Record of the simulation; measures and figures come from the record alone."""
    tables: Mapping[str, str] = field(default_factory=dict)
    """Further text files, by file name."""
    films: Mapping[str, bytes] = field(default_factory=dict)
    """Animated GIFs, by file name; see ``figures.film``."""
    replays: Mapping[str, Replay] = field(default_factory=dict)
    """Replays of runs, by file name ending in .html."""
    checkpoint_files: tuple[Path, ...] = ()
    """Checkpoint files; the caller removes them after saving the outcome."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome(SimulationResult):
    """The result: numbers, verdicts, and the record they were read from."""

    experiment: str
    """Name in the catalog."""
    measures: Mapping[str, Measure]
    """Every number, by name."""
    verdicts: tuple[Verdict, ...]
    """One for each claim that the experiment touches; none where ``unjudged`` says why."""
    settings: Mapping[str, Any]
    """The experiment's own fields, as plain values."""
    decides: str = ""
    """Reason for the outcome: one paragraph for the report, made from the measures."""
    unjudged: str = ""
    """Why there are no verdicts, in a sentence; empty where the claims were judged."""
    too_short: str = ""
    """Why the run cannot answer, and what would, in two sentences; empty where it answers. The measures and ``decides``
    are then of a start-up: reports and the terminal say this in their place, and draw no figure."""
    seconds: float = 0.0
    """Wall-clock duration of the run [s]; of its last part where it went on from what an earlier one had kept."""

    @property
    def statement(self) -> str:
        """What the run says: what decided its outcome, or that it is too short to answer."""
        return self.too_short or self.decides


CONDUCT = ("keep", "jobs", "scheduler")
"""Names of fields that say where and by how many processes an experiment runs. They do not affect the result and are
not stored in it."""


class Experiment(ABC):
    """A question with parameters. Subclasses are frozen dataclasses; their fields are the parameters.

    A run simulates, measures what was recorded, judges claims, the article's or its own, by the rules of
    ``suchus.article.verdict``, and says what decided. Subclasses fill in ``simulate``, ``measure`` and ``draw``,
    and say what decided in ``explanation.md`` beside them, or in ``explain``.
    """

    __slots__ = ()

    title: ClassVar[str]
    """The question in one line, as a person would ask it."""
    shows: ClassVar[str]
    """Which sections, figures or equations of the article it answers."""
    answers: ClassVar[tuple[str, ...]] = ()
    """Names of the measures that carry the answer: the terminal shows the first six of them that a run has, three at
    least; the first that are finite where none is named."""
    needs: ClassVar[tuple[str, ...]] = ()
    """What it needs of a robot: names of ``design.NEEDS``; written out, so that ``suchus list`` can show it."""
    reproduces: ClassVar[bool] = True
    """Whether ``suchus reproduce`` runs it without ``--all``; False for what judges none of the article's claims."""
    follows_gait: ClassVar[bool] = True
    """Whether the joints must be able to follow the gait; False where whether they can is a part of the question."""
    judged_settings: ClassVar[tuple[str, ...]] = ("robot",)
    """Fields that must be as in the catalog for a verdict: another robot is not judged by the article's metres."""
    judged_minima: ClassVar[Mapping[str, float]] = {}
    """Fields, and the least number (of a tuple: the least length) with which a run can answer what is judged."""

    answer_minima: ClassVar[Mapping[str, float]] = {}
    """Fields, and the least number (of a tuple: the least length) with which a run answers, see ``too_short``."""

    @property
    def claims(self) -> tuple[str, ...]:
        """Keys of the claims that get a verdict, the article's and its own."""
        return tuple(rule.claim for rule in self.rules())

    @classmethod
    def rules(cls) -> tuple[Rule, ...]:
        """Return the rules of the verdicts."""
        return rules_of(cls.name())

    def run(self, progress: Progress = silent) -> Outcome:
        """Answer the question.

        Raises:
            UnsuitedRobot: the robot lacks what the experiment needs.
            OutsideLimits: the gait is for other limbs, or exceeds the limits of the joints.
            InvalidDesign: a field holds two entries of the same name, or a rule judges a claim that nobody states.
        """
        self._check_names()
        check_claims(self.name(), self.rules())
        if hasattr(self, "robot"):
            self._check_robot(self.robot)
            gaits = (*_gaits(getattr(self, "gait", None)), *_gaits(getattr(self, "gaits", None)))
            for gait in gaits if self.follows_gait else ():
                check_limits(self.robot, gait)  # first, so that an error names the user's gait and not a derived one
        with stopwatch() as seconds:
            simulated = self.simulate(progress)
            measures = self._with_step_changes(self.measure(simulated.record))
            numbers = {name: float(measure.value) for name, measure in measures.items()}
            unjudged = self.unjudged()
            return Outcome(
                experiment=self.name(),
                measures=measures,
                verdicts=() if unjudged else self._judge_claims(numbers, simulated.record),
                record=simulated.record,
                settings=self.settings(),
                tables=simulated.tables,
                films=simulated.films,
                replays=simulated.replays,
                checkpoint_files=simulated.checkpoint_files,
                decides=" ".join(self.explain(numbers).split()),
                unjudged=unjudged,
                too_short=self.too_short(),
                seconds=seconds(),
            )

    def _check_robot(self, robot: Robot) -> None:
        """Refuse a robot that lacks what the experiment needs, and name one of ``ALTERNATIVES`` that it suits.

        Raises:
            UnsuitedRobot: the robot lacks something.
        """
        if not lacking(robot, self.needs):
            return
        from suchus.experiments.catalog import EXPERIMENTS  # noqa: PLC0415  the catalog's entries import this module

        alternative = next(
            name for name in ALTERNATIVES if name != self.name() and not lacking(robot, EXPERIMENTS[name].needs)
        )
        remedy = f"choose another robot, or ask suchus run {alternative}, whose needs it meets"
        check_needs(robot, self.needs, self.name(), remedy=remedy)

    def _check_names(self) -> None:
        """Refuse a parameter that holds two entries of the same name, since their measures would have the same name."""
        for parameter in fields(self):  # type: ignore[arg-type]
            value = getattr(self, parameter.name)
            entries = value if isinstance(value, tuple) else ()
            names = [
                entry if isinstance(entry, str) else entry.name for entry in entries if isinstance(entry, (str, Gait))
            ]
            duplicates = [name for name in dict.fromkeys(names) if names.count(name) > 1]
            if duplicates:
                raise InvalidDesign(
                    f"{self.name()}.{parameter.name} has {' and '.join(map(repr, duplicates))} more than once; leave "
                    f"one out, or give it another name."
                )

    @abstractmethod
    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate the experiment and return its record."""

    def _judge_claims(self, numbers: Mapping[str, float], record: xr.Dataset) -> tuple[Verdict, ...]:
        unable, claims = self.unable(record), known_claims(self.name())
        verdicts = [judge(rule, numbers, unable=unable, claims=claims) for rule in self.rules()]
        compared = time_steps.comparison_of(self)
        if compared is None:
            return tuple(verdicts)
        return tuple(
            replace(verdict, time_step=time_steps.caution(verdict.rule, numbers, compared.changes, claims))
            for verdict in verdicts
        )

    def _with_step_changes(self, measures: Mapping[str, Measure]) -> Measures:
        """Return measures, with their changes with the time step where these are known."""
        compared = time_steps.comparison_of(self)
        changes = {} if compared is None else compared.changes
        return Measures(
            {name: replace(measure, step_change=changes.get(name, 0.0)) for name, measure in measures.items()}
        )

    @classmethod
    def has_word(cls, claim: str, measures: Mapping[str, Measure]) -> bool:
        """Return whether measures give a claim of the article another word than ``undecided``, in each of its readings.

        Sequential sampling ends then, see ``suchus.core.intervals.planned_looks``.

        Args:
            claim: key of a claim that this experiment judges.
            measures: at least those that its rule reads.
        """
        numbers = {name: measure.value for name, measure in measures.items()}
        rules = [rule for rule in cls.rules() if rule.claim == claim]
        readings = [reading for rule in rules for reading in (rule, *rule.interpreted_rules)]
        return all(word_of(reading, numbers) != "undecided" for reading in readings)

    def unable(self, record: xr.Dataset) -> Mapping[str, str]:
        """Return the reasons why models could not run, by the names of rungs; none by default."""
        del record
        return {}

    @abstractmethod
    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return every number, computed from the record alone; ``Measures`` refuse two numbers with the same name."""

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the wanted measures, with the values of a full run.

        By default all runs are simulated; subclasses leave out runs that the wanted measures do not need.

        Args:
            measure_names: names of measures.
            progress: called with the fraction that is done.
        """
        del measure_names
        return Measures(self.measure(self.simulate(progress).record))

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return the reason for the outcome, in a paragraph whose statements all follow from the measures.

        It is the template ``explanation.md`` beside the experiment, see ``templates``, in which ``m`` holds the
        measures by name, and ``question`` is the experiment.

        Raises:
            InvalidDesign: there is no such file.
            BrokenFile: it cannot be filled in: a measure that it names is missing, or it cannot be read.
        """
        return self.render_explanation(measures)

    def render_explanation(self, measures: Mapping[str, float], **further: Any) -> str:
        """Return the template ``explanation.md``, filled in with measures and other values; see ``explain``."""
        folder = Path(getattr(sys.modules[type(self).__module__], "__file__", None) or ".").parent
        try:
            text = templates(folder).get_template(EXPLANATION).render(m=measures, question=self, **further)
        except TemplateNotFound as error:
            raise InvalidDesign(
                f"{self.name()} does not say what decided: there is neither a method explain nor {EXPLANATION} in the "
                f"folder {folder.name}; write one of them."
            ) from error
        except TemplateError as error:
            names = ", ".join(list(measures)[:20]) + ", ..." * (len(measures) > 20)
            raise BrokenFile(
                f"{folder.name}/{EXPLANATION} cannot be filled in: {error}. The measures, m.NAME, are {names}."
            ) from error
        return re.sub(r" ([,.;:)])", r"\1", " ".join(text.split()))

    @abstractmethod
    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Return matplotlib figures by name, drawn from ``outcome.record`` and nothing else.

        The first line of each figure's ``suchus_caption`` attribute is its caption; see ``figures.captioned``.
        """

    @abstractmethod
    def quick(self) -> "Experiment":
        """Return the same question, small enough for a test."""

    def for_verdicts(self) -> Self:
        """Return the same question without what no verdict needs: the points of maps, runs that are only compared.

        The verdicts have the same words. It is the same question where nothing can be left out.
        """
        return self

    def for_robot(self, robot: Robot) -> Self:
        """Return the same question for another robot.

        Where the robot is of about the same size, walks in the same gait and can follow the gaits, nothing else
        changes. If not, they become its own gait, and lengths, times, forces and masses change with its size.

        Raises:
            UnsuitedRobot: the robot lacks what the experiment needs, or no gait in the catalog suits it.
        """
        self._check_robot(robot)
        names = [parameter.name for parameter in fields(self)]  # type: ignore[arg-type]
        if "robot" not in names:
            return self
        values = {name: getattr(self, name) for name in names}
        current_robot: Robot = values["robot"]
        gaits = [gait for value in values.values() for gait in _gaits(value)]
        is_similar = control_period(robot) == control_period(current_robot) and (
            not gaits or default_gait(robot) == default_gait(current_robot)
        )
        if is_similar and all(suits(robot, gait) for gait in gaits):
            return replace(self, robot=robot)  # type: ignore[type-var]
        plain = [name for name, value in values.items() if name != "robot" and not _gaits(value)]
        sized = rescale_fields(
            self, plain, length_factor=robot.length / current_robot.length, mass_factor=robot.mass / current_robot.mass
        )
        step_ratio = coarse_step(robot) / coarse_step(current_robot)  # time steps divide the control period
        for name in names:
            if "timestep" in name:
                value = values[name]
                sized[name] = (
                    tuple(step_ratio * step for step in value) if isinstance(value, tuple) else step_ratio * value
                )
        return replace(self, robot=robot, **(sized | self.gaits_for_robot(robot)))  # type: ignore[type-var]

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the fields that hold gaits, for a robot of another size or one that cannot follow the present gaits.

        They are the present gaits in the robot's size if it can follow them all and its own gait is the same one.
        Otherwise they are its own gait.

        Raises:
            UnsuitedRobot: no gait in the catalog suits it.
        """
        current_robot: Robot = self.robot  # type: ignore[attr-defined]
        own_gait, names = default_gait(robot), [parameter.name for parameter in fields(self)]  # type: ignore[arg-type]
        gait_settings = {name: getattr(self, name) for name in names if _gaits(getattr(self, name))}
        if own_gait.name == default_gait(current_robot).name:
            sized = {
                name: tuple(in_size(gait, robot, current_robot) for gait in _gaits(value))
                for name, value in gait_settings.items()
            }
            if all(suits(robot, gait) for gaits in sized.values() for gait in gaits):
                return {
                    name: gaits if isinstance(gait_settings[name], tuple) else gaits[0] for name, gaits in sized.items()
                }
        gait_fields = {"gait": own_gait, "gaits": (own_gait,)}
        return {name: value for name, value in gait_fields.items() if name in names}

    def unjudged(self) -> str:
        """Return the reason why a run with these settings gets no verdicts; empty if it does."""
        if not self.rules():
            return ""
        default = type(self)()
        for name in self.judged_settings:
            if hasattr(self, name) and getattr(self, name) != getattr(default, name):
                current_text, required_text = (_short_name(getattr(question, name)) for question in (self, default))
                current_text = f"another {current_text}" if current_text == required_text else current_text
                return f"Not judged: {name} is {current_text}, and its claims are judged with {required_text}."
        shortfall = self._shortfall(self.judged_minima)
        return f"Not judged: {shortfall} to meet what is judged." if shortfall else ""

    def too_short(self) -> str:
        """Return that a run with these settings cannot answer, and what would; empty if it can.

        Such a run sees a start-up or too few repeats, so that its numbers are not those of the full form.
        """
        shortfall = self._shortfall(self._sized_minima())
        if not shortfall:
            return ""
        return f"Too short to answer: {shortfall}. `suchus run {self.name()}` with its own settings answers."

    def _sized_minima(self) -> Mapping[str, float]:
        """Return ``answer_minima`` for the size of the robot: a smaller robot does the same in less time."""
        minima = self.answer_minima
        if not minima or not hasattr(self, "robot"):
            return minima
        default = type(self)()
        if self.robot.length >= default.robot.length:  # type: ignore[attr-defined]
            return minima
        numbers = {name: getattr(default, name) for name in minima if isinstance(getattr(default, name), float)}
        length_factor = self.robot.length / default.robot.length  # type: ignore[attr-defined]
        mass_factor = self.robot.mass / default.robot.mass  # type: ignore[attr-defined]
        sized = rescale_fields(default, [*numbers], length_factor=length_factor, mass_factor=mass_factor)
        factors = {name: min(sized.get(name, number) / number, 1.0) for name, number in numbers.items()}
        return {name: factors.get(name, 1.0) * minimum for name, minimum in minima.items()}

    def _shortfall(self, minima: Mapping[str, float]) -> str:
        """Return the first field that is below its minimum, as a clause; empty if none is."""
        for name, minimum in minima.items():
            value = getattr(self, name)
            count = len(value) if isinstance(value, tuple) else value
            if count < minimum:
                unit_of_value = "" if isinstance(value, tuple) else unit(meanings(type(self)).get(name, ""))
                unit_text = f" {unit_of_value}" if unit_of_value.strip("-") else ""
                size_text = f"{name} has {count} values" if isinstance(value, tuple) else f"{name} is {count:g}"
                return f"{size_text}{unit_text}, and {_rounded_up(minimum)}{unit_text} at least are needed"
        return ""

    def settings(self) -> dict[str, Any]:
        """Return the fields as plain values, without those of ``CONDUCT``."""
        return {name: value for name, value in asdict(self).items() if name not in CONDUCT}  # type: ignore[call-overload]

    @classmethod
    def name(cls) -> str:
        """Return the name in the catalog: that of the module, or of the folder of a module ``experiment``."""
        return cls.__module__.removesuffix(".experiment").rpartition(".")[2]


def _gaits(value: Any) -> tuple[Gait, ...]:
    """Return the gaits that a field holds."""
    entries = value if isinstance(value, tuple) else (value,)
    return tuple(entry for entry in entries if isinstance(entry, Gait))


def _rounded_up(minimum: float) -> str:
    """Return a minimum as text: whole as it is, else with three digits, of which the last is rounded up."""
    if float(minimum).is_integer():
        return f"{minimum:g}"
    step = 10.0 ** (floor(log10(minimum)) - 2)
    return f"{ceil(minimum / step) * step:.3g}"


def _short_name(value: Any) -> str:
    """Return a short name of a field's value: the name of a robot or gait, otherwise its text."""
    if isinstance(value, tuple):
        return ", ".join(_short_name(entry) for entry in value)[:80]
    return str(getattr(value, "name", value))[:80]


class _NumberFormats(Extension):
    """``{{ number:.3f }}`` in a template."""

    def preprocess(self, source: str, name: str | None, filename: str | None = None) -> str:
        """Return the template with formats as a filter."""
        del name, filename
        return _NUMBER.sub(r'{{ (\1) | write("\2") }}', source)


@cache
def templates(folder: Path) -> Environment:
    """Return the Jinja templates of a folder, whose numbers are filled in by name.

    ``{{ m.speed:.3f }}`` is written as Python's format does, or in another unit where the format begins with it, as
    ``mm.1f`` (``suchus.article.verdict.Reading``); where the format is a variable, ``{{ m.speed | write(form) }}``.
    Beside ``compared`` and ``listed`` there are ``separator(loop)``, which lists the items of a loop in a sentence,
    ``either_sign(m, name)`` and ``spanned(m, name, form)`` for measures whose interval may hold both signs, the filter
    ``sentence`` for parts any of which may be missing, and the test ``is finite``. A name that is not there is an
    error.
    """
    environment = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        extensions=[_NumberFormats],
        autoescape=False,
    )
    environment.filters |= {"write": write, "sentence": sentence}
    environment.tests["finite"] = isfinite
    environment.globals |= {"compared": comparison_word, "listed": listed, "separator": separator}
    environment.globals |= {"either_sign": either_sign, "spanned": spanned}
    return environment


def either_sign(measures: Mapping[str, float], name: str) -> bool:
    """Return whether the interval of a measure holds both signs."""
    return measures.get(f"{name}_low", 0.0) < 0.0 < measures.get(f"{name}_high", 0.0)


def spanned(measures: Mapping[str, float], name: str, form: str) -> str:
    """Return a measure as text, or its interval if the interval holds both signs."""
    if not either_sign(measures, name):
        return write(measures[name], form)
    lower_bound, upper_bound = (write(measures[f"{name}{end}"], form) for end in ("_low", "_high"))
    return f"between {lower_bound} and {upper_bound}"


def separator(loop: Any) -> str:
    """Return the separator before an item of a list in a sentence: nothing, a comma, or ``and`` before the last."""
    return "" if loop.first else " and " if loop.last else ", "


def sentence(parts: str) -> str:
    """Return consecutive parts as a sentence; empty without parts."""
    text = parts.strip(" \n,;")
    return f"{text[:1].upper()}{text[1:]}." if text else ""


@contextmanager
def stopwatch() -> Iterator[Callable[[], float]]:
    """Yield a function that returns the seconds since the block was entered."""
    start = time.perf_counter()
    yield lambda: time.perf_counter() - start
