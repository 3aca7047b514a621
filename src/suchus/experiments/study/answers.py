"""From the runs of many designs to the truth of each claim of the article."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import stats

from suchus.core.intervals import fraction_interval
from suchus.experiments.study.claim_measures import judge_samples, measures_of, swept_rules
from suchus.sim.metrics.decisive import border, rank_correlation

_BINS, _RESAMPLED, _CONFIDENCE = 8, 400, 0.95


class Index(NamedTuple):
    """How much of a quantity each parameter decides alone."""

    variance_fraction: np.ndarray
    """Fraction of the variance of its ranks, shape (parameter,) [-]; chance alone gives about zero."""
    low: np.ndarray
    """Lower end of the 95 % interval [-]."""
    high: np.ndarray
    """Upper end [-]."""


def answers(record: xr.Dataset, min_displacement: float) -> xr.Dataset:
    """Return number and truth of each claim in every sample, and the parameters that decide them.

    Args:
        record: see ``claim_measures.measures_of``, and ``value`` over ``sample`` and ``parameter``.
        min_displacement: least displacement of an intact robot with spine and tail for which a loss is measured [m].

    Raises:
        IncompatibleRecord: a rule needs a measure that the record lacks.
    """
    measures = measures_of(record, min_displacement)
    return answer_claims({rule.claim: judge_samples(rule, measures) for rule in swept_rules()}, record.value.values)


def answer_claims(results: Mapping[str, tuple[np.ndarray, np.ndarray]], parameters: np.ndarray) -> xr.Dataset:
    """Return number and truth of each claim in every sample, and the parameters that decide them.

    Args:
        results: for each claim its number in every sample, NaN where it cannot be judged, and whether its statement
            holds.
        parameters: values of what varies, shape (sample, parameter).
    """
    numbers, holds = (np.array(values) for values in zip(*results.values(), strict=True))
    is_judged = np.isfinite(numbers)
    follows = [rank_correlation(parameters, number) for number in numbers]
    borders = [border(parameters[is_judged[i]], holds[i][is_judged[i]]) for i in range(len(results))]
    unit_attrs = {"units": "1"}
    return xr.Dataset(
        {
            "number": (("claim", "sample"), numbers, unit_attrs | {"long_name": "number of the claim"}),
            "holds": (("claim", "sample"), holds, unit_attrs | {"long_name": "whether its statement holds"}),
            "correlation": (("claim", "parameter"), np.array([rho for rho, _ in follows]), unit_attrs),
            "chance": (("claim", "parameter"), np.array([p for _, p in follows]), unit_attrs),
            "border_of": ("claim", np.array([b.parameter if b else -1 for b in borders]), unit_attrs),
            "border_at": ("claim", np.array([b.threshold if b else np.nan for b in borders]), unit_attrs),
            "border_above": ("claim", np.array([bool(b and b.holds_above) for b in borders]), unit_attrs),
            "border_separation": ("claim", np.array([b.separation if b else np.nan for b in borders]), unit_attrs),
        },
        coords={"claim": list(results)},
    )


def first_order(parameters: np.ndarray, quantity: np.ndarray) -> Index:
    """Return how much of a quantity each parameter decides alone, whether it rises with it or not.

    The first-order index of Sobol, estimated from any sample: the share of the variance that lies between the means of
    eight equally filled bins of the parameter, less what chance would put there. It is taken of the ranks of the
    quantity, so that a few wild values do not decide. The interval comes from resampling.

    Args:
        parameters: shape (sample, parameter).
        quantity: shape (sample,); samples without it (NaN) are left out.

    Source: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, for the index; the correction for chance is
    that of the adjusted coefficient of determination.
    """
    is_finite = np.isfinite(quantity)
    count = int(is_finite.sum())
    zeros = np.zeros(parameters.shape[1])
    if count < 4 * _BINS or np.ptp(quantity[is_finite]) == 0.0:
        return Index(zeros, zeros, zeros)
    ranks = stats.rankdata(quantity[is_finite])
    resampled_counts = np.random.default_rng(0).multinomial(count, np.full(count, 1 / count), size=_RESAMPLED)
    weights = np.vstack([np.ones(count), resampled_counts.astype(float)])
    indices = np.array(
        [_explained_fraction(column, ranks, weights) for column in parameters[is_finite].T]
    )  # (parameter, resampled)
    spread = np.quantile(indices[:, 1:], ((1 - _CONFIDENCE) / 2, (1 + _CONFIDENCE) / 2), axis=1)
    # a resampled sample holds some points twice, which looks like more variance between bins: take that bias away
    shift = indices[:, 1:].mean(axis=1) - indices[:, 0]
    return Index(indices[:, 0], spread[0] - shift, spread[1] - shift)


def _explained_fraction(parameter: np.ndarray, ranks: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the fraction of a quantity's variance that bins of a parameter explain, for every resample [-].

    It is the correlation ratio of the ranks, adjusted for the number of bins as an adjusted R2 is, so that it can be
    a little below zero. Shape (resample,).

    Args:
        parameter: values of the parameter, shape (sample,).
        ranks: ranks of the quantity, shape (sample,).
        weights: weights of the samples in each resample, shape (resample, sample).
    """
    sample_count = len(ranks)
    bin_index = (stats.rankdata(parameter, method="ordinal") - 1).astype(int) * _BINS // sample_count
    membership = np.eye(_BINS)[bin_index]
    bin_weights = weights @ membership
    sums = weights @ (membership * ranks[:, None])
    total_weight = weights.sum(axis=1)
    mean = weights @ ranks / total_weight
    total_variance = weights @ ranks**2 / total_weight - mean**2
    between_variance = (np.where(bin_weights > 0, sums**2 / np.maximum(bin_weights, 1e-12), 0.0)).sum(
        axis=1
    ) / total_weight - mean**2
    fraction = np.divide(
        between_variance, total_variance, out=np.zeros_like(total_variance), where=total_variance > 0
    )  # a resampled quantity may be constant
    return np.asarray(1.0 - (1.0 - fraction) * (sample_count - 1) / (sample_count - _BINS))


def share_interval(true: int, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a share, after Wilson [-]."""
    return fraction_interval(true, count, method="wilson", confidence=_CONFIDENCE)


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


def agreement(record: xr.Dataset, reference: xr.Dataset) -> Agreement:
    """Return how two answers about the same samples agree.

    That a claim's share moves is judged by the exact sign test on the samples whose truth turns, the least chance
    among the claims times their number (Bonferroni).

    Args:
        record: record of ``answers``, merged with its record.
        reference: the same, made otherwise.
    """
    is_comparable = np.isfinite(record.number.values) & np.isfinite(reference.number.values)
    record_holds, reference_holds = record.holds.values.astype(bool), reference.holds.values.astype(bool)
    distance_change = abs(record.displacement_x.values - reference.displacement_x.values)
    gained_count, lost_count = (
        (record_holds & ~reference_holds & is_comparable).sum(axis=1),
        (reference_holds & ~record_holds & is_comparable).sum(axis=1),
    )
    share_change = abs(gained_count - lost_count) / np.maximum(is_comparable.sum(axis=1), 1)
    chances = [
        float(stats.binomtest(int(g), int(g + n)).pvalue) if g + n else 1.0
        for g, n in zip(gained_count, lost_count, strict=True)
    ]
    return Agreement(
        same=float((record_holds == reference_holds)[is_comparable].mean()) if is_comparable.any() else float("nan"),
        forward=float(np.nanmedian(distance_change)) if np.isfinite(distance_change).any() else float("nan"),
        wide=float(np.nanquantile(distance_change, 0.95)) if np.isfinite(distance_change).any() else float("nan"),
        shares=float(share_change.max()),
        claim=str(record.claim.values[share_change.argmax()]),
        chance=min(1.0, len(chances) * min(chances)),
    )
