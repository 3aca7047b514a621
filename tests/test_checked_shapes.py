"""Shapes of arrays are checked in the tests, whichever version of jaxtyping is there."""

import numpy as np
import pytest
from jaxtyping import TypeCheckError

import first_calls
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics import leg
from suchus.robot.motion.movement import Movement
from suchus.robot.robots import ROBOTS

LINKS = ROBOTS["caiman"].hind_leg


def test_an_array_of_another_shape_is_refused():
    assert leg.forward(LINKS, np.zeros((2, 3))).shape == (2, 3)
    with pytest.raises(TypeCheckError, match="angles"):
        leg.forward(LINKS, np.zeros((2, 4)))


def refused():
    try:
        leg.forward(LINKS, np.zeros((2, 4)))
    except TypeCheckError:
        return True
    except ValueError:  # what numpy says of it
        return False
    return False


def test_only_the_first_calls_of_a_test_are_looked_at():
    for _ in range(first_calls.CALLS // 2 - 1):
        leg.forward(LINKS, np.zeros((2, 3)))
    assert refused()
    for _ in range(first_calls.CALLS):
        leg.forward(LINKS, np.zeros((2, 3)))
    assert not refused()
    first_calls.begin()
    assert refused()


def test_a_class_shows_its_method_unchecked_until_the_next_test():
    checked = vars(Movement)["axis_phase"]
    crawl = Movement(ROBOTS["caiman"], [GAITS["belly_crawl"]])
    for _ in range(first_calls.CALLS):
        assert crawl.axis_phase(np.zeros((1, 4))).shape == (1,)
    assert vars(Movement)["axis_phase"] is checked.__wrapped__
    first_calls.begin()
    assert vars(Movement)["axis_phase"] is checked
    with pytest.raises(TypeCheckError, match="limbs"):
        crawl.axis_phase(np.zeros(()))
