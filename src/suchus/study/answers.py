"""From the ways of many designs, intact and with joints lost, to what becomes of each claim of the article."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import stats

from suchus.land import LOST
from suchus.metrics import border, loss, rank_correlation, says

ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
STATES = ("intact", *LOST)
"""Whole, and with each joint lost of which the article speaks."""
_LEAST_RATIO = 0.02  # a way with limbs only below this part of the way with spine and tail makes a ratio of 50
_STANDS = 0.01  # [m]; an intact robot that gets no farther has nothing to keep when a joint is lost
_BINS, _RESAMPLED, _SURE = 8, 400, 0.95


class Index(NamedTuple):
    """How much of a quantity each parameter decides alone."""

    share: np.ndarray
    """Of the variance of its ranks, shape (parameter,) [-]; chance alone gives about zero."""
    low: np.ndarray
    """Lower end of the 95 % interval [-]."""
    high: np.ndarray
    """Upper end [-]."""


def quantities(forward: xr.DataArray, std: xr.DataArray, least: float) -> dict[str, tuple[xr.DataArray, xr.DataArray]]:
    """Return for each claim its number in every sample, and whether its sentence is true there; NaN: cannot be told.

    Args:
        forward: way forward over ``sample``, ``arm`` and ``state`` [m].
        std: standard deviation of the height of the centre of mass over the same [m].
        least: an intact robot with spine and tail that gets no farther has nothing to lose [m].
    """
    intact, height = forward.sel(state="intact"), std.sel(state="intact")
    ours, bare = (intact.sel(arm=arm, drop=True) for arm in ARMS)
    able = ours.where(ours > least)
    ratio = able / bare.clip(min=_LEAST_RATIO * able)
    calm = height.sel(arm="coordinated", drop=True) / height.sel(arm="limbs_only", drop=True)
    found = {
        "displacement_coordinated": (ours, ours > 0),
        "displacement_limbs_only": (bare, bare > 0),
        "displacement_ratio": (ratio, ratio > 1),
        "com_fluctuation": (calm, calm < 1),
    }
    kept = []
    for joint in LOST:
        for arm in ARMS:
            way, key = forward.sel(state=joint, arm=arm, drop=True), f"fault_{joint}_{arm}"
            change = loss(way, able)
            found[key] = (change, change.copy(data=says(key, change.values)))
            whole = intact.sel(arm=arm, drop=True)
            kept.append((way / whole.where(whole > _STANDS)).clip(min=0.0))
    pairs = [(a > b).where(np.isfinite(a) & np.isfinite(b)) for a, b in zip(kept[::2], kept[1::2], strict=True)]
    better = xr.concat(pairs, "joint").mean("joint", skipna=False)
    found["fault_tolerance"] = (better, better > 0.5)
    return found


def answers(record: xr.Dataset, least: float) -> xr.Dataset:
    """Return number and truth of each claim in every sample, and what decides.

    Args:
        record: ``forward`` and ``std`` over ``sample``, ``arm`` and ``state``, ``value`` over ``sample`` and
            ``parameter``; ``fine_forward`` and ``fine_std`` over ``repeated`` where samples were repeated.
        least: see ``quantities``.
    """
    found = quantities(record.forward, record["std"], least)
    claims, parameters = list(found), record.value.values
    told = np.array([quantity.values for quantity, _ in found.values()])
    holds = np.array([truth.values for _, truth in found.values()])
    there = np.isfinite(told)
    follows = [rank_correlation(parameters, each) for each in told]
    borders = [border(parameters[there[i]], holds[i][there[i]]) for i in range(len(claims))]
    one = {"units": "1"}
    data = xr.Dataset(
        {
            "number": (("claim", "sample"), told, one | {"long_name": "number of the claim"}),
            "holds": (("claim", "sample"), holds & there, one | {"long_name": "whether its sentence is true"}),
            "correlation": (("claim", "parameter"), np.array([rho for rho, _ in follows]), one),
            "chance": (("claim", "parameter"), np.array([p for _, p in follows]), one),
            "border_of": ("claim", np.array([b.parameter if b else -1 for b in borders]), one),
            "border_at": ("claim", np.array([b.at if b else np.nan for b in borders]), one),
            "border_above": ("claim", np.array([bool(b and b.above) for b in borders]), one),
            "border_separation": ("claim", np.array([b.separation if b else np.nan for b in borders]), one),
        },
        coords={"claim": claims},
    )
    if "fine_forward" in record:
        fine = quantities(record.fine_forward, record.fine_std, least)
        data["fine_number"] = (("claim", "repeated"), np.array([q.values for q, _ in fine.values()]), one)
        data["fine_holds"] = (("claim", "repeated"), np.array([h.values for _, h in fine.values()]), one)
    return data


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
    return np.asarray(1.0 - (1.0 - between / whole) * (count - 1) / (count - _BINS))


def share_interval(true: int, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a share, after Wilson [-]."""
    if count == 0:
        return float("nan"), float("nan")
    z, p = float(stats.norm.ppf((1 + _SURE) / 2)), true / count
    middle = (p + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * np.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return float(max(middle - half, 0.0)), float(min(middle + half, 1.0))


class Agreement(NamedTuple):
    """How two answers about the same samples agree."""

    same: float
    """Share of the samples and claims that both can tell which they tell alike [-]."""
    way: float
    """Median difference of the way forward [m]."""
    wide: float
    """Its 95th percentile [m]."""
    shares: float
    """Greatest difference of a claim's share of truth [-]."""
    claim: str
    """Which claim's share that is."""
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
    off = abs(one.forward.values - other.forward.values)
    gained, lost = (here & ~there & both).sum(axis=1), (there & ~here & both).sum(axis=1)
    apart = abs(gained - lost) / np.maximum(both.sum(axis=1), 1)
    chances = [
        float(stats.binomtest(int(g), int(g + n)).pvalue) if g + n else 1.0 for g, n in zip(gained, lost, strict=True)
    ]
    return Agreement(
        same=float((here == there)[both].mean()) if both.any() else float("nan"),
        way=float(np.nanmedian(off)) if np.isfinite(off).any() else float("nan"),
        wide=float(np.nanquantile(off, 0.95)) if np.isfinite(off).any() else float("nan"),
        shares=float(apart.max()),
        claim=str(one.claim.values[apart.argmax()]),
        chance=min(1.0, len(chances) * min(chances)),
    )
