"""What all tests share: shapes that are checked, hypothesis without deadlines, the same examples every time."""

import os
import sys
from dataclasses import replace

import pytest
import xarray as xr
from hypothesis import settings
from jaxtyping import install_import_hook

CHECKED = ("suchus.kinematics", "suchus.motion.phase", "suchus.motion.targets", "suchus.control", "suchus.metrics")
"""Rooms whose arrays' shapes are checked at every call; production pays nothing."""
assert not {*CHECKED} & {*sys.modules}, "imported before their shapes can be checked"
install_import_hook(CHECKED, "beartype.beartype")  # jaxtyping's own option comes too late for us before its 0.3.6

from suchus.design import Crocodile  # noqa: E402
from suchus.gaits import GAITS  # noqa: E402
from suchus.motion import Gait  # noqa: E402
from suchus.robots import ROBOTS  # noqa: E402

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
