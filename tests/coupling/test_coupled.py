"""Robot and flow together: momentum, energy and what is left over, repeats, and what is refused."""

from functools import cache

import numpy as np
import pytest

import suchus
from suchus.control import Swimming
from suchus.coupling import Swim, simulate
from suchus.errors import InvalidDesign, UnknownName
from suchus.land import Ground, Lake, Run
from suchus.land.waters import Sections, Slice, Space
from suchus.record import COUPLED, WATER
from suchus.water import swim_of

SLICE = Slice(cells=64, reynolds=1500.0)


def swim_run(name="swimmer", water=SLICE, **changes):
    robot = suchus.ROBOTS[name]
    return Run(robot=robot, gait=swim_of(robot, frequency=1.0), water=water, control=Swimming(ramp=0.5), **changes)


@cache
def swum():
    """A short swim of the limbless swimmer in a slice."""
    return simulate([swim_run()], duration=0.3).isel(run=0)


def test_the_robots_momentum_is_the_impulse_of_the_water():
    record = swum()
    dt = float(record.time[1] - record.time[0])
    impulse = record.water_force.values[:, :2].cumsum(axis=0) * dt
    speed = np.gradient(record.centre_of_mass.values[:, :2], dt, axis=0)
    momentum = float(record.mass) * speed
    apart = np.abs(momentum - impulse)[2:-2].max()
    assert apart < 0.05 * np.abs(momentum).max()


def test_energy_closes_and_little_is_left_over():
    record = swum()
    assert float(abs(record.energy_error[-1])) < 0.03
    assert float(abs(record.power_error[-1])) < 0.05
    assert float(record.coupling_residual[5:].max()) < 2e-2
    assert float(record.coupling_first[5:].max()) > 2 * float(record.coupling_residual[5:].max())
    assert {*WATER, *COUPLED} <= {*record.data_vars}
    assert np.isfinite(record.link_force.values).all()
    assert record.water_force.values == pytest.approx(record.link_force.values.sum(axis=1))


def test_a_run_in_a_flow_keeps_to_its_rung():
    run = swim_run(water="slice")
    assert run.solved == Slice()
    assert swim_run(water="space").solved == Space()
    assert swim_run("floating_caiman", water="sections").lake == Lake(level=2 * suchus.ROBOTS["floating_caiman"].length)
    with pytest.raises(UnknownName, match="sections, slice, space"):
        swim_run(water="tank")
    with pytest.raises(InvalidDesign, match=r"give the runs to suchus\.coupling\.simulate"):
        suchus.simulate([run], duration=0.1)
    with pytest.raises(InvalidDesign, match="neither surface nor ground"):
        swim_run(ground=Ground(uphill=0.1))
    with pytest.raises(InvalidDesign, match="two different lakes"):
        swim_run(water=Sections(lake=Lake(level=1.0)), lake=Lake(level=2.0))
    with pytest.raises(InvalidDesign, match=r"slice.cells is 8; a whole number of 32 to 4096"):
        Slice(cells=8)


@pytest.mark.parametrize(("robot", "gait", "why"), [
    ("strider", "tripod", "gait 'tripod' strokes with a limb: servo LF_yaw"),
    ("floating_caiman", "belly_crawl", "strokes with a limb"),
])  # fmt: skip
def test_a_gait_that_the_flow_cannot_see_is_refused(robot, gait, why):
    with pytest.raises(InvalidDesign, match=why):
        Swim(Run(robot=robot, gait=gait, water="slice"), 0.1)
