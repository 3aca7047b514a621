import numpy as np
import pytest

import suchus
from suchus.core.errors import InvalidDesign
from suchus.sim.land import Ground, Run
from suchus.sim.land.push_search import smallest_pushes

CAIMAN, CRAWL = suchus.ROBOTS["caiman"], suchus.GAITS["limbs_only"]
SLIDES = {"start_time": 0.4, "wait": 0.1, "levels": (1.0, 2.0, 4.0, 8.0), "timestep": 0.01}


def moved(limit):
    """Fall when the centre of mass has moved sideways by more than a limit [m]."""
    return lambda record: abs(record.centre_of_mass.isel(time=-1).sel(xyz="y")) > limit


def test_on_ice_the_smallest_push_grows_with_what_it_has_to_do():
    icy = Run(robot=CAIMAN, gait=CRAWL, ground=Ground(friction_scale=0.01))
    # way = F/m (t^2/2 + t wait): the push that moves it so far is known
    way = 0.02
    exact = way * CAIMAN.mass / (0.2**2 / 2 + 0.2 * 0.1)
    found = smallest_pushes([icy], [(0, 1, 0), (0, -1, 0)], has_fallen=moved(way), refinement_count=7, **SLIDES)
    assert found.shape == (1, 2)
    assert found[0] == pytest.approx(exact, abs=0.25 + 0.05 * exact)
    assert np.all(found >= exact * 0.95)


def test_what_never_falls_needs_an_infinite_push_and_what_falls_at_once_the_least():
    run = Run(robot=CAIMAN, gait=CRAWL)
    never = smallest_pushes([run], [(0, 1, 0)], has_fallen=moved(99.0), refinement_count=1, **SLIDES)
    assert np.isinf(never).all()
    always = smallest_pushes([run], [(0, 1, 0)], has_fallen=moved(-1.0), refinement_count=3, **SLIDES)
    assert always == pytest.approx(0.25)
    assert smallest_pushes([run], [(0, 1, 0)], has_fallen=moved(-1.0), refinement_count=0, **SLIDES) == pytest.approx(
        1.0
    )


def test_levels_must_increase():
    with pytest.raises(InvalidDesign, match="increasing forces above 0 N"):
        smallest_pushes([], [], start_time=0.1, levels=(2.0, 1.0), has_fallen=moved(1.0))
