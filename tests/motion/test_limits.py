"""What a gait asks of joints and servos, and whether a robot can give it; a gait as measured curves."""

from dataclasses import replace

import numpy as np
import pytest
from tests.metres import with_metres

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.design import crocodile, layout
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import (
    START,
    Bend,
    Curve,
    Gait,
    as_table,
    check_limits,
    check_speeds,
    cycle_targets,
    excess,
    intended,
    max_stroke_factor,
    min_gait_period,
    servo_parts,
    suits,
)
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement

ROBOT, CRAWL = ROBOTS["caiman"], GAITS["belly_crawl"]
WALKERS = ("caiman", "pleurobot", "salamander", "salamandra", "strider")
WALKS = [("caiman", "belly_crawl"), ("strider", "tripod"), ("salamandra", "salamandra_walk")]


def test_a_joint_out_of_range_is_named_with_angle_and_range(robot, crawl_gait):
    tables = robot.tables
    stiff = crocodile(replace(tables, spine=replace(tables.spine, yaw_range=(-0.1, 0.1))))
    with pytest.raises(OutsideLimits, match=r"asks spine_yaw_1 of robot 'caiman' for -?0\.\d+ rad; -0\.100 to 0\.100"):
        check_limits(stiff, crawl_gait)
    assert not suits(stiff, crawl_gait)
    assert suits(robot, crawl_gait)


def test_a_cable_that_is_bent_beyond_its_limit_is_refused_though_the_pulley_is_held(robot, crawl_gait):
    most = robot.tail.bend_limit
    check_limits(robot, crawl_gait.with_numbers(tail_bend=most))
    with pytest.raises(OutsideLimits, match=r"asks the hinges of cable tail_cable .* for a bend of"):
        check_limits(robot, crawl_gait.with_numbers(tail_bend=most + 1e-3))
    steady = replace(crawl_gait, axis=(*crawl_gait.axis, Bend(part="tail", offset=most)))
    with pytest.raises(OutsideLimits, match=r"asks the hinges of cable tail_cable .* for a bend of"):
        check_limits(robot, steady)


def test_a_servo_that_is_too_slow_is_named_with_the_shortest_period(robot, crawl_gait):
    shortest, servo = min_gait_period(robot, crawl_gait)
    check_speeds(robot, replace(crawl_gait, period=1.001 * shortest))
    with pytest.raises(OutsideLimits, match=rf"asks {servo} of robot 'caiman' for 7\.88 rad/s; .* 7\.87 rad/s at most"):
        check_speeds(robot, replace(crawl_gait, period=0.999 * shortest))


@pytest.mark.parametrize("name", WALKERS)
def test_the_longest_strokes_can_just_be_walked(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    most = max_stroke_factor(robot, gait)
    assert most >= 1.0
    check_limits(robot, gait.strode(most))
    if most < 7.9:
        with pytest.raises((OutsideLimits, InvalidDesign)):
            check_limits(robot, gait.strode(1.01 * most))


def test_longest_strokes_count_from_where_the_foot_stands(robot):
    walk = GAITS["high_walk"]
    assert max_stroke_factor(robot, walk) < max_stroke_factor(robot, with_metres(walk, front_ahead=0.0, hind_ahead=0.0))
    assert max_stroke_factor(ROBOTS["swimmer"], GAITS["undulation"]) == 1.0


def test_the_excess_is_none_where_a_robot_can_follow_and_grows_with_what_it_cannot(robot):
    assert excess(robot, CRAWL) == 0.0
    far, farther = (excess(robot, CRAWL.with_numbers(height=height)) for height in (1.2, 1.5))
    assert 0.0 < far < farther
    fast, faster = (excess(robot, replace(CRAWL, period=period)) for period in (0.1, 0.05))
    assert 0.0 < fast < faster
    bent = excess(robot, CRAWL.with_numbers(trunk_bend=4.0))
    assert bent > 0.0


@pytest.mark.parametrize(("name", "gait"), WALKS)
def test_a_cycle_is_what_is_intended_once_the_walk_has_begun(name, gait):
    robot, gait = ROBOTS[name], GAITS[gait]
    clock = np.linspace(0.0, 2.0, 9)
    there = intended(robot, gait, START + clock * gait.period).targets
    np.testing.assert_allclose(cycle_targets(robot, gait, clock), there, atol=1e-12)


def test_a_sawtooth_needs_the_time_of_its_steepest_side():
    speed = ROBOT.servo("LF_yaw").speed
    teeth = tuple(float(angle) for angle in np.interp(np.arange(200) / 200, [0.0, 0.75, 1.0], [0.0, 0.3, 0.0]))
    curve = Curve(servo="LF_yaw", part="limb", angles=teeth)
    gait = Gait(name="teeth", period=1.0, limb_phases=(0.0, 0.5, 0.5, 0.0), curves=(curve,))
    period, servo = min_gait_period(ROBOT, gait)
    assert servo == "LF_yaw"
    assert period == pytest.approx(0.3 / 0.25 / speed, rel=1e-6)


@pytest.mark.parametrize(("name", "gait"), WALKS[:2])
def test_the_shortest_period_is_the_one_at_which_a_servo_turns_as_fast_as_it_can(name, gait):
    robot, gait = ROBOTS[name], GAITS[gait]
    period, servo = min_gait_period(robot, gait)
    assert min_gait_period(robot, replace(gait, period=3.0 * gait.period)) == (period, servo)
    i = layout(robot).servos.index(servo)
    clock = np.arange(201) / 200
    assert np.abs(np.diff(cycle_targets(robot, gait, clock)[:, i])).max() * 200 / period == pytest.approx(
        robot.servo(servo).speed
    )


# a gait as measured curves


def test_the_crawl_as_a_table_commands_the_same_angles():
    table, time = as_table(ROBOT, CRAWL), START + np.linspace(0.0, 8.0, 3001)
    assert np.abs(intended(ROBOT, CRAWL, time).targets - intended(ROBOT, table, time).targets).max() < 0.002
    assert np.abs(intended(ROBOT, CRAWL, time).phase - intended(ROBOT, table, time).phase).max() < 1e-12
    coarse = as_table(ROBOT, CRAWL, 8)  # eight samples lose the corners of the feet's paths
    assert np.abs(intended(ROBOT, CRAWL, time).targets - intended(ROBOT, coarse, time).targets).max() > 0.01


def test_a_table_of_a_table_is_the_table():
    table = as_table(ROBOT, CRAWL)
    again = as_table(ROBOT, replace(table, name=CRAWL.name))
    assert [curve.servo for curve in again.curves] == [curve.servo for curve in table.curves]
    for here, there in zip(again.curves, table.curves, strict=True):
        np.testing.assert_allclose(np.broadcast_to(here.angles, 64), np.broadcast_to(there.angles, 64), atol=2e-6)


def test_every_servo_moves_one_part_of_the_body():
    parts = servo_parts(ROBOT)
    assert list(parts) == list(layout(ROBOT).servos)
    assert {name: part for name, part in parts.items() if part != "limb"} == {
        **dict.fromkeys(("spine_yaw_1", "spine_pitch_1", "spine_yaw_2", "spine_pitch_2", "spine_yaw_3"), "trunk"),
        **dict.fromkeys(("tail_pitch", "tail_cable"), "tail"),
    }
    assert servo_parts(ROBOTS["salamander"])["neck_yaw_1"] == "neck"


@pytest.mark.parametrize("up", [-0.2, 0.2])
def test_a_vertical_angle_in_a_table_bends_the_spine_up_or_down(up):
    table = as_table(ROBOT, CRAWL)
    names = [name for name in layout(ROBOT).servos if name.startswith("spine_pitch")]
    pitched = (Curve(servo=name, part="trunk", angles=(-up / 2,)) for name in names)
    bent = replace(table, curves=(*table.curves, *pitched))
    record = simulate([Run(robot=ROBOT, gait=table), Run(robot=ROBOT, gait=bent)], duration=1.6, timestep=0.005)
    angle = record.joint_angle.sel(joint=names).sum("joint").isel(time=-1)  # down is positive
    assert float(angle[1] - angle[0]) == pytest.approx(-up, abs=0.08)


def test_the_crawl_by_table_goes_as_far_as_the_crawl():
    runs = [Run(robot=ROBOT, gait=gait) for gait in (CRAWL, as_table(ROBOT, CRAWL))]
    record = simulate(runs, duration=START + CRAWL.period, timestep=0.005)
    plain, table = displacement(record).sel(xyz="x").values
    assert table == pytest.approx(plain, rel=0.01)
