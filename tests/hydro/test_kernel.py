"""The compiled kernel: pieces taken together give what each gives alone, and its arc sine is the library's."""

from math import asin, inf, nextafter, sin

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.water_table import FORCE, LANES, SUBMERGED_VOLUME, pack_table, unpack_table
from suchus.robot.design.pieces import pieces
from suchus.robot.design.scale import physics_step
from suchus.robot.robots import ROBOTS
from suchus.sim.hydro.forces import _arcsine
from suchus.sim.immersion import wetting
from suchus.sim.land import Lake, Wave
from suchus.sim.model.wet import wet_model

ROBOT = ROBOTS["floating_caiman"]


def acted(model, numbers, lake):
    """Return forces on the joints, the matrix and what the water says, of a robot bent and moving at the surface."""
    rng = np.random.default_rng(3)
    model.numeric_data[:] = numbers
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    data.qpos[2] = 0.05
    data.qpos[7:] += rng.normal(size=model.nq - 7, scale=0.3)
    data.qvel[:], data.qacc[:], data.time = rng.normal(size=model.nv), 0.0, 0.4
    data.userdata[:] = lake.numbers(np.array([0.0, 0.0, 1.0]))
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    passive = np.array(data.qfrc_passive)
    return np.concatenate(
        [passive, data.M, data.userdata[FORCE : FORCE + 4], data.userdata[SUBMERGED_VOLUME : SUBMERGED_VOLUME + 1]]
    )


def test_pieces_together_do_what_each_does_alone():
    """Some fill no whole block, some are dry, and in a wave the water moves differently at each."""
    wetting.install()
    table = pieces(ROBOT)
    assert len(table) > LANES
    assert len(table) % LANES
    model = wet_model(ROBOT, physics_step(ROBOT), None, len(table), acting=True)
    lake = Lake(level=0.06, wave=Wave(height=0.05, length=0.7, heading=0.4), current=(0.3, -0.2))
    whole = np.array(model.numeric_data)
    rows, length = unpack_table(whole), whole[2]
    try:
        without = acted(model, pack_table(rows[:0], length, len(rows)), lake)
        alone = [acted(model, pack_table(rows[i : i + 1], length, len(rows)), lake) - without for i in range(len(rows))]
        together = acted(model, whole, lake) - without
    finally:
        model.numeric_data[:] = whole
    dry = [one[-1] == 0.0 for one in alone]
    assert 0 < sum(dry) < len(dry)
    assert together == pytest.approx(np.sum(alone, axis=0), rel=1e-9, abs=1e-12 * np.abs(together).max())


@given(st.floats(-1.0, 1.0))
def test_the_arc_sine_is_the_librarys(x):
    assert _arcsine.py_func(x) == pytest.approx(asin(x), rel=5e-16, abs=0.0)


@pytest.mark.parametrize("x", [0.0, 0.5, nextafter(0.5, inf), nextafter(0.5, -inf), 1.0, -1.0, sin(1.5)])
def test_the_arc_sine_is_the_librarys_at_its_ends(x):
    assert _arcsine.py_func(x) == pytest.approx(asin(x), rel=5e-16, abs=0.0)
