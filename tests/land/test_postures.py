from dataclasses import replace

import numpy as np
import pytest

from suchus.design import crocodile, with_speed_line
from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.metrics import between, displacement, heading_change, roll_peak_to_peak

NAMES = ("low_crawl", "semi_erect", "high_walk")


@pytest.fixture(scope="module")
def limited(robot):
    front, hind = (
        replace(leg, servo=with_speed_line(leg.servo)) for leg in (robot.tables.front_leg, robot.tables.hind_leg)
    )
    return crocodile(replace(robot.tables, name="limited", front_leg=front, hind_leg=hind))


@pytest.fixture(scope="module")
def walks(robot, limited):
    runs = [Run(robot=who, gait=GAITS[name]) for who in (robot, limited) for name in NAMES]
    return simulate(runs, duration=7.0, every=2, timestep=0.005)


def test_postures_reach_their_speeds_on_even_ground(walks):
    speed = displacement(walks, 2.0).sel(xyz="x").values[:3] / 5.0
    for reached, (low, high) in zip(speed, ((0.18, 0.24), (0.20, 0.44), (0.12, 0.22)), strict=True):
        assert low < reached < high


def test_postures_are_steady_straight_and_off_the_belly(walks):
    assert np.degrees(roll_peak_to_peak(walks, 2.0).values).max() < 10
    assert np.degrees(abs(heading_change(walks)).values).max() < 5
    assert float(between(walks, 2.0).belly_force.sel(xyz="z").max()) == 0.0


def test_the_body_rises_from_crawl_to_high_walk(walks):
    height = between(walks, 2.0).centre_of_mass.sel(xyz="z").mean("time").values[:3]
    assert height[0] < height[1] - 0.03 < height[2] - 0.04


def test_a_torque_speed_line_costs_the_postures_no_speed_and_makes_the_fastest_joints_slower(walks, limited):
    way = displacement(walks, 2.0).sel(xyz="x").values
    assert way[3:] == pytest.approx(way[:3], rel=0.05)
    legs = abs(between(walks, 2.0).servo_velocity.isel(servo=slice(0, 12))).quantile(0.99, ["time"]).max("servo").values
    fast = legs[:3] > limited.hind_leg.servo.speed
    assert fast.any()
    assert (legs[3:][fast] < legs[:3][fast]).all()
    assert (legs[3:][~fast] < limited.hind_leg.servo.speed).all()
