from dataclasses import replace

import numpy as np
import pytest

from suchus.robot.design import crocodile, with_speed_line
from suchus.robot.gaits import GAITS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement, heading_change, roll_peak_to_peak, time_window

NAMES = ("low_crawl", "semi_erect", "high_walk")


@pytest.fixture(scope="module")
def limited(former):
    front, hind = (
        replace(leg, servo=with_speed_line(leg.servo)) for leg in (former.tables.front_leg, former.tables.hind_leg)
    )
    return crocodile(replace(former.tables, name="limited", front_leg=front, hind_leg=hind))


@pytest.fixture(scope="module")
def walks(robot):
    return simulate(
        [Run(robot=robot, gait=GAITS[name]) for name in NAMES], duration=7.0, sample_stride=2, timestep=0.005
    )


def test_postures_reach_their_speeds_on_even_ground(walks):
    speed = displacement(walks, 2.0).sel(xyz="x").values / 5.0
    for reached, (low, high) in zip(speed, ((0.18, 0.24), (0.18, 0.30), (0.08, 0.14)), strict=True):
        assert low < reached < high


def test_postures_are_steady_straight_and_off_the_belly(walks):
    assert np.degrees(roll_peak_to_peak(walks, 2.0).values).max() < 10
    assert np.degrees(abs(heading_change(walks)).values).max() < 5
    assert float(time_window(walks, 2.0).belly_force.sel(xyz="z").max()) == 0.0


def test_the_body_rises_from_crawl_to_high_walk(walks):
    height = time_window(walks, 2.0).centre_of_mass.sel(xyz="z").mean("time").values
    assert height[0] < height[1] - 0.03 < height[2] - 0.04


def test_a_torque_speed_line_costs_the_postures_no_speed_and_makes_the_fastest_joints_slower(former, limited):
    hasty = [replace(GAITS[name], period=min(GAITS[name].period, 0.8)) for name in NAMES[1:]]
    runs = [Run(robot=who, gait=gait) for who in (former, limited) for gait in hasty]
    walks = simulate(runs, duration=5.0, sample_stride=2, timestep=0.005)
    way = displacement(walks, 2.0).sel(xyz="x").values
    assert way[2:] == pytest.approx(way[:2], rel=0.05)
    legs = (
        abs(time_window(walks, 2.0).servo_velocity.isel(servo=slice(0, 12)))
        .quantile(0.99, ["time"])
        .max("servo")
        .values
    )
    fast = legs[:2] > limited.hind_leg.servo.speed
    assert fast.any()
    assert (legs[2:][fast] < legs[:2][fast]).all()
    assert (legs[2:][~fast] < limited.hind_leg.servo.speed).all()
