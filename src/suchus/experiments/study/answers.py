"""From the runs of many designs to what becomes of each claim of the article."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import stats

from suchus.experiments.study.claim_measures import asked_rules, held, measures_of
from suchus.sim.metrics.decisive import border, rank_correlation

_BINS, _RESAMPLED, _SURE = 8, 400, 0.95


class Index(NamedTuple):
    """How much of a quantity each parameter decides alone."""

    share: np.ndarray
    """Fraction of the variance of its ranks, shape (parameter,) [-]; chance alone gives about zero."""
    low: np.ndarray
    """Lower end of the 95 % interval [-]."""
    high: np.ndarray
    """Upper end [-]."""


def answers(record: xr.Dataset, least: float) -> xr.Dataset:
    """Return number and truth of each claim in every sample, and what decides.

    Args:
        record: see ``claim_measures.measures_of``, and ``value`` over ``sample`` and ``parameter``.
        least: an intact robot with spine and tail that gets no farther has nothing to lose [m].

    Raises:
        IncompatibleRecord: a rule needs a measure that the record lacks.
    """
    measures = measures_of(record, least)
    return answered({rule.claim: held(rule, measures) for rule in asked_rules()}, record.value.values)


def answered(found: Mapping[str, tuple[np.ndarray, np.ndarray]], parameters: np.ndarray) -> xr.Dataset:
    """Return number and truth of each claim in every sample, and what decides.

    Args:
        found: by claim its number in every sample, NaN where it cannot be judged, and whether its statement holds.
        parameters: values of what varies, shape (sample, parameter).
    """
    numbers, holds = (np.array(values) for values in zip(*found.values(), strict=True))
    there = np.isfinite(numbers)
    follows = [rank_correlation(parameters, each) for each in numbers]
    borders = [border(parameters[there[i]], holds[i][there[i]]) for i in range(len(found))]
    one = {"units": "1"}
    return xr.Dataset(
        {
            "number": (("claim", "sample"), numbers, one | {"long_name": "number of the claim"}),
            "holds": (("claim", "sample"), holds, one | {"long_name": "whether its statement holds"}),
            "correlation": (("claim", "parameter"), np.array([rho for rho, _ in follows]), one),
            "chance": (("claim", "parameter"), np.array([p for _, p in follows]), one),
            "border_of": ("claim", np.array([b.parameter if b else -1 for b in borders]), one),
            "border_at": ("claim", np.array([b.at if b else np.nan for b in borders]), one),
            "border_above": ("claim", np.array([bool(b and b.above) for b in borders]), one),
            "border_separation": ("claim", np.array([b.separation if b else np.nan for b in borders]), one),
        },
        coords={"claim": list(found)},
    )


def first_order(parameters: np.ndarray, quantity: np.ndarray, *, seed: int = 0) -> Index:
    """Return how much of a quantity each parameter decides alone, whether it rises with it or not.

    The first-order index of Sobol, estimated from any sample: the share of the variance that lies between the means of
    eight equally filled bins of the parameter, less what chance would put there. It is taken of the ranks of the
    quantity, so that a few wild values do not decide. The interval comes from resampling.

    Args:
        parameters: shape (sample, parameter).
        quantity: shape (sample,); samples without it (NaN) are left out.
        seed: of the resampling.

    Source: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, for the index; the correction for chance is
    that of the adjusted coefficient of determination.
    """
    there = np.isfinite(quantity)
    count = int(there.sum())
    nothing = np.zeros(parameters.shape[1])
    if count < 4 * _BINS or np.ptp(quantity[there]) == 0.0:
        return Index(nothing, nothing, nothing)
    ranks = stats.rankdata(quantity[there])
    drawn = np.random.default_rng(seed).multinomial(count, np.full(count, 1 / count), size=_RESAMPLED)
    weights = np.vstack([np.ones(count), drawn.astype(float)])
    found = np.array([_between(column, ranks, weights) for column in parameters[there].T])  # (parameter, resampled)
    spread = np.quantile(found[:, 1:], ((1 - _SURE) / 2, (1 + _SURE) / 2), axis=1)
    # a resampled sample holds some points twice, which looks like more variance between bins: take that bias away
    shift = found[:, 1:].mean(axis=1) - found[:, 0]
    return Index(found[:, 0], spread[0] - shift, spread[1] - shift)


def _between(column: np.ndarray, values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the adjusted share of the variance between bins, for every row of weights."""
    count = len(values)
    bins = (stats.rankdata(column, method="ordinal") - 1).astype(int) * _BINS // count
    member = np.eye(_BINS)[bins]
    filled = weights @ member
    sums = weights @ (member * values[:, None])
    total = weights.sum(axis=1)
    mean = weights @ values / total
    whole = weights @ values**2 / total - mean**2
    between = (np.where(filled > 0, sums**2 / np.maximum(filled, 1e-12), 0.0)).sum(axis=1) / total - mean**2
    share = np.divide(between, whole, out=np.zeros_like(whole), where=whole > 0)  # a resampled quantity may be constant
    return np.asarray(1.0 - (1.0 - share) * (count - 1) / (count - _BINS))


def share_interval(true: int, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a share, after Wilson [-]."""
    if count == 0:
        return float("nan"), float("nan")
    interval = stats.binomtest(true, count).proportion_ci(_SURE, method="wilson")
    return float(interval.low), float(interval.high)


class Agreement(NamedTuple):
    """How two answers about the same samples agree."""

    same: float
    """Share of the samples and claims that both can judge and judge alike [-]."""
    forward: float
    """Median difference of the displacement forward [m]."""
    wide: float
    """Its 95th percentile [m]."""
    shares: float
    """Greatest difference of a claim's share of truth [-]."""
    claim: str
    """Key of the claim whose share that is."""
    chance: float
    """How likely chance alone turns one of the claims so much more often one way than the other [-]."""


def agreement(one: xr.Dataset, other: xr.Dataset) -> Agreement:
    """Return how two answers about the same samples agree.

    That a claim's share moves is judged by the exact sign test on the samples whose truth turns, the least chance
    among the claims times their number (Bonferroni).

    Args:
        one: of ``answers``, merged with its record.
        other: the same, made otherwise.
    """
    both = np.isfinite(one.number.values) & np.isfinite(other.number.values)
    here, there = one.holds.values.astype(bool), other.holds.values.astype(bool)
    off = abs(one.displacement_x.values - other.displacement_x.values)
    gained, lost = (here & ~there & both).sum(axis=1), (there & ~here & both).sum(axis=1)
    apart = abs(gained - lost) / np.maximum(both.sum(axis=1), 1)
    chances = [
        float(stats.binomtest(int(g), int(g + n)).pvalue) if g + n else 1.0 for g, n in zip(gained, lost, strict=True)
    ]
    return Agreement(
        same=float((here == there)[both].mean()) if both.any() else float("nan"),
        forward=float(np.nanmedian(off)) if np.isfinite(off).any() else float("nan"),
        wide=float(np.nanquantile(off, 0.95)) if np.isfinite(off).any() else float("nan"),
        shares=float(apart.max()),
        claim=str(one.claim.values[apart.argmax()]),
        chance=min(1.0, len(chances) * min(chances)),
    )
