"""Robots as they are built: errors that have no direction of their own, drawn by a seed, and what they do to a walk."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign
from suchus.robot.design import servo_names
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, Tolerances, simulate

NONE = Tolerances(zero_error=0.0, dead_band=0.0, backlash=0.0, friction=0.0, mass=0.0)
COARSE = 0.005


@pytest.fixture
def run(robot, crawl_gait):
    return Run(robot=robot, gait=crawl_gait)


@pytest.mark.parametrize("name", ["caiman", "strider", "salamander"])
def test_errors_lie_evenly_about_the_design(name):
    robot = ROBOTS[name]
    run = Run(robot=robot, gait=default_gait(robot), ground=Ground(friction_scale=0.5))
    sizes = Tolerances()
    built = sizes.repeats([run], 200, seed=3)
    zero = np.array([one.zero_error for one in built])
    play = np.array([one.play for one in built])
    grip = np.array([one.ground.friction_scale for one in built]) / 0.5
    mass = np.array([one.robot.mass for one in built]) / robot.mass
    assert zero.shape == play.shape == (200, len(servo_names(robot)))
    assert abs(zero).max() <= sizes.zero_error
    assert abs(zero.mean()) < 0.05 * sizes.zero_error
    assert 0.0 <= play.min() <= play.max() <= sizes.dead_band + sizes.backlash
    for factor, size in ((grip, sizes.friction), (mass, sizes.mass)):
        assert 0.0 < abs(factor - 1.0).max() <= size
        assert factor.mean() == pytest.approx(1.0, abs=0.2 * size)


def test_no_errors_give_the_design(run):
    (built,) = NONE.repeats([run], 1)
    assert (built.robot, built.ground) == (run.robot, run.ground)
    exact, same = simulate([run, built], duration=1.5, timestep=COARSE).centre_of_mass
    assert (exact.values == same.values).all()


def test_the_repeats_of_two_conditions_have_the_same_errors_and_other_seeds_others(run):
    limbs = replace(run, gait=GAITS["limbs_only"])
    built = Tolerances().repeats([run, limbs], 3, seed=1)
    for one, other in zip(built[:3], built[3:], strict=True):
        assert replace(one, gait=limbs.gait) == other
    assert len({one.zero_error for one in built[:3]}) == 3
    assert Tolerances().repeats([run], 3, seed=1) == built[:3]
    assert Tolerances().repeats([run], 3, seed=2) != built[:3]


def test_a_zero_error_moves_the_command_and_a_play_holds_it_back(run):
    servos = len(servo_names(run.robot))
    shifted = replace(run, zero_error=(0.02, *(0.0,) * (servos - 1)))
    lazy = replace(run, play=(0.04,) * servos)
    record = simulate([run, shifted, lazy], duration=1.0 + run.gait.period, timestep=COARSE)
    exact, moved, held = record.servo_target.transpose("run", "time", "servo").values
    assert moved - exact == pytest.approx(np.array([0.02, *(0.0,) * (servos - 1)])[None].repeat(len(exact), 0))
    assert abs(held - exact).max() <= 0.02 + 1e-12
    assert abs(held - exact).max() == pytest.approx(0.02)
    still = np.diff(exact, axis=0) == 0.0
    assert (np.diff(held, axis=0)[still] == 0.0).all()
    turns = np.abs(np.diff(held, axis=0)).sum(0)
    assert (turns <= np.abs(np.diff(exact, axis=0)).sum(0) + 1e-12).all()


def test_errors_that_no_servo_has_are_refused(run):
    with pytest.raises(InvalidDesign, match=r"zero_error has 2 values, and caiman \d+ servos"):
        replace(run, zero_error=(0.1, 0.1))
    servos = len(servo_names(run.robot))
    with pytest.raises(InvalidDesign, match=r"play is .*each of its values must be from 0 to 1 rad"):
        replace(run, play=(-0.1,) * servos)
    with pytest.raises(InvalidDesign, match=r"zero_error is .*from -1 to 1 rad"):
        replace(run, zero_error=(pi,) * servos)
    with pytest.raises(InvalidDesign, match=r"tolerances\.mass is 1"):
        Tolerances(mass=1.0)
