"""What published data tell of their own error."""

import numpy as np
import pytest

from evidence.atlas.source_error import digits_error, half_a_digit, reading_error, stated_error


@pytest.mark.parametrize(("text", "half"), [("1.25", 0.005), ("120", 0.5), ("-0.4", 0.05), ("4.5e-3", 5e-5)])
def test_half_a_unit_of_the_last_digit(text, half):
    assert half_a_digit(text) == pytest.approx(half)


def test_the_most_precise_number_tells_how_many_digits_there_are():
    assert digits_error(("0.5", "0.25", "", "1"), 2.0, np.array([0.5, -4.0])) == pytest.approx(0.005 * 2 / 4)


def test_a_stated_error_is_taken_over_the_peak():
    assert stated_error(np.array([3.0, 4.0, np.nan]), np.array([1.0, -5.0])) == pytest.approx(np.sqrt(12.5) / 5)


@pytest.mark.parametrize("noise", [0.002, 0.02])
def test_the_scatter_of_readings_about_a_curve_is_found(noise):
    rng = np.random.default_rng(1)
    x = np.sort(rng.uniform(0, 10, 200))
    read = np.sin(x) + rng.normal(0, noise, x.size)
    assert reading_error(x, read) == pytest.approx(noise, rel=0.25)
    shuffled = rng.permutation(x.size)
    assert reading_error(x[shuffled], read[shuffled]) == pytest.approx(reading_error(x, read))


def test_a_curve_read_without_error_has_none_even_where_it_has_a_corner():
    x = np.linspace(0, 1, 60)
    assert reading_error(x, 2 * x**2 - x) == pytest.approx(0, abs=1e-12)
    assert reading_error(x, np.abs(x - 0.5)) == pytest.approx(0, abs=1e-12)


def test_a_periodic_curve_has_neighbours_across_its_end():
    angle = np.arange(0.0, 360.0, 60.0)  # of six points no two have four neighbours to one side
    assert reading_error(angle, np.cos(np.radians(angle)), 360.0) is not None
    assert reading_error(angle[:4], angle[:4]) is None
    assert reading_error(np.zeros(9), np.arange(9.0)) is None  # all at one place
