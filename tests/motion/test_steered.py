"""Gaits of any body with phases, strokes, heights and bends of their own; and with one thing changed."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.control import Coordinated, OpenLoop, Walking
from suchus.control.limbs import LAWS
from suchus.design import layout
from suchus.errors import OutsideLimits
from suchus.gaits import GAITS, own_gait
from suchus.motion import (
    AngleTable,
    Gait,
    axis_bends,
    check_limits,
    longest_strokes,
    pattern_targets,
    steerable,
    steered,
    straightened,
    strides,
    with_axis_lag,
    with_bends,
    with_strokes,
)
from suchus.motion.transition import transition
from suchus.robots import ROBOTS

BODIES = ("pleurobot", "salamander", "salamandra", "strider", "swimmer")
WALKERS = BODIES[:-1]


def plain(robot, gait, clock, **changes):
    phase = np.asarray(clock)[..., None] + np.array(gait.limb_phases)
    one = {
        "trunk": np.zeros_like(clock),
        "size": np.ones_like(clock),
        "stroke": np.ones_like(phase),
        "lower": 0.0 * phase,
    }
    return steered(robot, gait, phase, **(one | changes))


@settings(max_examples=15)
@given(st.sampled_from(WALKERS), st.floats(0.0, 3.0))
def test_with_nothing_asked_it_is_the_gait_itself(name, clock):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    at = np.array([clock, clock + 0.3])
    assert plain(robot, gait, at) == pytest.approx(pattern_targets(robot, gait, at), abs=1e-9)


@pytest.mark.parametrize("name", WALKERS)
@pytest.mark.parametrize("control", [Walking(), Coordinated(limbs=LAWS["off"], spine=None, tail=None)])
def test_controllers_without_a_rule_command_the_open_loop(name, control):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    ours, theirs = (c.start([robot], [gait], [0], 200, 0.01) for c in (control, OpenLoop()))
    for tick in (0, 100, 137, 199):
        one, other = ours.command(tick, None), theirs.command(tick, None)
        assert one.phase == pytest.approx(other.phase)
        assert one.targets == pytest.approx(other.targets, abs=1e-9)


@pytest.mark.parametrize("name", WALKERS)
def test_a_steady_bend_is_shared_out_over_the_trunk_and_nothing_else_moves(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    clock, yaw = np.array([0.2]), list(layout(robot).trunk_yaw)
    change = plain(robot, gait, clock, trunk=np.array([0.1])) - plain(robot, gait, clock)
    assert change[0, yaw] == pytest.approx(0.1 / len(yaw))
    assert np.delete(change[0], yaw) == pytest.approx(0.0)


@pytest.mark.parametrize("name", ["pleurobot", "salamander", "strider"])
def test_a_shorter_stroke_on_one_side_moves_the_limbs_of_that_side_alone(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    place, clock = layout(robot), np.array([0.05])
    left = np.array([[0.5 if limb.side > 0 else 1.0 for limb in place.limbs]])
    change = abs(plain(robot, gait, clock, stroke=left) - plain(robot, gait, clock))[0]
    moved = {limb.name for limb in place.limbs if change[limb.servos].max() > 1e-6}
    assert moved == {limb.name for limb in place.limbs if limb.side > 0}


@pytest.mark.parametrize("name", [*BODIES, "caiman"])
def test_bends_of_trunk_and_tail_are_the_sums_of_the_hinges(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    place, clock = layout(robot), np.linspace(0.0, 1.0, 7)
    phase = clock[:, None] + np.array(gait.limb_phases)
    if not place.limbs:
        return  # without limbs nobody tells the clock
    trunk, tail = axis_bends(robot, gait, phase)
    if isinstance(gait, Gait):
        assert abs(trunk).max() == pytest.approx(gait.trunk_bend, rel=0.05)
        return
    told = pattern_targets(robot, gait, clock)
    assert trunk == pytest.approx(told[:, list(place.trunk_yaw)].sum(axis=1), abs=1e-9)
    assert tail == pytest.approx(told[:, list(place.tail_yaw)].sum(axis=1), abs=1e-9)


@pytest.mark.parametrize("name", [*BODIES, "caiman"])
def test_a_share_of_one_and_a_lag_of_nothing_change_nothing(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    assert with_strokes(gait, 1.0) == gait
    assert with_bends(robot, gait, 1.0) == gait
    assert with_axis_lag(robot, gait, 0.0) == gait


@pytest.mark.parametrize("name", BODIES)
def test_what_is_held_straight_bends_no_more_and_the_rest_as_before(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    place, clock = layout(robot), np.linspace(0.0, 1.0, 9)
    whole = pattern_targets(robot, gait, clock)
    ahead = [i for i in place.axial_yaw if i not in place.tail_yaw]
    for trunk, tail in ((True, True), (True, False), (False, True)):
        held = pattern_targets(robot, straightened(robot, gait, trunk=trunk, tail=tail), clock)
        for servos, still in ((ahead, trunk), (list(place.tail_yaw), tail)):
            expected = 0.0 * whole[:, servos] if still else whole[:, servos]
            assert held[:, servos] == pytest.approx(expected, abs=1e-12)


def test_a_table_of_angles_is_straightened_and_shifted_too_but_not_steered():
    robot, table = ROBOTS["salamander"], GAITS["animal_walk"]
    assert isinstance(table, AngleTable)
    place, clock = layout(robot), np.arange(26) / 26
    still = pattern_targets(robot, straightened(robot, table), clock)
    assert abs(still[:, list(place.axial_yaw)]).max() == 0.0
    late = pattern_targets(robot, with_axis_lag(robot, table, 0.5), clock)
    before = pattern_targets(robot, table, clock - 0.5)
    yaw = list(place.axial_yaw)
    assert late[:, yaw] == pytest.approx(before[:, yaw], abs=1e-9)
    assert not strides(table)
    with pytest.raises(OutsideLimits, match="steering needs a gait of foot paths and bends"):
        steerable(table, "steering")


@pytest.mark.parametrize("name", WALKERS)
def test_the_longest_strokes_can_just_be_walked(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    most = longest_strokes(robot, gait)
    assert most >= 1.0
    check_limits(robot, with_strokes(gait, most))


@pytest.mark.parametrize("name", ["pleurobot", "salamander", "strider"])
def test_a_change_of_height_ends_in_the_new_posture_and_lifts_half_of_the_feet_at_a_time(name):
    robot, gait = ROBOTS[name], own_gait(ROBOTS[name])
    other = replace(gait, name="low", height=0.9 * gait.height)
    way = transition(robot, gait, other)
    assert way.targets.shape == (len(way.times), len(layout(robot).servos))
    assert (np.diff(way.times) > 0).all()
    assert way.at(way.duration, way.targets[0]) == pytest.approx(way.targets[-1])
    with pytest.raises(OutsideLimits, match="mixes a gait of the article's kind"):
        transition(robot, gait, GAITS["belly_crawl"])
