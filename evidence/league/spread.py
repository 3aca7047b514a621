"""From what is not known to the interval of a prediction: numbers drawn from their ranges, and how answers spread."""

from collections.abc import Iterable, Sequence

import numpy as np
from jaxtyping import Float
from scipy.stats import qmc

from evidence.league.contestant import Contestant, Found, Interval, Numbers, Value
from suchus.core.errors import NotConverged

COVERED = 0.95
"""Share of the drawn answers that an interval covers [-]."""
LEAST = 0.8
"""Share of the draws that must give an answer for a rung to have an interval [-]."""
_SEED = 35
"""Of the draws [-]."""


def drawn(contestant: Contestant, count: int) -> list[Numbers]:
    """Return the most likely numbers, then ``count`` choices from their ranges, by a Latin hypercube.

    Each number is drawn evenly from its range, all independently of each other.

    Args:
        contestant: whose numbers.
        count: choices beside the most likely one [-].
    """
    unknown = [name for name, number in contestant.inputs.items() if number.high > number.low]
    choices: list[Numbers] = [contestant.likely]
    if not (unknown and count):
        return choices
    shares = qmc.LatinHypercube(d=len(unknown), rng=np.random.default_rng(_SEED)).random(count)
    for row in shares:
        ranges = [(contestant.inputs[name].low, contestant.inputs[name].high) for name in unknown]
        some = {
            name: float(low + share * (high - low))
            for name, share, (low, high) in zip(unknown, row, ranges, strict=True)
        }
        choices.append(contestant.likely | some)
    return choices


def of_draws(name: str, answers: Sequence[Found]) -> Interval | None:
    """Return a quantity with the interval that covers ``COVERED`` of its answers; None where the first one lacks it.

    The first answer, with the most likely numbers, is the value; the interval is widened to it if need be.

    Raises:
        NotConverged: too few of the draws gave an answer.
    """
    if name not in answers[0]:
        return None
    rows = _rows(name, answers)
    sound = rows[np.isfinite(rows).all(axis=1)]
    if len(sound) < LEAST * len(rows) or not np.isfinite(rows[0]).all():
        raise NotConverged(
            f"only {len(sound)} of {len(rows)} choices of the numbers gave a {name}; narrow the ranges of what "
            f"is given."
        )
    tail = (1.0 - COVERED) / 2.0
    low, high = np.quantile(sound, [tail, 1.0 - tail], axis=0)
    return _interval(rows[0], np.minimum(low, rows[0]), np.maximum(high, rows[0]))


def of_answers(name: str, answers: Sequence[Found], like: Interval | None) -> Interval | None:
    """Return a quantity of an expensive rung, the best answer first: all answers, widened as another rung's interval.

    Args:
        name: of the quantity.
        answers: each plausible.
        like: the interval of the rung that it takes after, or of another one; None where no other has any.

    Raises:
        NotConverged: a single answer, and no other rung to take an interval from.
    """
    if name not in answers[0]:
        return None
    rows = _rows(name, [answer for answer in answers if name in answer])
    if like is None and len(rows) < 2:
        raise NotConverged(f"one answer has no interval, and no other model gave a {name} whose it could take.")
    least, most = rows.min(axis=0), rows.max(axis=0)
    if like is not None:
        middle = np.atleast_1d(np.asarray(like.value, float))
        safe = np.where(np.abs(middle) > 0.0, middle, 1.0)
        down, up = np.atleast_1d(np.asarray(like.low)) / safe, np.atleast_1d(np.asarray(like.high)) / safe
        ends = np.stack([least * down, least * up, most * down, most * up])
        least, most = np.minimum(least, ends.min(axis=0)), np.maximum(most, ends.max(axis=0))
    return _interval(rows[0], least, most)


def widest(intervals: Iterable[Interval]) -> Interval | None:
    """Return the interval that is widest for the size of its value; None where there is none."""

    def width(one: Interval) -> float:
        low, value, high = (np.atleast_1d(np.asarray(end, float)) for end in (one.low, one.value, one.high))
        return float(np.max((high - low) / np.where(value == 0.0, 1.0, np.abs(value))))

    return max(intervals, key=width, default=None)


def _rows(name: str, answers: Sequence[Found]) -> Float[np.ndarray, "answer part"]:
    width = np.atleast_1d(np.asarray(answers[0][name], float)).shape[0]
    none = np.full(width, np.nan)
    return np.array([np.atleast_1d(np.asarray(answer.get(name, none), float)) for answer in answers])


def _interval(value: np.ndarray, low: np.ndarray, high: np.ndarray) -> Interval:
    return Interval(_plain(value), _plain(low), _plain(high))


def _plain(values: np.ndarray) -> Value:
    return float(values[0]) if len(values) == 1 else tuple(float(value) for value in values)
