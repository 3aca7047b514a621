"""Heading and depth held while swimming: signs and limits by hand, a plant of one line, then the water."""

from dataclasses import replace

import numpy as np
import pytest
from tests.felt import felt as feels
from tests.start_batch import start_batch
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.rotation import from_axis_angle
from suchus.robot.control import DepthHold, HeadingHold, Swimming
from suchus.robot.control.holding import DepthHolds, HeadingHolds, neutral_air_fraction
from suchus.robot.design import WATER_DENSITY
from suchus.robot.design.pieces import volumes
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate

ROBOT, PERIOD = ROBOTS["floating_caiman"], 0.01
WAVE = crocodile_swim()
UP = np.array([0.0, 0.0, 1.0])


def sensed(*, yaw=0.0, depth=0.0):
    """What a robot feels that faces to the left by ``yaw``."""
    return feels(ROBOT, orientation=from_axis_angle(UP, yaw), depth=depth)


def test_neutral_air_fraction_weighs_what_it_displaces():
    spare = sum(volumes(ROBOT).values()) - (1.0 - neutral_air_fraction(ROBOT)) * ROBOT.hull.air
    assert spare * WATER_DENSITY == pytest.approx(ROBOT.mass, rel=1e-9)
    assert 0.0 < neutral_air_fraction(ROBOT) < 1.0


@pytest.mark.parametrize("turned", [0.2, -0.2])
def test_it_bends_against_the_side_to_which_it_has_turned_and_no_farther_than_its_bends(turned):
    hold = HeadingHolds([HeadingHold(gain=2.0, integral_gain=0.0)], [ROBOT], [1], PERIOD)
    hold.bend(sensed())
    tail, trunk = hold.bend(sensed(yaw=turned))
    assert tail[0] == pytest.approx(-0.6 * 2.0 * turned)
    assert trunk[0] == pytest.approx(-0.3 * 2.0 * turned)
    tail, _ = hold.bend(sensed(yaw=5.0 * turned))
    assert tail[0] == pytest.approx(-0.6 * np.sign(turned))


def test_a_turn_to_and_fro_within_a_cycle_is_not_steered_against():
    hold = HeadingHolds([HeadingHold(integral_gain=0.0)], [ROBOT], [100], PERIOD)
    bends = [hold.bend(sensed(yaw=0.1 * np.sin(2 * np.pi * i / 100) + 1e-12))[0][0] for i in range(400)]
    assert np.abs(bends[200:]).max() < 1e-3
    assert np.abs(bends[:80]).max() > 0.02


def heading_after(rule, seconds, disturbance=0.0):
    """Return the error of the heading over time of a body that turns by 0.2 rad/s at the full bend, with a lag."""
    hold, yaw, rate, found = HeadingHolds([rule], [ROBOT], [100], PERIOD), 0.0, 0.0, []
    for _ in range(round(seconds / PERIOD)):
        tail, _ = hold.bend(sensed(yaw=yaw + 1e-12))
        rate += PERIOD / 0.5 * (0.2 * tail[0] / 0.6 + disturbance - rate)
        yaw += PERIOD * rate
        found.append(yaw - rule.direction)
    return np.array(found)


def test_the_error_of_the_heading_settles_within_two_hundredths():
    held = heading_after(HeadingHold(direction=0.5), 40.0)
    free = heading_after(HeadingHold(direction=0.5, gain=0.0, integral_gain=0.0), 40.0)
    assert np.abs(held[-500:]).max() < 0.02
    assert np.abs(free[-500:]).min() > 0.4


def test_what_pushes_to_one_side_all_the_time_is_learnt():
    held = heading_after(HeadingHold(), 120.0, disturbance=0.05)
    without = heading_after(HeadingHold(integral_gain=0.0), 120.0, disturbance=0.05)
    assert np.abs(held[-500:]).max() < 0.02
    assert np.abs(without[-500:]).min() > 0.1


def depth_after(rule, seconds, leak=0.0):
    """Return depth and air fraction over time of a body that weighs as the air says and meets quadratic drag."""
    hold, z, w, found = DepthHolds([rule], [ROBOT], PERIOD), 0.09, 0.0, []
    neutral = neutral_air_fraction(ROBOT)
    for _ in range(round(seconds / PERIOD)):
        air_fraction = hold.air_fraction(sensed(depth=z))[0]
        down = -(air_fraction - neutral) * ROBOT.hull.air * 1000 * 9.81 + leak
        w += PERIOD * (down - 30.0 * abs(w) * w) / 9.0
        z = max(z + PERIOD * w, 0.0)
        found.append((z, air_fraction))
    return np.array(found).T


def test_the_error_of_the_depth_settles_within_two_centimetres():
    depth, air_fraction = depth_after(DepthHold(depth=0.6), 40.0)
    assert np.abs(depth[-500:] - 0.6).max() < 0.02
    assert depth.max() < 0.8
    assert ((air_fraction >= 0.0) & (air_fraction <= 1.0)).all()
    assert np.abs(np.diff(air_fraction)).max() <= 0.25 * PERIOD + 1e-12
    floats, _ = depth_after(DepthHold(depth=0.6, gain=0.0, rate_gain=0.0, integral_gain=0.0), 40.0)
    assert np.abs(floats[-500:] - 0.6).min() > 0.1


def test_the_way_down_is_not_learnt_and_not_overshot():
    depth, _ = depth_after(DepthHold(depth=0.6), 25.0)
    learning, _ = depth_after(DepthHold(depth=0.6, near=1000.0), 25.0)
    assert depth.max() < 0.62
    assert learning.max() > 0.63


def test_a_weight_that_is_not_known_is_learnt():
    held, _ = depth_after(DepthHold(depth=0.6), 120.0, leak=0.5)
    without, _ = depth_after(DepthHold(depth=0.6, integral_gain=0.0), 120.0, leak=0.5)
    assert np.abs(held[-500:] - 0.6).max() < 0.02
    assert np.abs(without[-500:] - 0.6).min() > 0.03


def test_a_swim_holds_heading_and_depth_in_the_water():
    held = Swimming(heading=HeadingHold(direction=0.4), depth=DepthHold(depth=0.5))
    runs = [Run(robot=ROBOT, gait=WAVE, lake=Lake(level=2.0), control=control) for control in (held, Swimming())]
    record = simulate(runs, duration=20.0, timestep=0.005, sample_stride=10)
    end = record.sel(time=slice(17.0, None))
    course = end.centre_of_mass.isel(time=-1) - end.centre_of_mass.isel(time=0)
    heading = np.arctan2(course.sel(xyz="y"), course.sel(xyz="x")).values
    depth = (end.water_level - end.position.sel(xyz="z")).values
    assert heading[0] == pytest.approx(0.4, abs=0.1)
    assert abs(heading[1] - 0.4) > 0.2
    assert np.abs(depth[0] - 0.5).max() < 0.05
    assert depth[1].max() < 0.2


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: DepthHold(depth=-1.0), InvalidDesign, "depth_hold.depth is -1 m"),
        (lambda: DepthHold(depth=1.0, near=-0.1), InvalidDesign, "depth_hold.near is -0.1 m"),
        (lambda: DepthHold(depth=1.0, pump=0.0), InvalidDesign, "depth_hold.pump is 0 1/s"),
        (lambda: HeadingHold(direction=9.0), InvalidDesign, "heading_hold.direction is 9 rad"),
        (lambda: neutral_air_fraction(ROBOTS["caiman"]), InvalidDesign, "give it a design.Hull with as much air"),
        (
            lambda: neutral_air_fraction(replace(ROBOT, hull=replace(ROBOT.hull, air=1e-5))),
            InvalidDesign,
            "would have to let out",
        ),
        (
            lambda: start_batch(
                Swimming(heading=HeadingHold(trunk_turn=3.0)),
                [ROBOT],
                [WAVE],
                [0],
                10,
                PERIOD,
            ),
            OutsideLimits,
            "spine_yaw_1 of robot",
        ),
    ],
)
def test_what_cannot_be_held_is_refused_in_a_sentence(make, error, message):
    with pytest.raises(error, match=message):
        make()
