"""Which parameters decide: rank correlations, and the decision boundary between true and false."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy import stats

SURE = 0.01
"""What counts as chance: how often the greatest of all parameters reaches as much without any reason [-]."""
_FEW = 5  # samples on one side; fewer say nothing about a border


class DecisionBoundary(NamedTuple):
    """The value of one parameter that best predicts where a statement holds."""

    parameter: int
    """Index of the parameter, from 0 [-]."""
    at: float
    """Its value there, in the parameter's unit."""
    above: bool
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
    there = np.isfinite(quantity)
    number = parameters.shape[1]
    if there.sum() < 3 or np.ptp(quantity[there]) == 0.0:
        return np.zeros(number), np.ones(number)
    ranks = stats.rankdata(parameters[there], axis=0)
    found = stats.pearsonr(ranks, stats.rankdata(quantity[there])[:, None], axis=0)
    return np.asarray(found.statistic), np.asarray(found.pvalue)


def border(
    parameters: Float[np.ndarray, "sample parameter"], holds: Bool[np.ndarray, " sample"]
) -> DecisionBoundary | None:
    """Return the boundary that best predicts where a statement holds.

    None where it nearly always or never holds, and where the best of so many parameters would separate as well by
    chance once in a hundred times.
    """
    if min(int(holds.sum()), int((~holds).sum())) < _FEW:
        return None
    found = [stats.ks_2samp(column[holds], column[~holds], method="asymp") for column in parameters.T]
    best = int(np.argmax([each.statistic for each in found]))
    one = found[best]
    if float(one.pvalue) * len(found) > SURE:
        return None
    # the sign is positive where more of the first sample lies below the location
    return DecisionBoundary(
        best, float(one.statistic_location), one.statistic_sign < 0, float(one.statistic), float(one.pvalue)
    )
