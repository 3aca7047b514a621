"""Confidence intervals that hold for few repeats: of a fraction and of a median, without assumptions about a shape.

They hold for sequential sampling too, which ends once the answer is known: see ``planned_looks``.
"""

from typing import Any, Literal

import numpy as np
from scipy.special import bdtr, betaincinv, ndtri

CONFIDENCE = 0.95
"""Least probability with which an interval contains the true value [-]."""


def planned_looks(count: int, looks: int = 2) -> tuple[int, ...]:
    """Return the numbers of repeats after which sequential sampling may end: half of them, and all.

    Each further look comes before these, after half as many repeats. After each look the intervals of
    ``look_confidence`` say whether the answer is known. Few repeats have fewer looks, one repeat has one.

    Args:
        count: greatest number of repeats, at least 1 [-].
        looks: greatest number of looks, at least 1 [-].
    """
    return tuple(sorted({-(-count // 2**halvings) for halvings in range(looks)}))


def look_confidence(looks: int) -> float:
    """Return the confidence of the intervals after each of several planned looks [-].

    The intervals of all looks together contain the true value with a probability of at least ``CONFIDENCE``, so that
    the rule by which sampling ends does not matter: the errors of the looks add up to 5 % at most (Bonferroni).

    Args:
        looks: number of looks that were planned, whether or not sampling ended before the last [-].
    """
    return 1.0 - (1.0 - CONFIDENCE) / looks


def fraction_interval(
    successes: int, trials: int, *, method: Literal["exact", "wilson"] = "exact", confidence: float = CONFIDENCE
) -> tuple[float, float]:
    """Return a confidence interval of a fraction [-]; NaN without a trial.

    The exact interval contains the true fraction at least as often as ``confidence`` says, for each fraction and number
    of trials. That of Wilson is narrower and does so on average over the fractions.

    Args:
        successes: number of trials in which the event occurred, 0 to ``trials``.
        trials: number of independent trials.
        method: exact (Clopper and Pearson), or Wilson's.
        confidence: least probability of coverage, above 0 and below 1 [-].

    Source: C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404; E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.
    """
    if trials == 0:
        return float("nan"), float("nan")
    tail = 0.5 * (1.0 - confidence)
    if method == "wilson":
        z2 = float(ndtri(tail)) ** 2
        center = (successes + 0.5 * z2) / (trials + z2)
        half_width = np.sqrt(z2 * (successes * (trials - successes) / trials + 0.25 * z2)) / (trials + z2)
        return float(max(center - half_width, 0.0)), float(min(center + half_width, 1.0))
    failures = trials - successes
    lower_bound = float(betaincinv(successes, failures + 1, tail)) if successes else 0.0
    upper_bound = float(betaincinv(successes + 1, failures, 1.0 - tail)) if failures else 1.0
    return lower_bound, upper_bound


def median_interval(values: Any, *, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return a confidence interval of the median of the population, between two of the sorted values.

    It contains the median at least as often as ``confidence`` says, whatever the distribution. It is NaN, which is
    unknown, where there are fewer than ``min_median_count`` values, or where one of them is not finite.

    Args:
        values: independent values.
        confidence: least probability of coverage, above 0 and below 1 [-].

    Source: W. R. Thompson, Ann. Math. Stat. 7 (1936) 122.
    """
    sorted_values = np.sort(np.asarray(values, float).ravel())
    count = sorted_values.size
    if count < min_median_count(confidence) or not np.isfinite(sorted_values).all():
        return float("nan"), float("nan")
    ranks = np.arange(count // 2)
    excluded = int((2.0 * bdtr(ranks, count, 0.5) <= 1.0 - confidence).sum())  # values left out at either end, plus one
    return float(sorted_values[excluded - 1]), float(sorted_values[count - excluded])


def min_median_count(confidence: float = CONFIDENCE) -> int:
    """Return the least number of values whose range is a confidence interval of the median: 6 at 95 %."""
    return max(2, int(np.ceil(1.0 - np.log2(1.0 - confidence) - 1e-9)))
