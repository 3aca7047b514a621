from dataclasses import replace
from math import cos, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.design import crocodile, servo_names
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.kinematics import leg as leg_kinematics
from suchus.motion import (
    START,
    check_limits,
    foot_targets,
    limb_phase,
    longest_stroke,
    servo_targets,
    stance,
    tail_bend,
    trunk_bend,
)


def test_phases_stand_still_until_the_walk_begins(crawl_gait):
    phase = limb_phase(crawl_gait, np.array([0.0, 0.5 * START, START, START + crawl_gait.period]))
    assert phase[:3] == pytest.approx(np.tile(crawl_gait.limb_phases, (3, 1)))
    assert phase[3] == pytest.approx(np.array(crawl_gait.limb_phases) + 1)


def test_duty_factor_is_the_share_of_stance(crawl_gait):
    gait = replace(crawl_gait, duty_factor=0.7)
    phase = np.arange(1000)[:, None] / 1000 + np.zeros(4)
    assert stance(gait, phase).mean() == pytest.approx(0.7, abs=0.002)


@given(stroke=st.floats(0.0, 0.09), duty=st.floats(0.3, 0.8), lift=st.floats(0.0, 0.04))
def test_standing_feet_go_straight_back_at_ground_height(robot, crawl_gait, stroke, duty, lift):
    gait = replace(crawl_gait, stroke=stroke, duty_factor=duty, lift=lift)
    phase = np.linspace(1 - duty + 1e-9, 1 - 1e-9, 21)[:, None] + np.zeros(4)
    feet = foot_targets(robot, gait, phase)
    assert feet[..., 2] == pytest.approx(gait.hip_height - robot.hind_leg.foot_radius)
    assert feet[0, :, 1] == pytest.approx(stroke, abs=1e-6)
    assert feet[-1, :, 1] == pytest.approx(-stroke, abs=1e-6)
    assert np.diff(feet[..., 1], n=2, axis=0) == pytest.approx(0.0, abs=1e-9)


def test_swinging_feet_are_lifted_by_the_lift(robot, crawl_gait):
    phase = np.linspace(0, 1, 401)[:, None] + np.zeros(4)
    down = foot_targets(robot, crawl_gait, phase)[..., 2]
    assert float(np.ptp(down, axis=0)[0]) == pytest.approx(crawl_gait.lift, rel=1e-3)


def test_foot_path_has_no_jumps(robot, crawl_gait):
    phase = np.linspace(0, 2, 2001)[:, None] + np.zeros(4)
    steps = np.abs(np.diff(foot_targets(robot, crawl_gait, phase), axis=0)).max()
    assert steps < 4 * pi * crawl_gait.stroke / 1000


def test_servo_targets_put_the_feet_where_they_should_be(robot, crawl_gait):
    phase = np.arange(16)[:, None] / 16 + np.array(crawl_gait.limb_phases)
    targets, feet = servo_targets(robot, crawl_gait, phase), foot_targets(robot, crawl_gait, phase)
    for i, name in enumerate(("LF", "RF", "LH", "RH")):
        reached = leg_kinematics.forward(robot.leg(name), targets[:, 3 * i : 3 * i + 3])
        assert reached == pytest.approx(feet[:, i], abs=1e-12)


@given(cycle=st.floats(0.0, 1.0))
def test_the_bend_of_a_diagonal_gait_is_a_standing_wave(crawl_gait, cycle):
    # extreme when LF touches down: the trunk concave on the right, its front end to the right (negative)
    phase = cycle + np.array(crawl_gait.limb_phases)
    touch_down = 1 - crawl_gait.duty_factor
    expected = -crawl_gait.trunk_bend * cos(2 * pi * (cycle - touch_down))
    assert float(trunk_bend(crawl_gait, phase)) == pytest.approx(expected, abs=1e-12)
    assert float(tail_bend(crawl_gait, phase)) / crawl_gait.tail_bend == pytest.approx(
        expected / crawl_gait.trunk_bend, abs=1e-12
    )


def test_the_bend_vanishes_where_there_are_no_diagonal_pairs(crawl_gait):
    assert float(trunk_bend(crawl_gait, np.full(4, 0.3))) == pytest.approx(0.0, abs=1e-15)


def test_a_given_bend_is_shared_by_the_three_yaw_joints(robot, crawl_gait):
    targets = servo_targets(
        robot, crawl_gait, np.array(crawl_gait.limb_phases), trunk=np.asarray(0.6), tail=np.asarray(0.0)
    )
    at = {name: float(targets[i]) for i, name in enumerate(servo_names())}
    assert [at["spine_yaw_1"], at["spine_yaw_2"], at["spine_yaw_3"]] == pytest.approx([0.2, 0.2, 0.2])
    assert at["tail_cable"] == 0.0
    assert at["spine_pitch_1"] == at["spine_pitch_2"] == 0.0


def test_longest_stroke_is_reachable_and_little_more_is_not(robot, limbs_gait):
    longest = longest_stroke(robot, limbs_gait)
    check_limits(robot, replace(limbs_gait, stroke=longest))
    with pytest.raises(OutsideLimits, match="foot path outside its reach"):
        check_limits(robot, replace(limbs_gait, stroke=1.05 * longest))


def test_a_joint_out_of_range_is_named_with_angle_and_range(robot, crawl_gait):
    stiff = crocodile(replace(robot.tables, spine=replace(robot.tables.spine, yaw_range=(-0.1, 0.1))))
    with pytest.raises(OutsideLimits, match=r"asks spine_yaw_1 of robot 'caiman' for -?0\.\d+ rad; -0\.100 to 0\.100"):
        check_limits(stiff, crawl_gait)
    with pytest.raises(OutsideLimits, match="bends the tail by"):
        check_limits(robot, replace(crawl_gait, tail_bend=3.0))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("duty_factor", 0.0),
        ("duty_factor", 1.0),
        ("period", float("nan")),
        ("period", -4.0),
        ("stroke", 11.0),
        ("front_reach", 10**400),
        ("name", float("-inf")),
        ("limb_phases", (0.0, 0.5)),
        ("limb_phases", (0.0, 0.5, 0.5, float("inf"))),
    ],
)
def test_an_impossible_gait_is_refused_with_the_field_named(crawl_gait, field, value):
    with pytest.raises(InvalidDesign, match=rf"gait\.{field}"):
        replace(crawl_gait, **{field: value})
