"""When a quantity of each cycle is settled: synthetic exponentials, oscillations, noise and drift."""

import numpy as np
import pytest

from suchus.sim.metrics import MIN_SETTLED_CYCLES, VISIBLE_TREND, settled_mean, whole_cycles

CYCLES = np.arange(40)


def test_a_constant_is_settled_from_its_first_cycle() -> None:
    assert settled_mean(np.full(12, 0.2)) == pytest.approx((0, 0.2, 0.2, 0.2, True), abs=1e-12)


@pytest.mark.parametrize("limit", [0.2, -0.05])
@pytest.mark.parametrize("time_constant", [0.5, 2.0, 4.0, 5.0])
def test_the_limit_of_an_exponential_lies_in_the_interval(time_constant: float, limit: float) -> None:
    swim = settled_mean(limit * (1.0 - np.exp(-CYCLES / time_constant)))
    assert swim.is_settled
    assert abs(swim.mean / limit - 1.0) <= 1.5 * VISIBLE_TREND
    assert swim.low <= limit <= swim.high
    assert swim.start > 0


def test_a_slower_approach_is_settled_later() -> None:
    starts = [settled_mean(1.0 - np.exp(-CYCLES / time)).start for time in (0.5, 2.0, 4.0, 5.0)]
    assert starts == sorted(set(starts))


@pytest.mark.parametrize("time_constant", [20.0, 40.0, 200.0])
def test_an_approach_as_long_as_the_series_is_too_short(time_constant: float) -> None:
    swim = settled_mean(1.0 - np.exp(-CYCLES / time_constant), fallback_cycles=5)
    assert not swim.is_settled
    assert np.isnan([swim.low, swim.high]).all()
    assert swim.start == 35
    assert swim.mean == pytest.approx(float((1.0 - np.exp(-CYCLES[35:] / time_constant)).mean()))


@pytest.mark.parametrize("drift", [0.01, 0.03, -0.01])
def test_a_drift_is_not_settled(drift: float) -> None:
    assert not settled_mean(1.0 + drift * CYCLES).is_settled


@pytest.mark.parametrize("period", [2, 3, 5, 7])
@pytest.mark.parametrize("phase", [0.0, 1.0, 2.5])
def test_an_oscillation_over_several_cycles_is_settled_about_its_mean(period: int, phase: float) -> None:
    swim = settled_mean(1.0 + 0.05 * np.sin(2.0 * np.pi * CYCLES / period + phase))
    assert swim.is_settled
    assert swim.low <= 1.0 <= swim.high
    assert swim.high - swim.low < 0.06


@pytest.mark.parametrize("memory", [0.0, 0.6])
def test_intervals_hold_for_noise_and_for_correlated_cycles(memory: float) -> None:
    noise = np.random.default_rng(2027).normal(size=(400, 60)) * 0.02
    for i in range(1, noise.shape[1]):
        noise[:, i] += memory * noise[:, i - 1]
    settled = [swim for row in noise if (swim := settled_mean(1.0 + row[20:])).is_settled]
    assert len(settled) >= 0.95 * len(noise)
    assert np.mean([swim.low <= 1.0 <= swim.high for swim in settled]) >= 0.93


def test_a_noisy_start_from_rest_is_settled_near_its_limit() -> None:
    values = 1.0 - np.exp(-CYCLES / 3.0) + np.random.default_rng(7).normal(size=(200, 40)) * 0.005
    swims = [settled_mean(row) for row in values]
    assert all(swim.is_settled for swim in swims)
    assert np.mean([swim.low <= 1.0 <= swim.high for swim in swims]) >= 0.93


def test_fewer_cycles_than_the_least_are_too_short() -> None:
    assert not settled_mean(np.ones(MIN_SETTLED_CYCLES - 1)).is_settled
    assert settled_mean(np.ones(MIN_SETTLED_CYCLES)).is_settled


def test_a_swim_that_diverged_is_not_settled() -> None:
    assert not settled_mean(np.array([*np.ones(20), np.nan])).is_settled


def test_the_scale_sets_the_tolerance_of_a_small_quantity() -> None:
    slow = 1e-3 * (1.0 + 0.02 * CYCLES)
    assert not settled_mean(slow).is_settled
    assert settled_mean(slow, scale=1.0).start == 0


def test_an_empty_series_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one cycle"):
        settled_mean(np.array([]))


@pytest.mark.parametrize(
    ("end", "count"),
    [(0.545, 1), (0.540, 0), (1.090, 2), (1.085, 1), (0.0, 0)],
)
def test_a_cycle_that_ends_within_half_a_sample_is_whole(end: float, count: int) -> None:
    """A run ends at the control period of 5 ms that is nearest to its duration."""
    time = np.arange(round(end / 0.005) + 1) * 0.005
    assert whole_cycles(time, 0.54500413) == count
