import numpy as np
import pytest

from suchus.animals.capture.cycle import find_period, fit
from suchus.animals.capture.tracks import UnusableTracks

TIME = np.arange(0.0, 5.0, 0.02)


def wave(time, period=1.3):
    angle = 2 * np.pi * time / period
    return 0.3 + 0.1 * time + 0.5 * np.cos(angle - 0.7) + 0.2 * np.cos(2 * angle + 0.4)


def test_a_fit_returns_what_was_put_in():
    one = fit(TIME, wave(TIME), 1.3, harmonics=3, drift=1)
    np.testing.assert_allclose(one.harmonics, [0.5 * np.exp(-0.7j), 0.2 * np.exp(0.4j), 0.0], atol=1e-10)
    np.testing.assert_allclose(one.drift, [0.1], atol=1e-10)
    np.testing.assert_allclose(one.trend(TIME) + one.swing(TIME), wave(TIME), atol=1e-10)


def test_a_derivative_is_that_of_the_periodic_part():
    one = fit(TIME, wave(TIME), 1.3, harmonics=2, drift=1)
    h = 1e-5
    slope = (one.swing(TIME + h) - one.swing(TIME - h)) / (2 * h)
    np.testing.assert_allclose(one.swing(TIME, derivative=1), slope, atol=1e-8)


def test_lost_points_and_jumps_do_not_matter():
    rng = np.random.default_rng(0)
    seen = wave(TIME) + 0.01 * rng.standard_normal(len(TIME))
    seen[rng.uniform(size=len(TIME)) < 0.2] = np.nan
    seen[::40] += 5.0  # a tracker that took another body for this one
    one = fit(TIME, seen, 1.3, harmonics=2, drift=1)
    np.testing.assert_allclose(one.harmonics, [0.5 * np.exp(-0.7j), 0.2 * np.exp(0.4j)], atol=0.005)
    np.testing.assert_allclose(one.noise, 0.01, rtol=0.15)


@pytest.mark.parametrize("period", [0.31, 0.8, 1.7, 3.9])
def test_the_period_is_found(period):
    angle = 2 * np.pi * TIME / period
    signals = np.array([np.cos(angle), np.sin(angle) + 0.4 * np.sin(2 * angle), 3.0 * np.cos(angle + 1.0)])
    np.testing.assert_allclose(find_period(TIME, signals, "a test"), period, rtol=2e-3)


@pytest.mark.parametrize("seen", [0.4, 0.6, 0.9, 1.1])
def test_less_than_a_cycle_is_refused(seen):
    time = np.linspace(0.0, seen, 80)
    angle = 2 * np.pi * time
    signals = np.array([np.cos(angle), np.sin(angle) + 0.1 * np.sin(2 * angle), np.cos(angle - 0.8)])
    with pytest.raises(UnusableTracks, match="cycles are needed"):
        find_period(time, signals, "a test")


def test_too_few_frames_in_a_cycle_are_refused():
    time = np.arange(0.0, 10.0, 0.125)
    with pytest.raises(UnusableTracks, match="film faster"):
        find_period(time, np.array([np.cos(2 * np.pi * time / 0.9), np.sin(2 * np.pi * time / 0.9)]), "a test")


def test_noise_does_not_repeat():
    noise = np.random.default_rng(0).standard_normal((4, 300))
    with pytest.raises(UnusableTracks, match="nothing in a test repeats"):
        find_period(np.arange(300) / 50, noise, "a test")
