"""Confidence intervals against published values, and how often they contain the truth on synthetic data."""

from itertools import pairwise

import numpy as np
import pytest
from scipy import stats

from suchus.core.intervals import (
    CONFIDENCE,
    fraction_interval,
    look_confidence,
    median_interval,
    min_median_count,
    planned_looks,
)

METHODS = {"exact": "exact", "wilson": "wilson"}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("successes", "trials"), [(0, 1), (1, 1), (0, 10), (3, 10), (32, 32), (31, 32), (400, 1000)])
def test_intervals_of_fractions_are_those_of_scipy(method, successes, trials):
    reference = stats.binomtest(successes, trials).proportion_ci(CONFIDENCE, method=METHODS[method])
    assert fraction_interval(successes, trials, method=method) == pytest.approx((reference.low, reference.high))


def test_no_trial_gives_no_interval():
    assert np.isnan(fraction_interval(0, 0)).all()
    assert np.isnan(fraction_interval(0, 0, method="wilson")).all()


@pytest.mark.parametrize("trials", [4, 12, 32])
def test_the_exact_interval_contains_every_fraction_in_95_of_100_cases(trials):
    """The coverage is summed over all outcomes, so that no sample is drawn."""
    ends = np.array([fraction_interval(successes, trials) for successes in range(trials + 1)])
    fractions = np.linspace(0.001, 0.999, 499)
    probability = stats.binom.pmf(np.arange(trials + 1)[:, None], trials, fractions)
    contains = (ends[:, :1] <= fractions) & (fractions <= ends[:, 1:])
    coverage = (probability * contains).sum(axis=0)
    assert coverage.min() >= CONFIDENCE
    wilson = np.array([fraction_interval(n, trials, method="wilson") for n in range(trials + 1)])
    wilson_coverage = (probability * ((wilson[:, :1] <= fractions) & (fractions <= wilson[:, 1:]))).sum(axis=0)
    assert wilson_coverage.min() < CONFIDENCE  # why verdicts do not use it
    assert wilson_coverage.mean() == pytest.approx(CONFIDENCE, abs=0.02)


@pytest.mark.parametrize(("count", "rank"), [(6, 1), (8, 1), (9, 2), (12, 3), (20, 6), (32, 10)])
def test_intervals_of_medians_end_at_the_ranks_of_the_tables(count, rank):
    """Ranks of the 95 % interval: D. B. Owen, Handbook of Statistical Tables (1962), of the sign test."""
    values = np.random.default_rng(count).permutation(np.arange(1, count + 1))
    assert median_interval(values) == (rank, count + 1 - rank)


@pytest.mark.parametrize("draw", ["lognormal", "standard_cauchy", "uniform"])
@pytest.mark.parametrize("count", [6, 8, 12, 32])
def test_intervals_of_medians_contain_the_median_of_any_distribution(count, draw):
    rng = np.random.default_rng(17)
    true_median = {"lognormal": 1.0, "standard_cauchy": 0.0, "uniform": 0.5}[draw]
    samples = getattr(rng, draw)(size=(4000, count))
    ends = np.array([median_interval(sample) for sample in samples])
    coverage = np.mean((ends[:, 0] <= true_median) & (true_median <= ends[:, 1]))
    first_rank = int(median_interval(np.arange(1, count + 1))[0])
    expected = 1.0 - 2.0 * stats.binom.cdf(first_rank - 1, count, 0.5)
    assert expected >= CONFIDENCE
    assert coverage == pytest.approx(expected, abs=4.0 * np.sqrt(expected * (1.0 - expected) / len(samples)))


def test_the_bootstrap_that_was_used_before_covers_less():
    """The reason for exact intervals: of 8 values, the bootstrap's interval of the median misses too often."""
    rng = np.random.default_rng(5)
    samples = rng.lognormal(size=(600, 8))
    resampled = np.median(samples[:, rng.integers(8, size=(400, 8))], axis=-1)
    ends = np.quantile(resampled, [0.025, 0.975], axis=1)
    assert np.mean((ends[0] <= 1.0) & (ends[1] >= 1.0)) < CONFIDENCE


def test_too_few_or_infinite_values_leave_the_interval_unknown():
    assert min_median_count() == 6
    assert min_median_count(0.5) == 2
    assert min_median_count(0.98) == 7
    for values in ([], [1.0], range(5), [*range(11), np.nan]):
        assert np.isnan(median_interval(values)).all()
    assert median_interval([1.0] * 6) == (1.0, 1.0)


def test_sampling_may_end_after_half_of_the_repeats():
    assert [planned_looks(count) for count in (1, 2, 4, 9, 32)] == [(1,), (1, 2), (2, 4), (5, 9), (16, 32)]
    assert look_confidence(1) == CONFIDENCE
    assert look_confidence(2) == pytest.approx(0.975)


def test_sampling_may_end_after_a_quarter_of_the_repeats_too():
    assert [planned_looks(count, 3) for count in (1, 2, 4, 9, 32)] == [(1,), (1, 2), (1, 2, 4), (3, 5, 9), (8, 16, 32)]
    assert planned_looks(32, 1) == (32,)
    assert planned_looks(32, 3)[0] >= min_median_count(look_confidence(3)) == 7


def sequential_coverage(fractions, bound, looks, confidence):
    """Return how often the interval at which sampling ends contains each fraction, summed over all outcomes.

    Sampling ends as soon as the interval of a look lies to one side of the bound, and after the last look.
    """
    chance, coverage = np.ones((1, len(fractions))), np.zeros(len(fractions))  # chance: of each number of successes
    for first, end in pairwise((0, *looks)):
        added = stats.binom.pmf(np.arange(end - first + 1)[:, None], end - first, fractions)
        reached = np.zeros((end + 1, len(fractions)))
        for successes, share in enumerate(chance):
            reached[successes : successes + len(added)] += share * added
        lower, upper = np.array([fraction_interval(n, end, confidence=confidence) for n in range(end + 1)]).T[..., None]
        goes_on = (lower <= bound) & (bound <= upper) & (end < looks[-1])
        coverage += np.where(goes_on, 0.0, reached * ((lower <= fractions) & (fractions <= upper))).sum(axis=0)
        chance = np.where(goes_on, reached, 0.0)
    return coverage


@pytest.mark.parametrize("number", [2, 3])
@pytest.mark.parametrize("count", [16, 32])
def test_intervals_contain_every_fraction_wherever_sampling_ends(count, number):
    fractions, bounds, looks = np.linspace(0.01, 0.99, 197), np.linspace(0.05, 0.95, 19), planned_looks(count, number)
    assert len(looks) == number
    held = [sequential_coverage(fractions, bound, looks, look_confidence(number)) for bound in bounds]
    assert np.min(held) >= CONFIDENCE
    once = [sequential_coverage(fractions, bound, looks, CONFIDENCE) for bound in bounds]
    assert np.min(once) < CONFIDENCE  # why each look needs more confidence than one interval alone


@pytest.mark.parametrize("number", [2, 3])
@pytest.mark.parametrize("draw", ["lognormal", "standard_cauchy"])
@pytest.mark.parametrize("distance", [0.0, 0.3])
def test_intervals_contain_the_median_wherever_sampling_ends(draw, distance, number):
    """Sampling ends as soon as the interval of a look lies to one side of a bound near the median."""
    rng = np.random.default_rng(11)
    true_median = {"lognormal": 1.0, "standard_cauchy": 0.0}[draw]
    bound, looks, count = true_median + distance, planned_looks(32 if number == 3 else 24, number), 4000
    contains = np.zeros(count, dtype=bool)
    for number, sample in enumerate(getattr(rng, draw)(size=(count, looks[-1]))):
        for look in looks:
            low, high = median_interval(sample[:look], confidence=look_confidence(len(looks)))
            if low > bound or high < bound:
                break
        contains[number] = low <= true_median <= high
    assert contains.mean() >= CONFIDENCE - 3.0 * np.sqrt(CONFIDENCE * (1.0 - CONFIDENCE) / count)
