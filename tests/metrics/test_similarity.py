"""The numbers by which swims of other sizes are compared."""

import math

import pytest

from suchus.robot.design import GRAVITY
from suchus.sim.metrics import SIMILARITY, SwimNumbers, swim_numbers

ASKED = {"speed": 0.5, "length": 0.2, "frequency": 2.0, "swing": 0.04, "viscosity": 1e-6}


def test_each_is_what_its_definition_says():
    found = swim_numbers(**ASKED)
    assert SwimNumbers._fields == tuple(SIMILARITY)
    assert found.reynolds == pytest.approx(0.5 * 0.2 / 1e-6)
    assert found.froude == pytest.approx(0.5 / math.sqrt(GRAVITY * 0.2))
    assert found.strouhal == pytest.approx(2.0 * 0.04 / 0.5)
    assert found.swimming_number == pytest.approx(2 * math.pi * 2.0 * 0.04 * 0.2 / 1e-6)
    assert found.swimming_number == pytest.approx(2 * math.pi * found.strouhal * found.reynolds)


def test_a_body_that_swims_tail_first_has_those_of_its_pace_and_one_at_rest_has_no_strouhal_number():
    assert swim_numbers(**ASKED | {"speed": -0.5}) == swim_numbers(**ASKED)
    still = swim_numbers(**ASKED | {"speed": 0.0})
    assert (still.reynolds, still.froude) == (0.0, 0.0)
    assert math.isnan(still.strouhal)
    assert still.swimming_number > 0.0


def test_they_do_not_change_if_all_is_scaled_alike():
    """Lengths by k, times by the root of k, viscosity by the power 3/2: the medium of a model tank."""
    k = 4.0
    scaled = {
        "speed": 0.5 * k**0.5, "length": 0.2 * k, "frequency": 2.0 / k**0.5, "swing": 0.04 * k,
        "viscosity": 1e-6 * k**1.5,
    }  # fmt: skip
    assert swim_numbers(**scaled) == pytest.approx(swim_numbers(**ASKED))
