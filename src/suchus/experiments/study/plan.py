"""The points of a study: which values each run takes."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from math import prod
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from scipy import stats
from scipy.stats import qmc

from suchus.core.errors import InvalidDesign
from suchus.experiments.study.arm import Arm
from suchus.experiments.study.study import Study, Vary
from suchus.robot.design import Assumption, value_at, with_values
from suchus.sim.land import Run

_MAX_RUNS = 10_000_000


class Point(NamedTuple):
    """One run of a study."""

    values: Mapping[str, Any]
    """Values by field."""
    seed: int
    """Seed of the run."""
    arm: Arm | None = None
    """Arm of the comparison, where there is one."""


class Plan(Sequence[Point]):
    """Every run of a study in order: the samples, in each the arms, in each the combinations, in each the seeds.

    Args:
        study: the study.

    Raises:
        InvalidDesign: it has more than ten million runs.
    """

    def __init__(self, study: Study) -> None:
        """Sample the unit cube and count the runs."""
        self.study = study
        factorial = study.design == "factorial"
        self._factorial_fields = [v for v in study.vary if factorial or v.each]
        self._sampled = [v for v in study.vary if not (factorial or v.each)]
        self._takes_whole = {v.field: study.takes_integers(v.field) for v in study.vary}
        self._levels = [levels(v, is_whole=self._takes_whole[v.field]) for v in self._factorial_fields]
        self._combinations = prod(len(v) for v in self._levels)
        count = (study.samples or 1) if self._sampled else 1
        self._arms = study.arms or (None,)
        self._length = count * len(self._arms) * self._combinations * study.seeds
        if self._length > _MAX_RUNS:
            raise InvalidDesign(f"study {study.name!r} has {self._length} runs; up to {_MAX_RUNS} are allowed.")
        self._fractions = evenly(study.design, count, len(self._sampled), study.seed)
        self._cached_runs: dict[tuple[int, int], Run] = {}

    def __len__(self) -> int:
        return self._length

    def __getitem__(self, index: Any) -> Any:
        """Return one point, or the list of points of a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        if not 0 <= index < len(self):
            raise IndexError(index)
        sample, arm, combination, repeat = self._run_indices(index)
        values: dict[str, Any] = {}
        for vary, levels_ in zip(reversed(self._factorial_fields), reversed(self._levels), strict=True):
            combination, level = divmod(combination, len(levels_))
            values[vary.field] = levels_[level]
        values |= joint_values(self.study.run, self._sampled, self._fractions[sample], self._takes_whole, values)
        return Point({v.field: values[v.field] for v in self.study.vary}, self.study.seed + repeat, self._arms[arm])

    def _run_indices(self, index: int) -> tuple[int, int, int, int]:
        """Return the numbers of a run's sample, arm, combination and seed."""
        quotient, repeat = divmod(index, self.study.seeds)
        quotient, combination = divmod(quotient, self._combinations)
        return *divmod(quotient, len(self._arms)), combination, repeat

    @property
    def chunks(self) -> int:
        """Number of batches [-]."""
        return -(-len(self) // self.study.chunk)

    def chunk(self, number: int) -> range:
        """Return the indices of the runs in a batch; batches of a study differ by one run at most."""
        base_size, larger_count = divmod(len(self), self.chunks)
        start = number * base_size + min(number, larger_count)
        return range(start, start + base_size + (number < larger_count))

    def run(self, index: int) -> Run:
        """Return one run.

        Raises:
            InvalidDesign: its values cannot be together.
        """
        point, (sample, _, combination, _) = self[index], self._run_indices(index)
        if (sample, combination) not in self._cached_runs:  # arms and seeds of a point share robot and gait
            point_run = self._vary(point.values)
            self._cached_runs = {key: run for key, run in self._cached_runs.items() if key[0] == sample}
            self._cached_runs[sample, combination] = point_run
        run = with_values(self._cached_runs[sample, combination], {"seed": point.seed, "label": str(index)})
        return run if point.arm is None else with_values(run, point.arm.values)

    def _vary(self, values: Mapping[str, Any]) -> Run:
        """Return the run from which all differ, with the values of a point."""
        run = self.study.run
        for depth in sorted({_depth(path) for path in values}):  # a whole gait first, then its fields
            run = with_values(run, {path: v for path, v in values.items() if _depth(path) == depth})
        return run


def _depth(path: str) -> int:
    return path.count(".") + path.count("[")


def levels(vary: Vary, *, is_whole: bool = False) -> tuple[Any, ...]:
    """Return the values of a field that are combined.

    Args:
        vary: the field.
        is_whole: whether it takes whole numbers only.
    """
    if vary.values is not None:
        return vary.values
    assert vary.steps is not None
    values = [value_of(vary, i / (vary.steps - 1)) for i in range(vary.steps)]
    return tuple(dict.fromkeys(round(value) for value in values)) if is_whole else tuple(values)


def value_of(vary: Vary, share: float, *, is_whole: bool = False) -> Any:
    """Return the quantile of a field's values.

    Args:
        vary: the field.
        share: fraction of the values below the quantile, 0 to 1.
        is_whole: whether the field takes whole numbers only; those of an even range are then equally frequent.
    """
    if vary.values is not None:
        return vary.values[min(int(share * len(vary.values)), len(vary.values) - 1)]
    if is_whole:
        return _whole_value(vary, share)
    if vary.mean is not None and vary.spread is not None:
        lower_bound = -np.inf if vary.low is None else (vary.low - vary.mean) / vary.spread
        upper_bound = np.inf if vary.high is None else (vary.high - vary.mean) / vary.spread
        probability = stats.norm.cdf(lower_bound) + share * (stats.norm.cdf(upper_bound) - stats.norm.cdf(lower_bound))
        probability = float(np.clip(probability, 1e-12, 1 - 1e-12))
        return float(vary.mean + vary.spread * np.clip(stats.norm.ppf(probability), lower_bound, upper_bound))
    assert vary.low is not None
    assert vary.high is not None
    if vary.scale == "log":
        return float(np.clip(vary.low * (vary.high / vary.low) ** share, vary.low, vary.high))
    return float(vary.low + (vary.high - vary.low) * share)


def joint_values(
    base: Any, varies: Sequence[Vary], shares: Iterable[float], takes_whole: Mapping[str, bool],
    given: Mapping[str, Any] = MappingProxyType({}),
) -> dict[str, Any]:  # fmt: skip
    """Return the quantiles of several fields; one that must be above another follows from that one's value.

    Args:
        base: what has the fields: other fields that a range depends on are looked up there.
        varies: the fields.
        shares: fraction of the values below the quantile of each, 0 to 1.
        takes_whole: whether each field takes whole numbers only.
        given: values of further fields.
    """
    values: dict[str, Any] = {}
    for vary, share in sorted(zip(varies, shares, strict=True), key=lambda pair: pair[0].above is not None):
        low = vary.low
        if vary.above is not None and low is not None and vary.high is not None:
            path, factor = vary.above
            other_value = values[path] if path in values else given[path] if path in given else value_at(base, path)
            low = min(max(low, factor * other_value), vary.high)
        values[vary.field] = value_of(replace(vary, low=low), float(share), is_whole=takes_whole.get(vary.field, False))
    return values


def vary_assumption(path: str, choice: Assumption) -> Vary:
    """Return the variation of a field over its plausible range.

    Args:
        path: path of the field, from what varies: the path in ``choice`` with the way to its design before it.
        choice: plausible range of the field.
    """
    above = None
    if choice.above is not None:
        above = path.removesuffix(choice.field) + choice.above[0], choice.above[1]
    return Vary(field=path, low=choice.low, high=choice.high, above=above)


def _whole_value(vary: Vary, share: float) -> int:
    """Return the integer below which a fraction of the values of a field lies."""
    if vary.mean is not None or vary.scale == "log":
        return round(value_of(vary, share))
    assert vary.low is not None
    assert vary.high is not None
    return int(min(vary.low + np.floor(share * (vary.high - vary.low + 1)), vary.high))


@lru_cache(maxsize=4)
def evenly(design: str, count: int, fields: int, seed: int) -> np.ndarray:
    """Return evenly spread points of the unit cube, shape (count, fields)."""
    if fields == 0:
        return np.empty((count, 0))
    if design == "latin":
        return np.asarray(qmc.LatinHypercube(fields, rng=np.random.default_rng(seed)).random(count))
    sobol = qmc.Sobol(fields, rng=np.random.default_rng(seed))
    return np.asarray(sobol.random_base2(max(count - 1, 0).bit_length())[:count])


def only_forbids(path: str) -> bool:
    """Return whether a field is a limit of a joint: it changes no motion, and whether it forbids one is counted apart.

    Args:
        path: path of the field, from the run or the experiment.
    """
    return "range[" in path
