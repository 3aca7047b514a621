"""Divided time steps: the same bytes as with a smaller step, for every simulation, and as before after the block."""

import numpy as np
import pytest

from suchus import GAITS, ROBOTS
from suchus.core.errors import InvalidDesign
from suchus.hardware.emulator.body import EmulatedBody
from suchus.robot.control import Coordinated
from suchus.robot.gaits import default_gait
from suchus.sim.land import Live, Run, divide_steps, simulate
from suchus.sim.land.float_body import FloatTank
from suchus.sim.land.stand import on_stand

CAIMAN = ROBOTS["caiman"]


def walk(robot, timestep=None):
    """Return the record of a short walk in the robot's own gait."""
    return simulate([Run(robot=robot, gait=default_gait(robot))], duration=0.2, timestep=timestep)


@pytest.mark.parametrize("name", ["caiman", "salamander", "strider"])
def test_a_divided_step_is_the_smaller_step_to_the_byte(name):
    robot = ROBOTS[name]
    plain = walk(robot)
    with divide_steps(4) as division:
        divided = walk(robot)
    assert division.simulations == 1
    assert divided.timestep == pytest.approx(plain.timestep / 4)
    assert divided.control_period == plain.control_period
    assert divided.identical(walk(robot, divided.timestep))
    assert np.array_equal(divided.time, plain.time)
    assert not np.array_equal(divided.position, plain.position)
    assert walk(robot).identical(plain)


def test_a_step_that_is_given_is_divided_too_and_contexts_multiply():
    with divide_steps(2), divide_steps(3):
        assert walk(CAIMAN, 0.006 / 0.6).timestep == pytest.approx(0.01 / 6)
    with pytest.raises(ZeroDivisionError), divide_steps(2):
        raise ZeroDivisionError
    assert walk(CAIMAN, 0.005).timestep == 0.005


def test_live_walks_and_emulated_robots_take_the_divided_step():
    gait = GAITS["belly_crawl"]
    with divide_steps(2) as division:
        live, body = Live(Run(robot=CAIMAN, gait=gait, control=Coordinated())), EmulatedBody(CAIMAN, gait)
    assert division.simulations == 2
    assert (live._loop.steps, body._loop.steps) == (10, 10)


def test_a_joint_on_a_stand_has_the_same_samples():
    count = 100
    settings = {"target": np.full(count, 0.3), "load": np.zeros(count), "gripped": np.zeros(count, bool)}
    plain = on_stand(CAIMAN, "LH_pitch", **settings)
    with divide_steps(4):
        divided = on_stand(CAIMAN, "LH_pitch", **settings)
    assert np.array_equal(divided.time, plain.time)
    assert np.abs(divided.angle - plain.angle).max() == pytest.approx(0.0, abs=0.01)
    assert not np.array_equal(divided.angle, plain.angle)


def test_a_floating_body_has_the_same_samples():
    from suchus.experiments.catalog.floating.cases import BOX, SURFACE_LAKE  # noqa: PLC0415

    def motion():
        tank = FloatTank(BOX, SURFACE_LAKE, timestep=0.004)
        return tank.model.opt.timestep, tank.watch(0.04, 0.004)

    (step, plain), divided_step = motion(), None
    with divide_steps(2):
        divided_step, divided = motion()
    assert divided_step == step / 2
    assert np.array_equal(divided.time, plain.time)


@pytest.mark.parametrize("divisor", [0, -1, 1.5, 1001, float("nan")])
def test_other_divisors_are_refused(divisor):
    with pytest.raises(InvalidDesign, match="divisor"), divide_steps(divisor):
        pass
