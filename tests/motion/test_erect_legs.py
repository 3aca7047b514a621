from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.errors import InvalidDesign, OutsideLimits
from suchus.gaits import GAITS
from suchus.kinematics import leg as leg_kinematics
from suchus.motion import foot_targets, longest_stroke, servo_targets, within_reach

LEGS = ("LF", "RF", "LH", "RH")
PHASE = np.arange(64)[:, None] / 64


@pytest.fixture
def walk():
    return GAITS["high_walk"]


def reached(robot, targets):
    return np.stack(
        [leg_kinematics.forward(robot.leg(name), targets[..., 3 * i : 3 * i + 3]) for i, name in enumerate(LEGS)],
        axis=-2,
    )


@given(stroke=st.floats(0.0, 0.04), ahead=st.floats(-0.04, 0.04), height=st.floats(0.06, 0.14))
def test_erect_legs_put_their_feet_where_they_should_be(robot, stroke, ahead, height):
    gait = replace(GAITS["high_walk"], stroke=stroke, front_ahead=ahead, hind_ahead=-ahead, hip_height=height)
    phase = PHASE + np.array(gait.limb_phases)
    assert reached(robot, servo_targets(robot, gait, phase)) == pytest.approx(
        foot_targets(robot, gait, phase), abs=1e-9
    )


def test_erect_legs_stay_in_a_plane_along_the_body_elbow_behind_and_knee_ahead(robot, walk):
    targets = servo_targets(robot, walk, PHASE + np.array(walk.limb_phases))
    for i, name in enumerate(LEGS):
        facing = -1 if name.endswith("F") else 1
        assert (targets[:, 3 * i] == facing * pi / 2).all()
        knee = leg_kinematics.knee_point(robot.leg(name), targets[:, 3 * i : 3 * i + 3])
        foot = foot_targets(robot, walk, PHASE + np.array(walk.limb_phases))[:, i]
        # the knee stands to the facing side of the line from hip to foot
        beside = knee[:, 1] - foot[:, 1] * knee[:, 2] / foot[:, 2]
        assert (facing * beside > 0.01).all()


def test_the_angles_of_an_erect_leg_pass_below_the_hip_without_a_jump(robot, walk):
    phase = np.linspace(0, 1, 2001)[:, None] + np.zeros(4)
    gait = replace(walk, front_ahead=0.0, hind_ahead=0.0)
    assert np.abs(np.diff(servo_targets(robot, gait, phase)[:, :12], axis=0)).max() < 0.02


def test_a_sprawled_leg_whose_foot_stands_straight_behind_its_hip_is_an_erect_one(robot, walk):
    behind = replace(walk, stroke=0.0, lift=0.0, front_ahead=-0.03, hind_ahead=0.03)
    sprawled = replace(behind, legs="sprawled")
    phase = np.zeros((1, 4))
    assert servo_targets(robot, behind, phase) == pytest.approx(servo_targets(robot, sprawled, phase), abs=1e-12)


def test_ahead_moves_the_whole_path(robot, crawl_gait):
    moved = replace(crawl_gait, front_ahead=0.01, hind_ahead=-0.02)
    away = foot_targets(robot, moved, PHASE + np.zeros(4)) - foot_targets(robot, crawl_gait, PHASE + np.zeros(4))
    assert away[..., 1] == pytest.approx(np.tile([0.01, 0.01, -0.02, -0.02], (64, 1)))
    assert (away[..., [0, 2]] == 0).all()


def test_lower_feet_are_lower_by_as_much(robot, walk):
    lower = np.array([0.01, -0.01, 0.005, 0.0])
    phase = PHASE + np.array(walk.limb_phases)
    there = reached(robot, servo_targets(robot, walk, phase, lower=np.broadcast_to(lower, phase.shape)))
    assert there - foot_targets(robot, walk, phase) == pytest.approx(
        np.broadcast_to(lower[:, None] * [0, 0, 1], there.shape), abs=1e-9
    )


def test_a_clipped_leg_points_to_a_foot_out_of_reach(robot, walk):
    phase = np.full((1, 4), 0.9)
    far = np.full((1, 4), 0.3)
    with pytest.raises(OutsideLimits, match="outside its reach"):
        servo_targets(robot, walk, phase, lower=far)
    there = reached(robot, servo_targets(robot, walk, phase, lower=far, clip=True))[0, 2]
    hip = np.array([robot.hind_leg.hip_offset, 0, 0])
    asked = foot_targets(robot, walk, phase, lower=far)[0, 2]
    assert np.linalg.norm(there - hip) == pytest.approx(robot.hind_leg.reach[1], abs=1e-5)
    assert np.cross(there - hip, asked - hip) == pytest.approx(np.zeros(3), abs=1e-6)


@given(x=st.floats(-0.5, 0.5), y=st.floats(-0.5, 0.5), z=st.floats(0.01, 0.5))
def test_within_reach_is_within_reach_and_leaves_alone_what_was(robot, x, y, z):
    leg, foot = robot.hind_leg, np.array([x, y, z])
    near = within_reach(leg, foot)
    assert leg_kinematics.reachable(leg, near)
    if leg_kinematics.reachable(leg, foot * [1, 1, 1.00001]) and leg_kinematics.reachable(leg, foot * [1, 1, 0.99999]):
        assert near == pytest.approx(foot, abs=2e-6)


def test_longest_stroke_counts_from_where_the_foot_stands(robot, walk):
    longest = longest_stroke(robot, walk)
    assert longest < longest_stroke(robot, replace(walk, front_ahead=0.0, hind_ahead=0.0))
    servo_targets(robot, replace(walk, stroke=longest), PHASE + np.zeros(4))


def test_impossible_legs_are_refused(walk):
    with pytest.raises(InvalidDesign, match="both must be 0 m"):
        replace(walk, front_reach=0.05)
    with pytest.raises(InvalidDesign, match="'sprawled' or 'erect' is needed"):
        replace(walk, legs="upright")
    with pytest.raises(InvalidDesign, match="front_ahead"):
        replace(walk, front_ahead=11.0)
