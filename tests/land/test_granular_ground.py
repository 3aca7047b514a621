"""Runs on grains: any robot sinks in, is carried and walks; the ground stands in the record."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from tests.bodies import eel, hatchling, six

from suchus.core.errors import InvalidDesign
from suchus.robot.design.ground import Grains
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import ARENAS, WATER, Ground, Lake, Run, simulate
from suchus.sim.metrics import displacement, duty_factor
from suchus.sim.metrics.contact import ground_force
from suchus.sim.record.schema import ground_of

FIRM = Ground(grains=Grains(strength=2e6))


def test_a_crawl_on_grains_is_carried_and_slower_the_softer_they_are(robot, crawl_gait):
    grounds = [Ground(), FIRM, ARENAS["sand"]]
    runs = [Run(robot=robot, gait=crawl_gait, ground=ground) for ground in grounds]
    record = simulate(runs, duration=9.0, timestep=0.005)
    hard, firm, soft = displacement(record).sel(xyz="x").values
    assert hard > 1.2 * firm > 2.0 * soft > 0.0
    weight = ground_force(record).sel(xyz="z", time=slice(5.0, None)).mean("time") / (record.mass * 9.81)
    assert weight.values == pytest.approx(1.0, abs=0.02)
    sunk = record.foot_position.sel(xyz="z").min(["time", "leg"]).values
    assert sunk[0] > 0.0 > sunk[1] > sunk[2]
    assert (duty_factor(record).values[1] > 0.4).all()
    assert record.tail_force.sel(xyz="z").max() > 0.0
    assert ground_of(record.isel(run=2)) == ARENAS["sand"]
    assert ground_of(record.isel(run=0)) == Ground()


def test_the_time_step_hardly_matters(robot, crawl_gait):
    ways = [
        displacement(simulate([Run(robot=robot, gait=crawl_gait, ground=FIRM)], duration=5.0, timestep=step))
        .sel(xyz="x")
        .item()
        for step in (0.002, 0.005)
    ]
    assert ways[1] == pytest.approx(ways[0], rel=0.05)


def test_the_factor_on_friction_is_one_on_the_strength(robot, crawl_gait):
    grounds = [
        Ground(friction_scale=2.0, grains=Grains(strength=0.2e6)),
        Ground(grains=Grains(strength=0.4e6)),
    ]
    runs = [Run(robot=robot, gait=crawl_gait, ground=ground) for ground in grounds]
    together = simulate(runs, duration=2.0, timestep=0.005)
    alone = simulate(runs[1:], duration=2.0, timestep=0.005)
    for run in (together.isel(run=0), together.isel(run=1)):
        np.testing.assert_array_equal(run.joint_angle.values, alone.joint_angle.isel(run=0).values)


BODIES = {"six": six(), "hatchling": hatchling(), "strider": ROBOTS["strider"]}


@pytest.mark.parametrize("name", BODIES)
def test_any_body_walks_on_grains(name):
    robot = BODIES[name]
    grains = Grains(strength=2e6)
    run = Run(robot=robot, gait=default_gait(robot), ground=Ground(grains=grains))
    record = simulate([run], duration=3.0)
    assert record.cause.item() == ""
    weight = ground_force(record).sel(xyz="z", time=slice(1.0, None)).mean("time") / (record.mass * 9.81)
    assert weight.values == pytest.approx(1.0, abs=0.06)


def test_a_legless_body_lies_in_grains():
    record = simulate([Run(robot=eel(), gait=default_gait(eel()), ground=ARENAS["sand"])], duration=2.0)
    assert record.cause.item() == ""
    assert -0.1 < (record.centre_of_mass.sel(xyz="z").isel(time=-1).item()) < 0.1


def test_fast_physics_knows_the_grains_too(robot, crawl_gait):
    run = Run(robot=robot, gait=crawl_gait, ground=FIRM)
    full, fast = (
        displacement(simulate([run], duration=5.0, timestep=0.005, fast=fast)).sel(xyz="x").item()
        for fast in (False, True)
    )
    assert fast == pytest.approx(full, rel=0.05)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"uphill": radians(5)}, "grains are level and even"),
        ({"relief": ARENAS["bumps"].relief}, "grains are level and even"),
    ],
)
def test_grains_on_a_slope_or_a_relief_are_refused(settings, words):
    with pytest.raises(InvalidDesign, match=words):
        replace(ARENAS["sand"], **settings)


@pytest.mark.parametrize("surroundings", [{"lake": Lake(level=0.1)}, {"afloat": WATER}])
def test_grains_under_water_are_refused(robot, surroundings):
    with pytest.raises(InvalidDesign, match="a robot on grains is dry"):
        Run(robot=robot, gait=GAITS["belly_crawl"], ground=ARENAS["sand"], **surroundings)


def test_a_strength_that_no_grains_have_is_refused():
    with pytest.raises(InvalidDesign, match="strength"):
        Grains(strength=0.0)
