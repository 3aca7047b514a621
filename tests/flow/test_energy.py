"""Exact: the work of a body is the energy that the water gains and what each term of the equations takes."""

import energy
import pytest


@pytest.mark.parametrize("setup", [energy.shaken_in_a_box(16), energy.bending_in_a_box(48)], ids=["stiff", "bending"])
def test_work_is_what_the_terms_take(setup):
    """Single precision closes to 1e-8; nothing happens away from the body that the rates, computed anew, do not say."""
    spent = energy.spent(setup, 0.08)
    assert abs(spent.missing) < 1e-6
    assert abs(spent.strange) < 1e-6 * spent.work
    assert abs(spent.pressure) < 3e-3 * spent.work
    for taken in (spent.change, spent.viscous, spent.numerical, spent.immersion):
        assert 0 < taken < spent.work
