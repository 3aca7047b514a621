"""The lines of the page run; the values of MuJoCo's issue 3452 are met, and missed where the thread says so."""

from dataclasses import replace
from math import pi, prod
from pathlib import Path

import numpy as np
import pytest

from suchus.core import rotation
from suchus.experiments.catalog.floating.cases import BALLAST_MASS, DEEP_LAKE, KEEL_ACCELERATION, SPHEROID, public_table
from suchus.sim.land import Lake
from suchus.sim.land.float_body import FloatBody, FloatTank

ROOT = Path(__file__).parents[2]
HALF = (0.5, 0.1, 0.1)
DISPLACED = 1000.0 * 4 / 3 * pi * prod(HALF)
VIRTUAL = (0.001238, 0.018729, 0.018729)
"""Of the thread's hull five times as long as thick [m3]: what MuJoCo stores, and Lamb's formulas give."""


def hull(share, added=VIRTUAL):
    """A tank with the thread's hull, so many times as dense as water."""
    own = tuple(1000.0 * volume / DISPLACED for volume in added)
    body = FloatBody(
        shape="ellipsoid", half=HALF, mass=share * DISPLACED, inertia=(0.1, 1.1, 1.1), added_mass_ratio=own
    )
    return FloatTank(body, DEEP_LAKE)


def pushed(tank):
    tank.data.xfrc_applied[1, 1] = 10.0
    tank.set_pose((0.0, 0.0, 0.0))
    return float(tank.acceleration[0][1])


@pytest.mark.parametrize(("share", "thread"), [(1.0, 0.894), (0.5, 1.789)])
def test_added_mass_resists_acceleration_and_without_it_the_error_is_the_threads(share, thread):
    wanted = 10.0 / (share * DISPLACED + 1000.0 * VIRTUAL[1])
    assert pushed(hull(share)) == pytest.approx(wanted, rel=1e-6)
    assert pushed(hull(share, added=(0.0, 0.0, 0.0))) / wanted - 1 == pytest.approx(thread, abs=0.001)


@pytest.mark.parametrize(("ballast", "force"), [(0.5, -4.905), (1.0, -9.81), (3.0, -29.43)])
def test_ballast_pulls_a_trimmed_float_down(ballast, force):
    body = FloatBody(shape="box", half=(0.15, 0.15, 0.15), mass=27.0 + ballast, inertia=(1.0, 1.0, 1.0))
    tank = FloatTank(body, DEEP_LAKE)
    tank.set_pose((0.0, 0.0, 0.0))
    assert tank.acceleration[0][2] * body.mass == pytest.approx(force, rel=2e-4)  # the thread has g = 9.81 m/s2


def test_the_rest_of_the_table():
    found = public_table()
    assert found["neutral"] == pytest.approx(0.0, abs=1e-9)
    assert found["ballast"] == pytest.approx(-9.81 * BALLAST_MASS, rel=2e-4)
    assert found["keel"] == pytest.approx(KEEL_ACCELERATION, rel=1e-4)


@pytest.mark.parametrize(("height", "wanted"), [(-1000.0, 0.0), (100.0, -9.81)])
def test_the_force_depends_on_the_depth(height, wanted):
    body = replace(SPHEROID, centre=(0.0, 0.0, 0.0), added_mass_ratio=(0.0, 0.0, 0.0))
    tank = FloatTank(body, Lake(level=0.0))
    tank.set_pose((0.0, 0.0, height))
    assert tank.acceleration[0][2] == pytest.approx(wanted, abs=0.005)


def test_the_mass_matrix_is_that_of_body_and_water_in_any_attitude():
    tank, turn = hull(1.0), rotation.from_axis_angle(np.array([0.6, 0.0, 0.8]), 0.7)
    tank.set_pose((0.0, 0.0, 0.0))
    level = tank.mass_matrix()
    assert np.diag(level)[:3] == pytest.approx([DISPLACED + 1000.0 * volume for volume in VIRTUAL])
    assert np.diag(level)[3:] == pytest.approx([0.1, 1.1, 1.1])
    assert level == pytest.approx(np.diag(np.diag(level)), abs=1e-9)
    tank.set_pose((0.0, 0.0, 0.0), turn, velocity=(0.3, -0.2, 0.1), spin=(0.1, 0.4, -0.3))
    assert tank.mass_matrix() == pytest.approx(level, abs=1e-9)
    along = rotation.rotate(turn * np.array([1.0, -1.0, -1.0, -1.0]), np.array([0.3, -0.2, 0.1]))
    momentum = rotation.rotate(turn, (level @ np.array([*along, 0.1, 0.4, -0.3]))[:3])
    assert tank.momenta()[:3] == pytest.approx(momentum, abs=1e-9)


def test_the_lines_of_the_page_print_what_it_says(tmp_path, programs):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from pages import blocks; blocks.follow(open(sys.argv[2]).read())"
    )
    done = programs.run(["-c", code, ROOT / "tools", ROOT / "docs" / "peers.md"], cwd=tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
