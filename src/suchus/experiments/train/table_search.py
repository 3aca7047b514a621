"""The baseline: a table of gait parameters over commands, found by CMA-ES.

All candidates of all searches are kept with the speed and the turning rate that they reach. Each command of the table
takes the best of them; straight ahead the odd parameters, which steer, are zero. A first search looks for the greatest
speed, a second one for the greatest turning rate. Then each command has a search of its own, which begins at the best
candidate so far.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.experiments.optimise.search import library
from suchus.experiments.train.spec import Training
from suchus.robot.control.policy import ACTIONS, Policy

POPULATION = 8
"""Candidates of a generation [-]."""
EXPLORATION = 5
"""Generations of each of the two searches for the greatest speed and turning rate [-]."""
SPEED_FRACTIONS = (0.0, 1 / 3, 2 / 3, 1.0)
"""Commanded speeds of the table, over the greatest one [-]."""
TURN_FRACTIONS = (0.0, 0.5, 1.0)
"""Commanded turning rates of the table, over the greatest one [-]."""
_REACHED = 0.95  # part of the greatest speed that was reached, which is commanded at most
_TURN_REACHED = 0.8  # the same of the turning rate
_DISTANCE_WEIGHT = 0.003  # of the mean squared distance from neutral parameters, in widths of their ranges
_SPEED_EXCESS_WEIGHT = 0.2  # of the squared excess of the servos' commanded speed, over the speed itself
_MIN_SPEED_FRACTION = 0.15  # of the greatest speed; slower turns on the spot are not looked for at first


class TableSearch:
    """The searches for a table, one generation after the other; the same seed and results ask the same again.

    Args:
        training: the training.
    """

    def __init__(self, training: Training) -> None:
        """Begin with the search for the greatest speed.

        Raises:
            NoOptimiser: the library is not installed.
        """
        self._training, self._cma = training, library("cma")
        self._random = np.random.default_rng([training.seed, 0])
        self.names = tuple(training.bounds)
        self._lower_bounds, self._upper_bounds = np.array(list(training.bounds.values())).T
        neutral = np.array([ACTIONS[name].neutral for name in self.names])
        width = self._upper_bounds - self._lower_bounds
        self._is_odd = np.array([ACTIONS[name].is_odd for name in self.names])
        self._straight = np.where(self._is_odd, (0.0 - self._lower_bounds) / width, 0.0)
        self._neutral = np.clip((neutral - self._lower_bounds) / width, 0.02, 0.98)
        self._archive_points = np.zeros((0, len(self.names)))
        self._archive_speed, self._archive_turn = np.zeros(0), np.zeros(0)
        self.max_speed = training.speed or 0.0
        self.max_turn = training.turn or 0.0
        self.generation = 0
        self._strategy: Any = self._new_strategy(self._neutral, 0.25)
        self._strategies: dict[int, Any] = {}
        self._nodes = self._all_nodes()

    @staticmethod
    def _all_nodes() -> list[tuple[int, int]]:
        """Return the commands that have a search, slow turns on the spot last; standing still needs none."""
        nodes = [(i, j) for i in range(len(SPEED_FRACTIONS)) for j in range(len(TURN_FRACTIONS))]
        return sorted((node for node in nodes if node != (0, 0)), key=lambda node: (node[0] == 0, node[1], node[0]))

    @property
    def stage(self) -> str:
        """What is searched for in this generation."""
        if self.generation < EXPLORATION:
            return "greatest speed"
        if self.generation < 2 * EXPLORATION:
            return "greatest turning rate"
        speed, turn = self._command(self._node)
        return f"{speed:.3g} m/s, {turn:.3g} rad/s"

    @property
    def complete_generations(self) -> int:
        """Generations after which each command had a search of two generations."""
        return 2 * EXPLORATION + 2 * len(self._nodes)

    @property
    def _is_straight(self) -> bool:
        """Whether the candidates of this generation walk straight ahead."""
        searches_speed = self.generation < EXPLORATION
        return searches_speed or (self.generation >= 2 * EXPLORATION and self._node[1] == 0)

    @property
    def _node(self) -> tuple[int, int]:
        return self._nodes[(self.generation - 2 * EXPLORATION) % len(self._nodes)]

    def _command(self, node: tuple[int, int]) -> tuple[float, float]:
        """Return speed [m/s] and turning rate [rad/s] of a command of the table."""
        return SPEED_FRACTIONS[node[0]] * self.max_speed, TURN_FRACTIONS[node[1]] * self.max_turn

    def _new_strategy(self, start: np.ndarray, sigma: float) -> Any:
        """Return CMA-ES from a start, in fractions of the ranges."""
        return self._cma.CMAEvolutionStrategy(
            np.clip(start, 0.02, 0.98),
            sigma,
            {
                "bounds": [0.0, 1.0],
                "popsize": POPULATION,
                "randn": lambda *shape: self._random.standard_normal(shape),
                "seed": float("nan"),
                "verbose": -9,
            },
        )

    def ask(self) -> Float[np.ndarray, "candidate parameter"]:
        """Return the parameters of the next generation."""
        if self.generation == EXPLORATION:
            self._strategy = self._new_strategy(self._turning_start(), 0.25)
        elif self.generation >= 2 * EXPLORATION:
            number = self._nodes.index(self._node)
            if number not in self._strategies:
                self._strategies[number] = self._new_strategy(self._archive_points[self._best(self._node)], 0.12)
            self._strategy = self._strategies[number]
        self._candidates = self._strategy.ask()
        self._points = np.clip(np.array(self._candidates), 0.0, 1.0)
        if self._is_straight:
            self._points[:, self._is_odd] = self._straight[self._is_odd]
        return self._lower_bounds + self._points * (self._upper_bounds - self._lower_bounds)

    def _turning_start(self) -> np.ndarray:
        """Return where the search for the greatest turning rate begins: unequal strokes, and a bend to the left."""
        start = self._neutral.copy()
        for name, value in (("asymmetry", 0.6), ("bend", 0.3), ("tail", -0.2)):
            if name in self.names:
                i = self.names.index(name)
                start[i] = (value - self._lower_bounds[i]) / (self._upper_bounds[i] - self._lower_bounds[i])
        return np.clip(start, 0.02, 0.98)

    def tell(self, speed: np.ndarray, turn: np.ndarray) -> None:
        """Receive what the candidates of the last generation reached.

        Args:
            speed: speed of each candidate; NaN for one that fell over, shape (candidate,) [m/s].
            turn: turning rate of each candidate, shape (candidate,) [rad/s].
        """
        self._archive_points = np.vstack([self._archive_points, self._points])
        self._archive_speed = np.append(self._archive_speed, speed)
        self._archive_turn = np.append(self._archive_turn, turn)
        self._strategy.tell(self._candidates, self._losses(self._points, speed, turn).tolist())
        self.generation += 1
        has_fallen = np.isnan(self._archive_speed)
        if self.generation == EXPLORATION and self._training.speed is None:
            reached = np.where(has_fallen, 0.0, self._archive_speed).max()
            self.max_speed = _rounded(_REACHED * max(float(reached), 1e-3 * self._training.robot.length))
        if self.generation == 2 * EXPLORATION and self._training.turn is None:
            is_walking = ~has_fallen & (self._archive_speed > _MIN_SPEED_FRACTION * self.max_speed)
            reached = np.where(is_walking, self._archive_turn, 0.0).max()
            self.max_turn = _rounded(_TURN_REACHED * max(float(reached), 1e-2))

    def _losses(self, points: np.ndarray, speed: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Return the losses of candidates in the present search."""
        if self.generation < EXPLORATION:
            losses = self._distance(points) - speed / self._training.robot.length
        elif self.generation < 2 * EXPLORATION:
            losses = -turn + self._distance(points)
            losses = losses + np.maximum(_MIN_SPEED_FRACTION - speed / max(self.max_speed, 1e-9), 0.0)
        else:
            losses = self._node_losses(self._node, points, speed, turn)
        return np.asarray(np.where(np.isnan(speed), 10.0, losses))

    def _distance(self, points: np.ndarray) -> np.ndarray:
        """Return a small penalty on the distance from neutral parameters, so that the table is smooth.

        Parameters with which servos would be commanded faster than they turn are punished too: longer strokes need as
        much more speed as higher rates.
        """
        values = dict(
            zip(
                self.names,
                (self._lower_bounds + points * (self._upper_bounds - self._lower_bounds)).T,
                strict=True,
            )
        )
        stroke = values.get("stroke", np.ones(len(points))) * (1.0 + np.abs(values.get("asymmetry", 0.0)))
        max_rate = self._upper_bounds[self.names.index("rate")]
        excess = np.maximum(values["rate"] * np.maximum(stroke, 1.0) / max_rate - 1.0, 0.0)
        distance = ((points - self._neutral) ** 2).mean(axis=1)
        return np.asarray(_DISTANCE_WEIGHT * distance + _SPEED_EXCESS_WEIGHT * excess**2)

    def _node_losses(
        self, node: tuple[int, int], points: np.ndarray, speed: np.ndarray, turn: np.ndarray
    ) -> np.ndarray:
        """Return how far candidates are from a command of the table."""
        target_speed, target_turn = self._command(node)
        errors = ((speed - target_speed) / self.max_speed) ** 2 + ((turn - target_turn) / self.max_turn) ** 2
        return np.asarray(errors + self._distance(points))

    def _best(self, node: tuple[int, int]) -> int:
        """Return the candidate of all searches that is nearest to a command of the table."""
        return int(np.nanargmin(self._archive_losses(node)))

    def _archive_losses(self, node: tuple[int, int]) -> np.ndarray:
        """Return how far all candidates are from a command; those that steer do not count straight ahead."""
        losses = self._node_losses(node, self._archive_points, self._archive_speed, self._archive_turn)
        steers = (self._archive_points != self._straight)[:, self._is_odd].any(axis=1)
        return np.where(steers, np.nan, losses) if node[1] == 0 else losses

    def _rows(self) -> Iterator[tuple[tuple[float, ...], ...]]:
        """Yield the parameters of each speed, in them those of each turning rate."""
        width = self._upper_bounds - self._lower_bounds
        for i in range(len(SPEED_FRACTIONS)):
            row = []
            for j in range(len(TURN_FRACTIONS)):
                is_still = (i, j) == (0, 0)
                values = self._lower_bounds + self._archive_points[self._best((1, 0) if is_still else (i, j))] * width
                if is_still:
                    values[self.names.index("rate")] = 0.0
                row.append(tuple(_rounded(value) for value in values.tolist()))
            yield tuple(row)

    def policy(self) -> Policy:
        """Return the policy of the best table so far; the greatest speed and turning rate must be known."""
        speeds = tuple(_rounded(fraction * self.max_speed) for fraction in SPEED_FRACTIONS)
        turns = tuple(_rounded(fraction * self.max_turn) for fraction in TURN_FRACTIONS)
        return self._training.policy(speeds, turns, self.names, tuple(self._rows()))

    def table_loss(self) -> float:
        """Return the mean loss of the commands of the table in the search [-]."""
        return float(np.mean([np.nanmin(self._archive_losses(node)) for node in self._nodes]))


def _rounded(value: float) -> float:
    return float(f"{value:.6g}")
