"""The search itself: CMA-ES for one number, COMO-CMA-ES for a front of two; the same seed asks the same again.

A ``SearchResult`` holds all that it tried, the front, the best, and what was checked about them.
"""

import warnings
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
import xarray as xr

from suchus.core.errors import SuchusError
from suchus.experiments.optimise.aims import AIMS
from suchus.experiments.optimise.evaluate import ACTIVE, is_allowed, losses, relative_excess, units
from suchus.experiments.optimise.spec import Optimisation
from suchus.robot.design import value_at, with_values
from suchus.sim.land import Run

_EDGE = 0.02  # least distance of the start from the ends of its range [-], so that both sides can be searched


class NoOptimiser(SuchusError, ImportError):
    """A library that the search needs and that is not installed."""


class Strategy(Protocol):
    """Proposes candidates and receives their losses."""

    def ask(self) -> np.ndarray:
        """Return the next generation, shape (candidate, field), each from 0 to 1."""

    def tell(self, losses: np.ndarray) -> None:
        """Receive the losses of the last generation: one number for each candidate, or two for a front."""


def search(spec: Optimisation) -> Strategy:
    """Return the search that a spec asks for.

    Raises:
        NoOptimiser: its library is not installed.
    """
    return Front(spec) if spec.pareto else Single(spec)


class Single:
    """CMA-ES; after convergence it restarts from the same start with twice the population."""

    def __init__(self, spec: Optimisation) -> None:
        """Start CMA-ES at the start of the search.

        Raises:
            NoOptimiser: the library is not installed.
        """
        self._cma = library("cma")
        self._spec = spec
        self._randoms = np.random.default_rng(spec.seed)
        self._population = spec.population
        self._es = self._new_strategy()

    def _new_strategy(self) -> Any:
        """Return CMA-ES at the start of the search, with the present population."""
        return self._cma.CMAEvolutionStrategy(
            np.clip(self._spec.start, _EDGE, 1 - _EDGE),
            self._spec.sigma,
            _options(self._spec, self._population, self._randoms),
        )

    def ask(self) -> np.ndarray:
        """Return the next generation."""
        if self._es.stop():
            self._population *= 2
            self._es = self._new_strategy()
        self._candidates = self._es.ask()
        return np.clip(np.array(self._candidates), 0.0, 1.0)

    def tell(self, losses: np.ndarray) -> None:
        """Receive the losses of the last generation, shape (candidate,)."""
        self._es.tell(self._candidates, losses.tolist())


class Front:
    """COMO-CMA-ES: several searches, each of which makes the area that the front covers larger.

    Source: C. Toure, N. Hansen, A. Auger, D. Brockhoff, Uncrowded Hypervolume Improvement: COMO-CMA-ES and the
    Sofomore framework, GECCO 2019.
    """

    REFERENCE_LOSSES = (0.0, 2.0)
    """Reference losses of the hypervolume [-]: 0 where more is better, twice the start's value where less is."""

    def __init__(self, spec: Optimisation) -> None:
        """Start one CMA-ES for each point of the front, spread around the start of the search.

        Raises:
            NoOptimiser: the library is not installed.
        """
        como = library("comocma")
        randoms = np.random.default_rng(spec.seed)
        start = np.clip(spec.start, _EDGE, 1 - _EDGE)
        spread = np.clip(
            start + 0.5 * spec.sigma * randoms.standard_normal((spec.points, len(start))), _EDGE, 1 - _EDGE
        )
        spread[0] = start
        kernels = como.get_cmas([list(x) for x in spread], spec.sigma, _options(spec, spec.population, randoms))
        self._search = como.Sofomore(kernels, reference_of(spec), {"update_order": _in_order, "archive": False})

    def ask(self) -> np.ndarray:
        """Return the next generation of all points."""
        self._candidates = self._search.ask("all")
        return np.clip(np.array(self._candidates), 0.0, 1.0)

    def tell(self, losses: np.ndarray) -> None:
        """Receive the losses of the last generation, shape (candidate, 2)."""
        self._search.tell(self._candidates, losses.tolist())


def reference_of(spec: Optimisation) -> list[float]:
    """Return the reference point of the hypervolume, a loss for each aim."""
    return [
        Front.REFERENCE_LOSSES[0] if AIMS[aim.name].good == "more" else Front.REFERENCE_LOSSES[1] for aim in spec.aims
    ]


def _in_order(kernel: int) -> int:
    return kernel


def _options(spec: Optimisation, population: int, randoms: np.random.Generator) -> dict[str, Any]:
    """Return the settings of CMA-ES: bounds, population, tolerances, and our own generator of random numbers.

    Args:
        spec: the search.
        population: candidates of a generation [-].
        randoms: generator of random numbers.
    """
    single_field = (
        {"maxstd": np.inf} if len(spec.vary) == 1 else {}
    )  # cma 4.5 cannot bound the spread of a single field
    return single_field | {
        "bounds": [0.0, 1.0],
        "popsize": population,
        "randn": lambda *shape: randoms.standard_normal(shape),
        "seed": float("nan"),
        "verbose": -9,
        "tolfun": 1e-4,
        "tolx": 1e-4,
    }


def library(name: str) -> Any:
    """Return a library of the extra ``optimise``.

    Raises:
        NoOptimiser: it is not installed.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return __import__(name)
    except ImportError as error:
        raise NoOptimiser(f"the search needs {name}; install it with: pip install 'suchus[optimise]'.") from error


_FRONT_SELECTION = 3  # points of a front whose gaits are written and checked: both ends and the middle


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchResult:
    """The result of the search in one condition."""

    spec: Optimisation
    """The search, of this condition alone."""
    start: xr.Dataset
    """Where it started, as ``evaluate`` returns it."""
    history: xr.Dataset
    """All candidates in order, the start first, with ``generation`` and ``score``."""
    checks: xr.Dataset | None = None
    """Aims and limits of the best under other conditions; see ``conduct.run_checks``."""
    neighbourhood: xr.Dataset | None = None
    """Candidates around the best; see ``conduct.vary_around_best``."""

    @property
    def arm(self) -> str:
        """Name of the condition."""
        return self.spec.arms[0].name

    @property
    def front(self) -> list[int]:
        """The candidates that no other allowed one betters in both aims, by the first aim."""
        return front_of(self.spec, self.history, units(self.spec, self.start))

    @property
    def chosen_indices(self) -> list[int]:
        """The best candidate; of a front both ends and the middle; empty if none keeps all limits."""
        if self.spec.pareto:
            front = self.front
            picked = (
                [round(i * (len(front) - 1) / (_FRONT_SELECTION - 1)) for i in range(_FRONT_SELECTION)] if front else []
            )
            return [front[i] for i in dict.fromkeys(picked)]
        allowed_indices = np.flatnonzero(is_allowed(self.spec, self.history))
        return (
            [int(allowed_indices[self.history.score.values[allowed_indices].argmin()])] if allowed_indices.size else []
        )

    @property
    def range_fractions(self) -> list[np.ndarray]:
        """Fractions of the ranges at the chosen candidates, each of shape (field,) [-]."""
        return [self.history.share.values[i] for i in self.chosen_indices]

    @property
    def names(self) -> list[str]:
        """Names of the chosen candidates: the arm, numbered if there are several."""
        several = len(self.chosen_indices) > 1
        return [f"{self.arm}_{i + 1}" if several else self.arm for i in range(len(self.chosen_indices))]

    @property
    def runs(self) -> list[Run]:
        """The chosen, their gaits called after search and condition."""
        return [
            titled(self.spec, self.spec.candidate(dict(zip(self.fields, share.tolist(), strict=True))), name)
            for share, name in zip(self.range_fractions, self.names, strict=True)
        ]

    @property
    def fields(self) -> list[str]:
        """Dotted paths of the fields that varied."""
        return [v.field for v in self.spec.vary]

    def values(self, index: int) -> dict[str, tuple[float, float]]:
        """Return by field the value of the start and that of a chosen candidate."""
        run = self.runs[index]
        return {f: (float(value_at(self.spec.run, f)), float(value_at(run, f))) for f in self.fields}

    def active(self, index: int) -> dict[str, tuple[float, float, bool]]:
        """Return by limit its value, the value of a chosen candidate, and whether the limit is active."""
        limits = {}
        for limit in self.spec.limits:
            has = float(self.history[f"limit_{limit.name}"][self.chosen_indices[index]])
            limits[limit.name] = (limit.value, has, bool(relative_excess(limit, np.array([has]))[0] > -ACTIVE))
        return limits

    def best_so_far(self) -> np.ndarray:
        """Return after each candidate the value of the first aim of the best so far, NaN before there is one."""
        allowed = is_allowed(self.spec, self.history)
        score = np.where(allowed, self.history.score.values, np.inf)
        best_index = np.array([int(score[: i + 1].argmin()) for i in range(len(score))])
        values = self.history[f"aim_{self.spec.aims[0].name}"].values[best_index]
        return np.where(np.isfinite(score[best_index]), values, np.nan)

    def covered_areas(self) -> np.ndarray:
        """Return after each generation the area that the front covers, in parts of the start's aims."""
        table, parts = self.history, units(self.spec, self.start)
        loss, allowed = losses(self.spec, table, parts), is_allowed(self.spec, table)
        archive, areas = library("moarchiving").get_mo_archive([], reference_point=reference_of(self.spec), n_obj=2), []
        for number in range(int(table.generation.max()) + 1):
            for i in np.flatnonzero((table.generation.values == number) & allowed):
                archive.add(loss[i].tolist())
            areas.append(float(archive.hypervolume))
        return np.array(areas)

    def with_checks(self, checks: xr.Dataset, neighbourhood: xr.Dataset) -> "SearchResult":
        """Return the same with what was checked."""
        return replace(self, checks=checks, neighbourhood=neighbourhood)


def titled(spec: Optimisation, run: Run, name: str) -> Run:
    """Return a run whose gait, and robot if it varies, is called after search and condition."""
    full_name = f"{spec.name}_{name}"
    varies_robot = any(v.field.startswith("robot.") for v in spec.vary)
    robot = with_values(run.robot, {"name": full_name}) if varies_robot else run.robot
    return replace(run, gait=replace(run.gait, name=full_name), robot=robot, label=name)


def front_of(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> list[int]:
    """Return the allowed candidates that no other betters in both aims, by the first aim; all aims of a sum as one."""
    allowed_indices = [int(i) for i in np.flatnonzero(is_allowed(spec, table))]
    if not allowed_indices or len(spec.aims) != 2:
        return []
    points = losses(spec, table, parts)[allowed_indices]
    archive = library("moarchiving").get_mo_archive(
        points.tolist(), reference_point=reference_of(spec), infos=allowed_indices, n_obj=2
    )
    return [int(i) for i in archive.infos]
