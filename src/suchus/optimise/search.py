"""The search itself: CMA-ES for one number, COMO-CMA-ES for a front of two; the same seed asks the same again."""

import warnings
from typing import Any, Protocol

import numpy as np

from suchus.errors import SuchusError
from suchus.optimise.aims import AIMS
from suchus.optimise.spec import Optimisation

_EDGE = 0.02  # how far inside its range a start is moved, where the search could not look to both sides


class NoOptimiser(SuchusError, ImportError):
    """A library that the search needs and that is not installed."""


class Strategy(Protocol):
    """Asks for candidates and receives their losses."""

    def ask(self) -> np.ndarray:
        """Return the next generation, shape (candidate, field), each from 0 to 1."""

    def tell(self, losses: np.ndarray) -> None:
        """Tell the losses of what was asked for: one number each, or two for a front."""


def search(spec: Optimisation) -> Strategy:
    """Return the search that a spec asks for.

    Raises:
        NoOptimiser: its library is not installed.
    """
    return Front(spec) if spec.pareto else Single(spec)


class Single:
    """CMA-ES; when it has converged it starts again from where it began, with twice as many candidates."""

    def __init__(self, spec: Optimisation) -> None:
        self._cma = library("cma")
        self._spec = spec
        self._randoms = np.random.default_rng(spec.seed)
        self._population = spec.population
        self._es = self._begun()

    def _begun(self) -> Any:
        return self._cma.CMAEvolutionStrategy(
            np.clip(self._spec.start, _EDGE, 1 - _EDGE),
            self._spec.sigma,
            _options(self._spec, self._population, self._randoms),
        )

    def ask(self) -> np.ndarray:
        """Return the next generation."""
        if self._es.stop():
            self._population *= 2
            self._es = self._begun()
        self._asked = self._es.ask()
        return np.clip(np.array(self._asked), 0.0, 1.0)

    def tell(self, losses: np.ndarray) -> None:
        """Tell one loss for each."""
        self._es.tell(self._asked, losses.tolist())


class Front:
    """COMO-CMA-ES: several searches, each of which makes the area that the front covers larger.

    Source: C. Toure, N. Hansen, A. Auger, D. Brockhoff, Uncrowded Hypervolume Improvement: COMO-CMA-ES and the
    Sofomore framework, GECCO 2019.
    """

    WORST = (0.0, 2.0)
    """What no front reaches: nothing of an aim where more is better, twice the start's where less is [-]."""

    def __init__(self, spec: Optimisation) -> None:
        como = library("comocma")
        randoms = np.random.default_rng(spec.seed)
        first = np.clip(spec.start, _EDGE, 1 - _EDGE)
        spread = np.clip(
            first + 0.5 * spec.sigma * randoms.standard_normal((spec.points, len(first))), _EDGE, 1 - _EDGE
        )
        spread[0] = first
        kernels = como.get_cmas([list(x) for x in spread], spec.sigma, _options(spec, spec.population, randoms))
        self._search = como.Sofomore(kernels, reference_of(spec), {"update_order": _in_order, "archive": False})

    def ask(self) -> np.ndarray:
        """Return the next generation of all points."""
        self._asked = self._search.ask("all")
        return np.clip(np.array(self._asked), 0.0, 1.0)

    def tell(self, losses: np.ndarray) -> None:
        """Tell two losses for each."""
        self._search.tell(self._asked, losses.tolist())


def reference_of(spec: Optimisation) -> list[float]:
    """Return the losses that a front is measured from."""
    return [Front.WORST[0] if AIMS[aim.name].good == "more" else Front.WORST[1] for aim in spec.aims]


def _in_order(kernel: int) -> int:
    return kernel


def _options(spec: Optimisation, population: int, randoms: np.random.Generator) -> dict[str, Any]:
    """Return settings of CMA-ES: within the cube, silent, and drawing from a generator of our own."""
    alone = {"maxstd": np.inf} if len(spec.vary) == 1 else {}  # cma 4.5 cannot bound the spread of a single field
    return alone | {
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
