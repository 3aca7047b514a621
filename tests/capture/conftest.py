from functools import cache

import pytest

from suchus.animals.capture import Camera, SyntheticAnimal, film_animal, observe
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl as let_crawl


@pytest.fixture(scope="session")
def caiman():
    return ROBOTS["caiman"]


@pytest.fixture(scope="session")
def crawl(caiman):
    return let_crawl(caiman, GAITS["belly_crawl"], duration=9.0, timestep=0.005)


@pytest.fixture
def noisy():
    return Camera(rate=50.0, noise=0.002, lost=0.05, heading=2.1, scale=731.0, heights=False, seed=0)


@pytest.fixture(scope="session")
def clean():
    return Camera(rate=100.0, noise=0.0, lost=0.0, heading=0.0, scale=None, heights=True, seed=0)


@pytest.fixture(scope="session")
def read_film():
    """What is read of a film of an animal, once for all that look at it."""

    @cache
    def read(animal, camera, cycles):
        return observe(film_animal(animal, camera, cycles=cycles))

    return read


@pytest.fixture(scope="session")
def lizard():
    return SyntheticAnimal(
        trunk=0.12,
        tail=0.20,
        period=0.8,
        duty_factor=0.7,
        limb_phases=(0.0, 0.5, 0.25, 0.75),  # lateral sequence: LH, LF, RH, RF
        stride=0.15,
        outward=0.06,
        lift=0.02,
        spine_bend=0.5,
        spine_rightmost=0.2,
        tail_bend=0.7,
        tail_lag=1 / 3,
        tail_wave=0.0,
    )
