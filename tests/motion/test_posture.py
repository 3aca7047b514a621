from dataclasses import replace

import mujoco
import numpy as np
import pytest
from tests.bodies import eight, hatchling, six

import suchus
from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.robot.design import Spring, crocodile, layout
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.motion.posture import Keyed, hind_leg, sample_postures
from suchus.robot.motion.rising import STRETCH, max_snout_height, stand_up, stretched_length
from suchus.sim.model import compile_model, joint_addresses

CAIMAN = suchus.ROBOTS["caiman"]
RISE = stand_up(CAIMAN)
TIME = np.linspace(0.0, RISE.duration, 76)


def in_mujoco(robot, targets, pitch, hip_height):
    """Put a robot into a posture, its hips above the world's origin, and return its MuJoCo data."""
    model = compile_model(robot)
    data = mujoco.MjData(model)
    at, above, s, c = robot.girdles[-1].at, robot.girdles[-1].above, np.sin(pitch), np.cos(pitch)
    data.qpos[:3] = s * above - c * at, 0.0, hip_height - s * at - c * above
    data.qpos[3:7] = np.cos(pitch / 2), 0.0, -np.sin(pitch / 2), 0.0  # front end up
    names = [name for name in layout(robot).servos if name in layout(robot).hinges]
    data.qpos[joint_addresses(model, names)] = targets[: len(names)]
    mujoco.mj_forward(model, data)
    return data


@pytest.mark.parametrize("tick", [0, 15, 37, 50, 75])
@pytest.mark.parametrize("robot", [CAIMAN, six(), hatchling(), eight()], ids=lambda robot: robot.name)
def test_mujoco_finds_feet_and_centre_of_mass_where_the_plan_puts_them(robot, tick):
    planned = sample_postures(robot, stand_up(robot), TIME)
    data = in_mujoco(robot, planned.targets[tick], planned.pitch[tick], planned.feet[tick, 2])
    for side, name in ((1.0, "LH"), (-1.0, "RH")):
        foot = data.site(f"{name}_foot").xpos
        out = side * (robot.leg(name).hip_offset + planned.feet[tick, 0])
        assert foot == pytest.approx([planned.feet[tick, 1], out, 0.0], abs=1e-9)
    com = data.subtree_com[1]
    assert planned.feet[tick, 1] - com[0] == pytest.approx(planned.lead[tick], abs=1e-9)
    assert com[1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("robot", [CAIMAN, six(), hatchling(), eight()], ids=lambda robot: robot.name)
def test_a_standing_body_touches_the_ground_with_the_tip_of_its_tail(robot):
    last = stand_up(robot).postures[-1]
    level = Keyed(name="level", times=(0.0,), postures=(replace(last, tail_press=0.0),))
    planned = sample_postures(robot, level, np.zeros(1))
    data = in_mujoco(robot, planned.targets[0], planned.pitch[0], planned.feet[0, 2])
    tip = data.site("tail_tip").xpos[2] + robot.leg("LH").foot_radius  # the feet's centres are at zero
    assert tip == pytest.approx(robot.tail.radius_tip, abs=1e-9)


def test_a_scaled_body_takes_the_scaled_posture():
    large, small = (sample_postures(robot, stand_up(robot), TIME) for robot in (CAIMAN, hatchling()))
    assert small.targets == pytest.approx(large.targets, abs=1e-6)
    assert small.feet / hatchling().length == pytest.approx(large.feet / CAIMAN.length, abs=1e-6)


def test_one_pitch_joint_bends_for_both_and_three_share():
    bent = replace(RISE.postures[-1], trunk_first=0.3, trunk_second=0.2)
    passive = Spring(stiffness=5.0, damping=0.1, armature=0.0)
    held = [
        replace(segment, hinges=tuple(replace(hinge, drive=passive) for hinge in segment.hinges))
        if segment.name == "spine_4"
        else segment
        for segment in CAIMAN.axis
    ]
    single = replace(CAIMAN, name="single", axis=tuple(held))
    for robot, angles in ((single, [-0.5]), (six(), [-0.3, -0.1, -0.1])):
        planned = sample_postures(robot, Keyed(name="up", times=(0.0,), postures=(bent,)), np.zeros(1))
        assert planned.targets[0, list(layout(robot).trunk_pitch)] == pytest.approx(angles)


@pytest.mark.parametrize(
    ("name", "missing"),
    [
        ("salamander", ["hind legs of yaw, pitch and knee", "a trunk that bends up and down", "a tail that pitches"]),
        ("strider", ["a trunk that bends up and down", "a tail that pitches at its root"]),
        ("swimmer", ["hind legs of yaw, pitch and knee at its root"]),
    ],
)
def test_who_cannot_stand_up_is_told_what_it_lacks(name, missing):
    for refused in (stand_up, stretched_length):
        with pytest.raises(
            UnsuitedRobot, match=f"standing up on hind legs and tail needs .* robot '{name}' lacks"
        ) as no:
            refused(suchus.ROBOTS[name])
        assert all(words in str(no.value) for words in missing)
    with pytest.raises(UnsuitedRobot):
        sample_postures(suchus.ROBOTS[name], RISE, TIME)


def test_every_key_has_its_centre_of_mass_where_it_says():
    planned = sample_postures(CAIMAN, RISE, np.array(RISE.times))
    assert planned.lead == pytest.approx([p.lead for p in RISE.postures], abs=1e-9)


def test_the_centre_of_mass_is_behind_the_feet_before_the_front_lifts_and_stays_there():
    planned = sample_postures(CAIMAN, RISE, TIME)
    lifted = RISE.times[2] <= TIME
    assert planned.lead[lifted].min() > 0.025


def test_planted_feet_do_not_move_apart_and_the_hips_only_rise_and_go_forward():
    planned = sample_postures(CAIMAN, RISE, TIME)
    planted = RISE.times[2] <= TIME
    assert np.ptp(planned.feet[planted, 0]) == pytest.approx(0.0, abs=1e-12)
    assert np.all(np.diff(planned.feet[planted, 2]) >= -1e-12)
    assert np.all(np.diff(planned.feet[planted, 1]) <= 1e-9)


def test_the_body_rests_in_every_key():
    for key in RISE.times:
        near = sample_postures(CAIMAN, RISE, np.clip(np.array([key - 1e-4, key, key + 1e-4]), 0, RISE.duration)).targets
        assert np.abs(np.diff(near, axis=0)).max() < 1e-6


def test_left_and_right_are_alike_and_the_way_back_is_the_way_up():
    planned = sample_postures(CAIMAN, RISE, TIME).targets
    assert np.array_equal(planned[:, 0:3], planned[:, 3:6])
    assert np.array_equal(planned[:, 6:9], planned[:, 9:12])
    back = sample_postures(CAIMAN, RISE.reversed("sit_down", slower=2.0), 2.0 * TIME).targets
    assert back == pytest.approx(planned[::-1], abs=1e-9)


def test_before_and_after_the_keys_the_postures_hold():
    early, late = (
        sample_postures(CAIMAN, RISE, np.array([-5.0, 0.0])),
        sample_postures(CAIMAN, RISE, np.array([7.5, 99.0])),
    )
    assert np.array_equal(*early.targets)
    assert np.array_equal(*late.targets)


def test_a_hind_leg_reaches_points_that_do_not_turn_with_the_pelvis():
    leg = CAIMAN.hind_leg
    level = hind_leg(leg, np.array([0.05, 0.03, 0.1]), np.array(0.0))
    assert level == pytest.approx(leg_kinematics.inverse(leg, np.array([leg.hip_offset + 0.05, 0.03, 0.1])))
    far = hind_leg(leg, np.array([0.0, 0.3, 0.4]), np.array(0.3), clip=True)
    assert far[2] == pytest.approx(0.0, abs=0.01)  # a stretched knee


def test_nothing_reaches_higher_than_the_stretched_robot():
    parts = CAIMAN.hind_leg.femur + CAIMAN.hind_leg.tibia + CAIMAN.spine.length + CAIMAN.head.snout
    assert stretched_length(CAIMAN) == pytest.approx(parts, abs=1e-15)
    assert stretched_length(hatchling()) == pytest.approx(parts * 0.3 / CAIMAN.length)
    heights = max_snout_height(CAIMAN, np.array([0.0, 0.03, 0.06, 0.1]))
    assert heights.max() < stretched_length(CAIMAN) + CAIMAN.hind_leg.foot_radius
    assert heights.max() > stretched_length(CAIMAN)
    assert np.all(np.diff(heights[1:]) < 0)  # safety costs height


def test_a_longer_leg_makes_a_taller_posture():
    longer = replace(CAIMAN.tables.hind_leg, femur=CAIMAN.hind_leg.femur + 0.02)
    hips = [
        stand_up(crocodile(replace(CAIMAN.tables, hind_leg=leg))).postures[-1].hip_height
        for leg in (CAIMAN.tables.hind_leg, longer)
    ]
    assert hips[1] - hips[0] == pytest.approx(STRETCH * 0.02)


def test_a_posture_out_of_reach_is_refused_with_a_remedy():
    high = replace(RISE.postures[-1], hip_height=0.3)
    with pytest.raises(OutsideLimits, match=r"hind feet of robot 'caiman' cannot stay .* Lower hip_height, lead or"):
        sample_postures(CAIMAN, Keyed(name="up", times=(0.0,), postures=(high,)), TIME)
    bent = replace(RISE.postures[0], trunk_first=1.4)
    with pytest.raises(OutsideLimits, match=r"asks spine_pitch_1 of robot 'caiman' for -1.400 rad; -1.047 to 1.047"):
        sample_postures(CAIMAN, Keyed(name="bent", times=(0.0,), postures=(bent,)), TIME)


def test_impossible_postures_and_times_are_refused():
    with pytest.raises(InvalidDesign, match=r"posture.hip_height is nan m"):
        replace(RISE.postures[0], hip_height=float("nan"))
    with pytest.raises(InvalidDesign, match="2 times for 1 postures"):
        Keyed(name="x", times=(0.0, 1.0), postures=RISE.postures[:1])
    with pytest.raises(InvalidDesign, match="must increase from 0 s"):
        Keyed(name="x", times=(0.0, 0.0), postures=RISE.postures[:2])
