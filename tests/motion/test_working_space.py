"""Configurations that are kept can be, and the room that points fill is counted right."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.bodies import six

from suchus.core.errors import UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import LEGS, crocodile, joint_names
from suchus.robot.gaits import GAITS
from suchus.robot.gaits.belly_crawl import LIMBS
from suchus.robot.kinematics.tree import centre_of_mass, landmarks
from suchus.robot.motion import GaitInMetres
from suchus.robot.motion.working_space import extent, is_inside, outline, sample_configurations

CRAWL = GAITS["belly_crawl"]
METRES = GaitInMetres.from_gait(CRAWL, LIMBS)


def world(pelvis, points):
    """Written anew, from the pitch's definition: front end up."""
    x, z, pitch = pelvis
    c, s = np.cos(pitch), np.sin(pitch)
    return np.stack([x + c * points[..., 0] - s * points[..., 2], points[..., 1],
                     z + s * points[..., 0] + c * points[..., 2]], axis=-1)  # fmt: skip


@pytest.fixture(scope="module", params=[False, True], ids=["crawling", "standing"])
def found(request, robot):
    return request.param, sample_configurations(robot, CRAWL, standing=request.param, count=2**14)


def test_feet_stand_where_the_gait_puts_them(found, robot):
    standing, some = found
    assert len(some.snout) > 20
    hind = robot.hind_leg.hip_offset + METRES.hind_reach
    for angles, pelvis, snout in zip(some.angles[:50], some.pelvis, some.snout, strict=False):
        marks = landmarks(robot, angles[None])
        feet = world(pelvis, marks.feet[0])
        assert feet[LEGS.index("LH")] == pytest.approx([0.0, hind, robot.hind_leg.foot_radius], abs=1e-9)
        assert feet[LEGS.index("RH")] == pytest.approx([0.0, -hind, robot.hind_leg.foot_radius], abs=1e-9)
        assert world(pelvis, marks.snout[0]) == pytest.approx(snout, abs=1e-12)
        if standing:
            assert world(pelvis, marks.tail[0])[2] == pytest.approx(robot.tail.radius_tip, abs=1e-9)
        else:
            assert feet[:2, 2] == pytest.approx(robot.front_leg.foot_radius, abs=1e-9)
            assert np.abs(feet[:2, 1]) == pytest.approx(robot.front_leg.hip_offset + METRES.front_reach)


def test_joints_stay_within_their_ranges_and_the_mass_over_what_stands(found, robot):
    standing, some = found
    for name in ("LF_yaw", "RF_pitch", "LH_knee", "RH_pitch", "tail_pitch"):
        part = robot.tail if name == "tail_pitch" else robot.leg(name[:2])
        low, high = getattr(part, f"{name.split('_')[1]}_range")
        values = some.angles[:, joint_names(robot).index(name)]
        assert low - 1e-12 <= values.min() <= values.max() <= high + 1e-12
    assert some.snout[:, 2].min() >= robot.head.height / 2
    com = np.array([world(p, c) for p, c in zip(some.pelvis, centre_of_mass(robot, some.angles), strict=True)])
    assert (com[:, 0] <= 0.0).all() == standing
    assert np.abs(com[:, 1]).max() < robot.hind_leg.hip_offset + METRES.hind_reach


def test_no_snout_is_higher_than_a_straight_robot(found, robot):
    straight = robot.hind_leg.reach[1] + robot.spine.length + robot.head.snout + robot.hind_leg.foot_radius
    assert found[1].snout[:, 2].max() < straight


def test_a_robot_whose_trunk_is_stiff_reaches_less(robot):
    stiff = crocodile(
        replace(robot.tables, spine=replace(robot.tables.spine, yaw_range=(-0.01, 0.01), pitch_range=(-0.01, 0.01)))
    )
    ours, theirs = (sample_configurations(one, CRAWL, standing=True, count=2**12).snout for one in (robot, stiff))
    assert np.ptp(theirs[:, 1]) < 0.1 * np.ptp(ours[:, 1])


def test_a_leg_keeps_to_a_narrow_range_and_the_trunk_off_the_ground(robot):
    narrow = crocodile(replace(robot.tables, hind_leg=replace(robot.tables.hind_leg, knee_range=(0.0, 1.0))))
    for standing in (False, True):
        some = sample_configurations(narrow, CRAWL, standing=standing, count=2**14)
        assert some.angles[:, joint_names(robot).index("LH_knee")].max() <= 1.0
        line, _ = outline(narrow, some.angles, some.pelvis)
        assert line[:, -6:-1, 2].min() >= robot.spine.radius  # the trunk's joints come before the snout


def test_the_outline_ends_at_snout_and_feet(found, robot):
    _, some = found
    line, legs = outline(robot, some.angles[:3], some.pelvis[:3])
    assert line[:, -1] == pytest.approx(some.snout[:3], abs=1e-12)
    assert legs[:, LEGS.index("LH"), -1, 0] == pytest.approx(0.0, abs=1e-9)


def test_a_square_holds_its_middle_and_not_what_is_beyond_its_sides():
    square = np.array([[[1, -1], [1, 1], [-1, 1], [-1, -1]]]).repeat(3, axis=0)
    assert is_inside(np.array([[0.0, 0.99], [0.0, 1.01], [-1.01, 0.0]]), square).tolist() == [True, False, False]


@pytest.mark.parametrize("count", [3_000, 100_000])
def test_the_volume_of_a_ball_lies_between_the_estimates(count):
    rng = np.random.default_rng(0)
    way = rng.normal(size=(count, 3))
    points = 0.3 * way / np.linalg.norm(way, axis=1, keepdims=True) * np.cbrt(rng.uniform(size=(count, 1)))
    room, true = extent(points, 0.04), 4 / 3 * pi * 0.3**3
    assert room.lower_estimate < true < room.upper_estimate
    assert count < 10_000 or room.value == pytest.approx(true, rel=0.1)


def test_the_area_of_a_rectangle_and_of_nothing():
    points = np.random.default_rng(1).uniform([0, 0], [0.8, 0.5], (50_000, 2))
    room = extent(points, 0.01)
    assert (room.lower_estimate, room.upper_estimate) == pytest.approx((78 * 48 * 1e-4, 80 * 50 * 1e-4), rel=1e-3)
    assert extent(np.empty((0, 2)), 0.01) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("standing", [False, True])
def test_how_the_tail_is_driven_changes_nothing(robot, standing):
    servos = crocodile(replace(robot.tables, tail=replace(robot.tables.tail, drive="servos")))
    cable, driven = (sample_configurations(body, CRAWL, standing=standing, count=2**10) for body in (robot, servos))
    np.testing.assert_array_equal(cable.snout, driven.snout)
    np.testing.assert_array_equal(cable.pelvis, driven.pelvis)


def test_a_body_of_another_spine_is_refused():
    with pytest.raises(UnsuitedRobot, match="working_space needs the article's spine of 5 joints; robot 'six' lacks"):
        EXPERIMENTS["working_space"].for_robot(six())
