"""An evolution strategy on the weights of a network that corrects the table."""

from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.experiments.optimise.search import library
from suchus.experiments.train.evaluate import layer_sizes, weight_count
from suchus.experiments.train.spec import Training

POPULATION = 12
"""Networks of a generation, besides the mean of the search [-]."""
EPISODES = 2
"""Episodes that each network of a generation plays [-]."""
_SIGMA = 0.15  # standard deviation of the weights at first [-]


class NetworkSearch:
    """CMA-ES with a diagonal covariance, from a network that corrects nothing; the last network asked for is its mean.

    Source: R. Ros, N. Hansen, A simple modification in CMA-ES achieving linear time and space complexity, PPSN 2008.

    Args:
        training: the training.
    """

    def __init__(self, training: Training) -> None:
        """Begin at zero output weights; those of a hidden layer are drawn.

        Raises:
            NoOptimiser: the library is not installed.
        """
        random = np.random.default_rng([training.seed, 2])
        start = np.zeros(weight_count(training))
        if training.hidden:
            inputs, outputs = layer_sizes(training)[0]
            start[: inputs * outputs] = random.standard_normal(inputs * outputs) / np.sqrt(inputs)
        self._strategy: Any = library("cma").CMAEvolutionStrategy(
            start,
            _SIGMA,
            {
                "CMA_diagonal": True,
                "popsize": POPULATION,
                "randn": lambda *shape: random.standard_normal(shape),
                "seed": float("nan"),
                "verbose": -9,
            },
        )
        self.generation = 0

    @property
    def mean(self) -> Float[np.ndarray, " weight"]:
        """Mean of the search: the network that it believes in."""
        return np.array(self._strategy.mean)

    def ask(self) -> Float[np.ndarray, "network weight"]:
        """Return the networks of the next generation, the mean of the search last."""
        self._candidates = self._strategy.ask()
        return np.vstack([np.array(self._candidates), self.mean])

    def tell(self, losses: np.ndarray) -> None:
        """Receive the losses of the last generation, that of the mean last, shape (network,) [-]."""
        self._strategy.tell(self._candidates, losses[:-1].tolist())
        self.generation += 1
