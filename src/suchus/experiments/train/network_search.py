"""An evolution strategy on the weights of a network that corrects the table."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Int

from suchus.experiments.optimise.search import library
from suchus.experiments.train.evaluate import layer_sizes, weight_count
from suchus.experiments.train.spec import Training
from suchus.robot.control.observation import observation_layout
from suchus.robot.control.policy import ACTIONS
from suchus.robot.design import layout

POPULATION = 12
"""Networks of a generation, besides the mean of the search [-]."""
EPISODES = 2
"""Episodes that each network of a generation plays [-]."""
LOOP_GENERATIONS = 6
"""Generations of the first stage, which searches the answers to the error of the heading and to failures [-]."""
LOOP_EPISODES = 6
"""Episodes that each network plays in the first stage [-]."""
FAILURE_ACTIONS = ("rate", "stroke", "limb_lowering")
"""Parameters that answer to a failure in the first stage, alike for each servo and each limb."""
_SIGMA, _HEADING_SIGMA, _FAILURE_SIGMA = 0.02, 2.0, 0.5  # standard deviations of weights at first [-]


class LoopWeights(NamedTuple):
    """Weights of a network that the first stage sets to one number."""

    indices: Int[np.ndarray, " weight"]
    """Their indices among all weights."""
    sigma: float
    """Standard deviation of the number at first [-]."""


def loop_weights(training: Training) -> list[LoopWeights]:
    """Return the weights of the first stage: one entry for each number that it searches.

    Each parameter that steers has one, its answer to the error of the heading. Of a network with a hidden layer that is
    an output weight of the first unit, which reads that error alone. Where the network reads failures and has no hidden
    layer, each of ``FAILURE_ACTIONS`` has one too.

    Args:
        training: the training, which says the readings, the actions and the hidden layer.
    """
    limbs = len(layout(training.robot).limbs)
    columns = [name for name in training.actions for _ in range(limbs if ACTIONS[name].per_limb else 1)]
    inputs, units = layer_sizes(training)[0]
    row_start = (inputs + 1) * units if training.hidden else heading_column(training) * len(columns)
    groups = [
        LoopWeights(np.array([row_start + column]), _HEADING_SIGMA)
        for column, name in enumerate(columns)
        if ACTIONS[name].is_odd
    ]
    senses = {sense.name: sense.columns for sense in observation_layout(training.robot, training.readings)}
    if training.hidden or "failure" not in senses:
        return groups
    rows = np.arange(senses["failure"].start, senses["failure"].stop)
    for action in FAILURE_ACTIONS:
        of_action = np.flatnonzero([name == action for name in columns])
        if of_action.size:
            indices = (rows[:, None] * len(columns) + of_action).ravel()
            groups.append(LoopWeights(indices, _FAILURE_SIGMA))
    return groups


def heading_column(training: Training) -> int:
    """Return the column of the observation that holds the error of the heading."""
    (sense,) = (s for s in observation_layout(training.robot, training.readings) if s.name == "heading_error")
    return int(sense.columns.start)


class NetworkSearch:
    """CMA-ES on the weights of a network that corrects nothing at first; the last network asked for is the mean.

    The first stage searches the few numbers of ``loop_weights``: a heading loop, and what a known failure changes. The
    second stage searches all weights from there, with a diagonal covariance. A robot with one parameter that steers, or
    none, has the second stage alone: CMA-ES needs two numbers.

    Source: R. Ros, N. Hansen, A simple modification in CMA-ES achieving linear time and space complexity, PPSN 2008.

    Args:
        training: the training.
    """

    def __init__(self, training: Training) -> None:
        """Begin at zero output weights; those of a hidden layer are drawn.

        Raises:
            NoOptimiser: the library is not installed.
        """
        self._random = np.random.default_rng([training.seed, 2])
        self._weights = np.zeros(weight_count(training))
        if training.hidden:
            inputs, units = layer_sizes(training)[0]
            hidden_weights = self._random.standard_normal((inputs, units)) / np.sqrt(inputs)
            hidden_weights[:, 0] = np.arange(inputs) == heading_column(training)
            self._weights[: inputs * units] = hidden_weights.ravel()
        self._loop = loop_weights(training)
        self._has_loop_stage = len(self._loop) > 1
        self.generation = 0
        if self._has_loop_stage:
            sigmas = [group.sigma for group in self._loop]
            self._strategy = self._new_strategy(np.zeros(len(sigmas)), 1.0, {"CMA_stds": sigmas})
        else:
            self._strategy = self._new_strategy(self._weights, _SIGMA, {"CMA_diagonal": True})

    def _new_strategy(self, start: np.ndarray, sigma: float, options: Mapping[str, Any]) -> Any:
        """Return CMA-ES from a start, with a standard deviation and further options."""
        common = {
            "popsize": POPULATION,
            "randn": lambda *shape: self._random.standard_normal(shape),
            "seed": float("nan"),
            "verbose": -9,
        }
        return library("cma").CMAEvolutionStrategy(start, sigma, {**common, **options})

    @property
    def _is_loop_stage(self) -> bool:
        """Whether the first stage is on."""
        return self._has_loop_stage and self.generation < LOOP_GENERATIONS

    @property
    def episode_count(self) -> int:
        """Number of episodes that each network of the next generation plays [-]."""
        return LOOP_EPISODES if self._is_loop_stage else EPISODES

    @property
    def mean(self) -> Float[np.ndarray, " weight"]:
        """Mean of the search: the network that it believes in."""
        return self._networks(np.array(self._strategy.mean)[None])[0]

    def _networks(self, rows: np.ndarray) -> Float[np.ndarray, "network weight"]:
        """Return all weights of networks from the numbers that the present stage searches, one row each."""
        if not self._is_loop_stage:
            return rows
        networks = np.tile(self._weights, (len(rows), 1))
        for number, group in enumerate(self._loop):
            networks[:, group.indices] = rows[:, number, None]
        return networks

    def ask(self) -> Float[np.ndarray, "network weight"]:
        """Return the networks of the next generation, the mean of the search last."""
        self._candidates = self._strategy.ask()
        return np.vstack([self._networks(np.array(self._candidates)), self.mean])

    def tell(self, losses: np.ndarray) -> None:
        """Receive the losses of the last generation, that of the mean last, shape (network,) [-]."""
        self._strategy.tell(self._candidates, losses[:-1].tolist())
        mean, was_loop_stage = self.mean, self._is_loop_stage
        self.generation += 1
        if was_loop_stage and not self._is_loop_stage:
            self._strategy = self._new_strategy(mean, _SIGMA, {"CMA_diagonal": True})
