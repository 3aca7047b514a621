"""What all tests share: hypothesis without deadlines, the same examples every time."""

import os
from dataclasses import replace

import pytest
import xarray as xr
from hypothesis import settings

from suchus.design import Crocodile
from suchus.gaits import GAITS
from suchus.motion import Gait
from suchus.robots import ROBOTS

if "PYTEST_XDIST_WORKER" in os.environ:  # there are as many workers as cores
    os.environ.setdefault("SUCHUS_THREADS", "1")
xr.set_options(use_numbagg=False, use_bottleneck=False)  # as on the command line; numbagg compiles for half a minute
settings.register_profile("suchus", deadline=None, derandomize=True)
settings.load_profile("suchus")


@pytest.fixture(scope="session")
def robot() -> Crocodile:
    return ROBOTS["caiman"]


@pytest.fixture(scope="session")
def crawl_gait() -> Gait:
    return GAITS["belly_crawl"]


@pytest.fixture(scope="session")
def limbs_gait() -> Gait:
    return GAITS["limbs_only"]


@pytest.fixture(scope="session")
def long_tail(robot: Crocodile) -> Crocodile:
    """A robot of another topology."""
    return replace(robot, name="long_tail", tail=replace(robot.tail, joints=8, fin_segments=4))
