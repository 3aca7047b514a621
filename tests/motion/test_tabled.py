"""A movement written as a table of servo angles."""

from dataclasses import replace

import numpy as np
import pytest

from suchus import blueprint
from suchus.design import layout
from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.metrics import displacement, vertical_bend
from suchus.motion import START, AngleTable, Curve, as_table, intended
from suchus.robots import ROBOTS

ROBOT, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]


def test_the_crawl_as_a_table_commands_the_same_angles():
    table, time = as_table(ROBOT, CRAWL), START + np.linspace(0.0, 8.0, 3001)
    assert np.abs(intended(ROBOT, CRAWL, time).targets - intended(ROBOT, table, time).targets).max() < 0.002
    assert np.abs(intended(ROBOT, CRAWL, time).phase - intended(ROBOT, table, time).phase).max() < 1e-12
    coarse = as_table(ROBOT, CRAWL, 8)  # eight samples lose the corners of the feet's paths
    assert np.abs(intended(ROBOT, CRAWL, time).targets - intended(ROBOT, coarse, time).targets).max() > 0.01


def test_a_table_of_a_table_is_the_table_and_reads_back_from_its_file(tmp_path):
    table = as_table(ROBOT, CRAWL)
    again = as_table(ROBOT, replace(table, name=CRAWL.name))
    assert [one.servo for one in again.curves] == [one.servo for one in table.curves]
    for one, two in zip(again.curves, table.curves, strict=True):
        np.testing.assert_allclose(np.broadcast_to(one.angles, 64), np.broadcast_to(two.angles, 64), atol=2e-6)
    path = blueprint.write(table, tmp_path / "crawl.toml")
    assert blueprint.read(path, AngleTable, GAITS) == table


@pytest.mark.parametrize("up", [-0.2, 0.2])
def test_a_vertical_angle_in_a_table_bends_the_spine_up_or_down(up):
    table = as_table(ROBOT, CRAWL)
    names = [name for name in layout(ROBOT).servos if name.startswith("spine_pitch")]
    bent = replace(table, curves=(*table.curves, *(Curve(servo=name, angles=(-up / 2,)) for name in names)))
    record = simulate([Run(robot=ROBOT, gait=table), Run(robot=ROBOT, gait=bent)], duration=1.6, timestep=0.005)
    found = vertical_bend(record, "spine").isel(time=-1)  # down is positive
    assert float(found[1] - found[0]) == pytest.approx(-up, abs=0.08)


def test_the_crawl_by_table_goes_as_far_as_the_crawl():
    runs = [Run(robot=ROBOT, gait=gait) for gait in (CRAWL, as_table(ROBOT, CRAWL))]
    record = simulate(runs, duration=START + CRAWL.period, timestep=0.005)
    one, two = displacement(record).sel(xyz="x").values
    assert two == pytest.approx(one, rel=0.01)
