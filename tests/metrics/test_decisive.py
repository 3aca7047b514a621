import numpy as np
import pytest

from suchus.sim.metrics.decisive import border, rank_correlation

RNG = np.random.default_rng(1)
POINTS = RNG.random((400, 5))


def test_a_quantity_that_grows_with_a_parameter_follows_it_whatever_the_shape():
    rho, chance = rank_correlation(POINTS, np.exp(5 * POINTS[:, 2]))
    assert rho[2] == pytest.approx(1.0)
    assert chance[2] < 1e-12
    assert np.all(abs(np.delete(rho, 2)) < 0.2)
    falling, _ = rank_correlation(POINTS, -(POINTS[:, 2] ** 3))
    assert falling[2] == pytest.approx(-1.0)


def test_samples_without_the_quantity_are_left_out():
    quantity = POINTS[:, 0].copy()
    rho, _ = rank_correlation(POINTS[::2], quantity[::2])
    quantity[1::2] = np.nan
    assert np.array_equal(rank_correlation(POINTS, quantity)[0], rho)


def test_what_never_changes_follows_nothing():
    rho, chance = rank_correlation(POINTS, np.ones(400))
    assert np.all(rho == 0.0)
    assert np.all(chance == 1.0)
    assert np.all(rank_correlation(POINTS, np.full(400, np.nan))[0] == 0.0)


@pytest.mark.parametrize("above", [True, False])
def test_a_clean_border_is_found_with_its_side(above):
    holds = POINTS[:, 3] > 0.3 if above else POINTS[:, 3] < 0.3
    found = border(POINTS, holds)
    assert found.parameter == 3
    assert found.threshold == pytest.approx(0.3, abs=0.02)
    assert found.holds_above == above
    assert found.separation == pytest.approx(1.0)
    assert found.chance < 1e-12


def test_a_blurred_border_separates_less():
    blurred = POINTS[:, 3] + RNG.normal(0, 0.2, 400) > 0.5
    found = border(POINTS, blurred)
    assert found.parameter == 3
    assert 0.3 < found.separation < 0.95
    # the separation is what it says it is
    above = POINTS[:, 3] > found.threshold
    assert above[blurred].mean() - above[~blurred].mean() == pytest.approx(found.separation, abs=0.01)


def test_there_is_no_border_where_it_always_or_never_holds():
    assert border(POINTS, np.ones(400, dtype=bool)) is None
    assert border(POINTS, np.zeros(400, dtype=bool)) is None
    assert border(POINTS, np.arange(400) < 3) is None


def test_what_is_chance_is_no_border():
    found = [border(RNG.random((400, 50)), RNG.random(400) < 0.5) for _ in range(20)]
    assert found.count(None) >= 19
    # the one parameter among fifty that looks best in a handful of samples is no border either
    assert border(RNG.random((400, 50)), np.arange(400) < 6) is None
