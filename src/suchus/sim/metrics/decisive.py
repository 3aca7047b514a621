"""Which parameters decide: rank correlations, and the decision boundary between true and false."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy import stats

MAX_CHANCE = 0.01
"""Greatest probability by chance of the best separation among all parameters that counts as decisive [-]."""
_MIN_SAMPLES = 5  # samples on one side; fewer say nothing about a border


class DecisionBoundary(NamedTuple):
    """The value of one parameter that best predicts where a statement holds."""

    parameter: int
    """Index of the parameter, from 0 [-]."""
    threshold: float
    """Its value there, in the parameter's unit."""
    holds_above: bool
    """Whether the statement rather holds above."""
    separation: float
    """Share of the samples where it holds, less that where it does not, on the side where it rather holds [-].

    The statistic of Kolmogorov and Smirnov: 1 if the boundary predicts every design, 0 if none.
    """
    chance: float
    """How probable so great a separation of this parameter is by chance [-]."""


def rank_correlation(
    parameters: Float[np.ndarray, "sample parameter"], quantity: Float[np.ndarray, " sample"]
) -> tuple[Float[np.ndarray, " parameter"], Float[np.ndarray, " parameter"]]:
    """Return Spearman's rank correlation of each parameter with a quantity, and how probable it is by chance.

    Samples without the quantity (NaN) are left out; a quantity that never changes correlates with nothing.
    """
    is_finite = np.isfinite(quantity)
    number = parameters.shape[1]
    if is_finite.sum() < 3 or np.ptp(quantity[is_finite]) == 0.0:
        return np.zeros(number), np.ones(number)
    ranks = stats.rankdata(parameters[is_finite], axis=0)
    correlation = stats.pearsonr(ranks, stats.rankdata(quantity[is_finite])[:, None], axis=0)
    return np.asarray(correlation.statistic), np.asarray(correlation.pvalue)


def border(
    parameters: Float[np.ndarray, "sample parameter"], holds: Bool[np.ndarray, " sample"]
) -> DecisionBoundary | None:
    """Return the boundary that best predicts where a statement holds.

    None where it nearly always or never holds, and where the best of so many parameters would separate as well by
    chance once in a hundred times.
    """
    if min(int(holds.sum()), int((~holds).sum())) < _MIN_SAMPLES:
        return None
    tests = [stats.ks_2samp(column[holds], column[~holds], method="asymp") for column in parameters.T]
    best = int(np.argmax([test.statistic for test in tests]))
    best_test = tests[best]
    if float(best_test.pvalue) * len(tests) > MAX_CHANCE:
        return None
    # the sign is positive where more of the first sample lies below the location
    return DecisionBoundary(
        best,
        float(best_test.statistic_location),
        best_test.statistic_sign < 0,
        float(best_test.statistic),
        float(best_test.pvalue),
    )
