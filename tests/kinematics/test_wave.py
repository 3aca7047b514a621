from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.kinematics import wave

X = np.linspace(0, 1, 401)


def make(letter: str = "I", **kwargs) -> wave.TravellingWave:
    return wave.reading(letter, **{"length": 1.0, "angular_frequency": 2 * pi, **kwargs})


def test_head_stands_still():
    assert np.all(wave.displacement(make(), 0.0, np.linspace(0, 1, 50)) == 0)


@pytest.mark.parametrize("letter", list(wave.READINGS))
@pytest.mark.parametrize("sign", [1, -1])
def test_wave_stays_within_its_envelope_and_repeats(letter, sign):
    swim = make(letter, sign=sign)
    t = np.linspace(0, 1, 37)[:, None]
    y = wave.displacement(swim, X, t)
    assert y.shape == (37, 401)
    assert np.all(np.abs(y) <= wave.envelope(swim, X) * (1 + 1e-12))
    scale = wave.envelope(swim, 1.0)
    np.testing.assert_allclose(wave.displacement(swim, X, t + 1.0), y, atol=1e-12 * scale)


@pytest.mark.parametrize("sign", [1, -1])
def test_slope_and_speed_are_derivatives(sign):
    swim = make("C", sign=sign)
    x, t, step = 0.7, 0.13, 1e-6
    by_x = (wave.displacement(swim, x + step, t) - wave.displacement(swim, x - step, t)) / (2 * step)
    by_t = (wave.displacement(swim, x, t + step) - wave.displacement(swim, x, t - step)) / (2 * step)
    assert wave.slope(swim, x, t) == pytest.approx(by_x, rel=1e-8)
    assert wave.speed(swim, x, t) == pytest.approx(by_t, rel=1e-8)


def test_amplitudes_of_the_readings():
    tips = {"A": 0.327, "B": 0.327, "C": 0.327, "D": 300.027, "E": 30.027, "J": 0.327, "K": 0.327}
    for letter, tip in tips.items():
        assert wave.envelope(make(letter), 1.0) == pytest.approx(tip, rel=1e-12)
    for letter in "FGH":
        assert wave.READINGS[letter].tail_only
        assert wave.envelope(make(letter), 0.5) == pytest.approx(0.0885, rel=1e-12)
    assert wave.envelope(make("I"), 1.0) == pytest.approx(0.10895, rel=1e-4)


def test_wavelengths_of_the_readings():
    metres = {
        "A": 273.2,
        "B": 0.2732,
        "C": 2.732,
        "D": 0.2732,
        "E": 2.732,
        "F": 273.2,
        "G": 0.2732,
        "H": 2.732,
    }
    metres |= {"I": 1.0, "J": 0.4348, "K": 15.65}
    for letter, length in metres.items():
        assert 2 * pi / make(letter).wave_number == pytest.approx(length, rel=1e-3)


@given(st.floats(0.05, 20), st.floats(0.3, 3))
def test_normalised_reading_scales_with_the_body(length, waves):
    small = make("I", waves_per_body=waves)
    large = make("I", length=length, waves_per_body=waves)
    here = wave.displacement(large, X * length, 0.3) / length
    np.testing.assert_allclose(here, wave.displacement(small, X, 0.3), atol=1e-12)


def test_unknown_readings_and_impossible_bodies_are_refused():
    with pytest.raises(UnknownName, match="A, B, C"):
        make("Z")
    for bad in ({"length": 0.0}, {"length": np.nan}, {"waves_per_body": -1.0}, {"sign": 2}):
        with pytest.raises(InvalidDesign):
            make(**bad)
    with pytest.raises(InvalidDesign, match="1e\\+12 is allowed"):
        make(angular_frequency=np.inf)
