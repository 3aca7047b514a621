"""Walls in one dimension: what the solver's wall does is what its offset was fitted to, and what others would do."""

import numpy as np
import pytest

from evidence.wall_model import PLACES, WALLS, friction, growth, rest
from suchus.flow.immerse import wall_offset

TODAY = WALLS["today's: immersion with an offset"]
CARRIED = WALLS["parabola carried to the wall"]
WIDE = WALLS["parabola carried to the wall, kernel twice as wide"]


@pytest.mark.parametrize("spread", [0.001, 0.01, 0.03, 0.1, 0.2])
def test_the_offset_is_where_the_water_would_rest_without_it(spread):
    bare = np.mean([rest(WALLS["immersion without an offset"], place, spread) for place in PLACES])
    assert wall_offset(spread) == pytest.approx(-bare, abs=0.015)


def test_with_its_offset_water_rests_at_the_surface_in_the_mean_alone():
    rests = np.array([rest(TODAY, place, 0.01) for place in PLACES])
    assert abs(rests.mean()) < 0.005
    assert np.ptp(rests) > 0.15
    off = friction(TODAY, 0.3, 0.1, 2.0)
    assert abs(off) < 0.92  # the offset does nothing for the friction of a thin layer


@pytest.mark.parametrize("name", ["cut cells, merged", "parabola carried to the wall"])
def test_two_walls_let_it_rest_there_whatever_the_step(name):
    for spread in (0.001, 0.05, 0.2):
        assert max(abs(rest(WALLS[name], place, spread)) for place in PLACES[::4]) < 1e-8


def test_increments_alone_do_not_know_where_the_wall_is():
    rests = [rest(WALLS["immersion of increments"], place, 0.01) for place in PLACES]
    assert np.mean(rests) < -1
    assert np.ptp(rests) > 0.5


def test_the_carried_wall_rubs_as_the_exact_one_and_the_better_the_thicker_the_layer():
    errors = [max(abs(friction(CARRIED, place, 0.1, layer) - 1) for place in PLACES[::5]) for layer in (2, 4)]
    assert errors[0] < 0.06
    assert errors[0] > 2.5 * errors[1]


def test_a_wider_kernel_under_the_parabola_shakes_less_and_rubs_less_exactly():
    """It rests at the wall too; friction depends less on where nodes lie, and its phase is three times as far off."""
    assert max(abs(rest(WIDE, place, 0.05)) for place in PLACES[::4]) < 1e-3
    rubbed, wide = (np.array([friction(wall, place, 0.1, 2.0) for place in PLACES[::4]]) for wall in (CARRIED, WIDE))
    assert np.ptp(np.abs(wide)) < 0.4 * np.ptp(np.abs(rubbed))
    assert np.abs(wide - 1).max() > 2 * np.abs(rubbed - 1).max()
    assert max(growth(WIDE, place, 0.2) for place in PLACES[::4]) < 1


def test_merged_cells_need_a_shorter_step_than_the_others():
    assert max(growth(WALLS["cut cells, merged"], place, 0.2) for place in PLACES[::4]) > 1.01
    assert max(growth(WALLS["cut cells, merged"], place, 0.1) for place in PLACES[::4]) < 1
    for wall in (TODAY, CARRIED):
        assert max(growth(wall, place, 0.2) for place in PLACES[::4]) < 1
