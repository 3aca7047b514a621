"""What servos do in a gait: foot paths, erect legs, cranks, held limbs, bends of the axis, and what steers them."""

from dataclasses import replace
from math import cos, pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.metres import with_metres

from suchus.core.errors import OutsideLimits
from suchus.robot.control import Coordinated, OpenLoop, Runs, Walking
from suchus.robot.control.limbs import LAWS
from suchus.robot.design import crocodile, layout, servo_names
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.kinematics import landmarks
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.motion import (
    START,
    Batch,
    Bend,
    FixedLimbs,
    Steer,
    check_limits,
    cycle_targets,
    hip_height,
    intended,
    limb_targets,
    middle_stance,
    movement,
    suits,
    trunk_amplitude,
)
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.motion.limbs import foot_path, in_steps
from suchus.robot.robots import ROBOTS

LEGS = ("LF", "RF", "LH", "RH")
BODIES = ("caiman", "pleurobot", "salamander", "salamandra", "strider", "swimmer")
WALKERS = BODIES[:-1]
SALAMANDER, WALK = ROBOTS["salamander"], GAITS["salamander_walk"]
CLOCK = np.linspace(0.0, 1.0, 201)
PHASE = np.arange(64)[:, None] / 64
STRAIGHT = np.zeros(64, dtype=complex)


def feet_of(robot, gait, phase):
    return movement(robot, gait).foot_positions(phase)


def reached(robot, targets):
    return np.stack(
        [leg_kinematics.forward(robot.leg(name), targets[..., 3 * i : 3 * i + 3]) for i, name in enumerate(LEGS)],
        axis=-2,
    )


def at(robot, gait, clock, steer=None):
    clock = np.atleast_1d(clock)
    here = movement(robot, gait)
    return here.targets(clock[:, None] + np.array(gait.limb_phases), here.axis_of_clock(clock), steer)


# the cycle


def test_phases_stand_still_until_the_walk_begins(robot, crawl_gait):
    phase = intended(robot, crawl_gait, np.array([0.0, 0.5 * START, START, START + crawl_gait.period])).phase
    assert phase[:3] == pytest.approx(np.tile(crawl_gait.limb_phases, (3, 1)))
    assert phase[3] == pytest.approx(np.array(crawl_gait.limb_phases) + 1)


@given(duty=st.floats(0.1, 0.9))
def test_a_foot_on_its_path_stands_for_the_duty_factor_goes_back_evenly_and_never_jumps(duty):
    clock = np.linspace(0.0, 2.0, 4001)
    forward, lifted = foot_path(clock, duty)
    stands = np.mod(clock, 1.0) >= 1.0 - duty
    assert stands.mean() == pytest.approx(duty, abs=0.002)
    assert not lifted[stands].any()
    assert lifted.max() == pytest.approx(1.0, abs=1e-3)
    assert np.abs(np.diff(forward)).max() < 2 * pi / min(duty, 1.0 - duty) / 2000
    stance = np.linspace(1.0 - duty + 1e-9, 1.0 - 1e-9, 21)
    assert np.diff(foot_path(stance, duty)[0], n=2) == pytest.approx(0.0, abs=1e-9)
    assert foot_path(stance, duty)[0][[0, -1]] == pytest.approx([1.0, -1.0], abs=1e-6)


# legs of yaw, pitch and knee


@given(stroke=st.floats(0.0, 0.09), duty=st.floats(0.3, 0.8), lift=st.floats(0.0, 0.04))
def test_standing_feet_go_straight_back_at_ground_height(robot, crawl_gait, stroke, duty, lift):
    gait = with_metres(crawl_gait, stroke=stroke, duty_factor=duty, lift=lift)
    phase = np.linspace(1 - duty + 1e-9, 1 - 1e-9, 21)[:, None] + np.zeros(4)
    feet = feet_of(robot, gait, phase)
    assert feet[..., 2] == pytest.approx(hip_height(robot, gait) - robot.hind_leg.foot_radius)
    assert feet[0, :, 1] == pytest.approx(stroke, abs=1e-6)
    assert feet[-1, :, 1] == pytest.approx(-stroke, abs=1e-6)


def test_metres_come_back_from_shares_to_the_last_bit(robot, crawl_gait):
    feet = feet_of(robot, crawl_gait, np.array([[1.0 - crawl_gait.duty_factor] * 4]))[0]
    assert (feet[:, 1] == 0.027).all()
    assert feet[:, 0].tolist() == [0.9 * 0.07 + 0.085] * 2 + [0.07 + 0.1] * 2
    assert hip_height(robot, crawl_gait) == 0.09


def test_servo_targets_put_the_feet_where_they_should_be(robot, crawl_gait):
    phase = np.arange(16)[:, None] / 16 + np.array(crawl_gait.limb_phases)
    targets = limb_targets(robot, crawl_gait, phase)
    assert reached(robot, targets) == pytest.approx(feet_of(robot, crawl_gait, phase), abs=1e-12)


@given(stroke=st.floats(0.0, 0.04), ahead=st.floats(-0.04, 0.04), height=st.floats(0.06, 0.14))
def test_erect_legs_put_their_feet_where_they_should_be(robot, stroke, ahead, height):
    gait = with_metres(GAITS["high_walk"], stroke=stroke, front_ahead=ahead, hind_ahead=-ahead, hip_height=height)
    phase = PHASE + np.array(gait.limb_phases)
    assert reached(robot, limb_targets(robot, gait, phase)) == pytest.approx(feet_of(robot, gait, phase), abs=1e-9)


def test_erect_legs_stay_in_a_plane_along_the_body_elbow_behind_and_knee_ahead(robot):
    walk = GAITS["high_walk"]
    assert walk.erect
    phase = PHASE + np.array(walk.limb_phases)
    targets, feet = limb_targets(robot, walk, phase), feet_of(robot, walk, phase)
    for i, name in enumerate(LEGS):
        facing = -1 if name.endswith("F") else 1
        assert (targets[:, 3 * i] == facing * pi / 2).all()
        knee = leg_kinematics.knee_point(robot.leg(name), targets[:, 3 * i : 3 * i + 3])
        # the knee stands to the facing side of the line from hip to foot
        beside = knee[:, 1] - feet[:, i, 1] * knee[:, 2] / feet[:, i, 2]
        assert (facing * beside > 0.01).all()


def test_the_angles_of_an_erect_leg_pass_below_the_hip_without_a_jump(robot):
    gait = with_metres(GAITS["high_walk"], front_ahead=0.0, hind_ahead=0.0)
    phase = np.linspace(0, 1, 2001)[:, None] + np.zeros(4)
    assert np.abs(np.diff(limb_targets(robot, gait, phase)[:, :12], axis=0)).max() < 0.02


def test_a_sprawled_leg_whose_foot_stands_straight_behind_its_hip_is_an_erect_one(robot):
    behind = with_metres(GAITS["high_walk"], stroke=0.0, lift=0.0, front_ahead=-0.03, hind_ahead=0.03)
    sprawled = with_metres(behind, legs="sprawled")
    phase = np.zeros((1, 4))
    assert not sprawled.erect
    assert limb_targets(robot, behind, phase) == pytest.approx(limb_targets(robot, sprawled, phase), abs=1e-12)


def test_erect_legs_stand_below_their_hips_or_are_refused(robot):
    walk = GAITS["high_walk"]
    outside = replace(walk, limbs=tuple(replace(path, outward=0.2) for path in walk.limbs))
    with pytest.raises(OutsideLimits, match="stand below their hips: set outward to 0"):
        check_limits(robot, outside)


def test_ahead_moves_the_whole_path(robot, crawl_gait):
    moved = with_metres(crawl_gait, front_ahead=0.01, hind_ahead=-0.02)
    away = feet_of(robot, moved, PHASE + np.zeros(4)) - feet_of(robot, crawl_gait, PHASE + np.zeros(4))
    assert away[..., 1] == pytest.approx(np.tile([0.01, 0.01, -0.02, -0.02], (64, 1)))
    assert (away[..., [0, 2]] == 0).all()


# any limb


def test_feet_are_where_their_paths_are():
    targets, place = cycle_targets(SALAMANDER, WALK, CLOCK), layout(SALAMANDER)
    angles = np.zeros((len(CLOCK), len(place.hinges)))
    angles[:, list(place.servo_hinges)] = targets
    angles[:, place.forward_hinges] = 0.0  # a straight axis, so that girdles are parallel to the root
    feet = landmarks(SALAMANDER, angles).feet
    for i, limb in enumerate(place.limbs):
        path, girdle = WALK.limbs[limb.number], limb.girdle
        reach = girdle.limb.reach
        forward, lifted = foot_path(CLOCK + WALK.limb_phases[i], WALK.duty_factor)
        away = feet[:, i] - (landmarks(SALAMANDER, 0 * angles[0]).feet[i] - [0.0, limb.side * reach, 0.0])
        np.testing.assert_allclose(away[:, 0], (path.ahead + path.stroke * forward) * reach, atol=1e-12)
        np.testing.assert_allclose(limb.side * away[:, 1], path.outward * reach, atol=1e-12)
        down = hip_height(SALAMANDER, WALK) + girdle.above - girdle.limb.foot.radius
        np.testing.assert_allclose(away[:, 2], path.lift * reach * lifted - down, atol=1e-12)


def test_a_crank_stands_slowly_below_and_returns_over_the_top():
    robot, gait = ROBOTS["salamandra"], GAITS["salamandra_walk"]
    angle = cycle_targets(robot, gait, CLOCK)[:, layout(robot).limbs[0].servos.start]
    assert (np.diff(angle) < 0).all()
    stands = (1.0 - gait.duty_factor <= CLOCK) & (CLOCK < 1.0)
    low = gait.limbs[0].stance / 2 + 1e-9
    assert (np.abs(angle[stands]) <= low).all()
    over = np.angle(np.exp(1j * angle[~stands]))
    assert (np.abs(over) >= low - 2e-9).all()
    assert angle[-1] - angle[0] == pytest.approx(-2 * np.pi)


def test_limbs_can_be_held_back_as_in_swimming():
    held = FixedLimbs(angles=(radians(-85),))
    swim = replace(WALK, name="swim", limbs=(held, held))
    targets, limb = cycle_targets(SALAMANDER, swim, CLOCK), layout(SALAMANDER).limbs[0]
    assert (targets[:, limb.servos.start] == radians(-85)).all()
    assert not targets[:, limb.servos.start + 1 : limb.servos.stop].any()  # those that are not named are held at zero
    five = FixedLimbs(angles=(0.0,) * 5)
    with pytest.raises(OutsideLimits, match="holds 5 angles of girdle F; its limbs have 4 servos"):
        check_limits(SALAMANDER, replace(swim, limbs=(five, held)))


def test_in_the_middle_of_stance_the_axis_is_straight_and_all_feet_stand_level():
    servos, place = middle_stance(SALAMANDER, WALK), layout(SALAMANDER)
    assert not servos[list(place.axial_yaw)].any()
    angles = np.zeros(len(place.hinges))
    angles[list(place.servo_hinges)] = servos
    assert np.ptp(landmarks(SALAMANDER, angles).feet[:, 2]) < 1e-12


@pytest.mark.parametrize(
    ("gait", "robot", "says"),
    [
        ("tripod", "caiman", r"phases for 6 limbs; robot 'caiman' has 4 \(LF, RF, LH, RH\): choose a gait made for it"),
        ("salamandra_walk", "caiman", "turns limbs as cranks; limbs LF and RF of robot 'caiman' are not cranks"),
        ("belly_crawl", "salamandra", "leads feet along a path; limbs LF and RF of robot 'salamandra' are cranks"),
        ("undulation", "strider", r"phases for 0 limbs; robot 'strider' has 6 \(LF, RF, LM, RM, LH, RH\)"),
        ("belly_crawl", "swimmer", "phases for 4 limbs; robot 'swimmer' has 0: choose"),
    ],
)
def test_a_gait_for_other_limbs_is_refused(gait, robot, says):
    with pytest.raises(OutsideLimits, match=says):
        check_limits(ROBOTS[robot], GAITS[gait])
    assert not suits(ROBOTS[robot], GAITS[gait])


# the axis


@given(cycle=st.floats(0.0, 1.0))
def test_the_bend_of_a_diagonal_gait_is_a_standing_wave(robot, crawl_gait, cycle):
    # extreme when LF touches down: the trunk concave on the right, its front end to the right (negative)
    here = movement(robot, crawl_gait)
    z = here.axis_phase(np.array([cycle]) + np.array([crawl_gait.limb_phases]))
    expected = -radians(70) * cos(2 * pi * (cycle - (1 - crawl_gait.duty_factor)))
    assert float(here.bend_of("trunk", z)[0]) == pytest.approx(expected, abs=1e-12)
    assert -float(here.bend_of("tail", z)[0]) / radians(45) == pytest.approx(expected / radians(70), abs=1e-12)


def test_the_bend_vanishes_where_the_pulls_of_the_limbs_cancel(robot, crawl_gait):
    here = movement(robot, crawl_gait)
    assert abs(here.axis_phase(np.full((1, 4), 0.3))[0]) == pytest.approx(0.0, abs=1e-15)


@settings(max_examples=20)
@given(st.lists(st.floats(-0.5, 0.5), min_size=4, max_size=4))
def test_the_order_parameter_is_one_where_limbs_keep_their_phases_and_never_more(off):
    for gait in (GAITS["belly_crawl"], GAITS["high_walk"], WALK):
        here = movement(ROBOTS["caiman"], replace(gait, coupling=()))
        own = np.array([gait.limb_phases])
        assert abs(here.axis_phase(own + off[0])[0]) == pytest.approx(1.0, abs=1e-12)
        assert abs(here.axis_phase(own + np.array([off]))[0]) <= 1.0 + 1e-12


def test_a_bend_is_shared_evenly_by_the_hinges_of_its_part_whatever_their_number():
    bend = Bend(part="trunk", amplitude=(0.6,))
    for name in ("caiman", "pleurobot", "salamander"):
        robot = ROBOTS[name]
        gait = replace(default_gait(robot), axis=(bend,), coupling=())
        angles = cycle_targets(robot, gait, CLOCK)[:, list(layout(robot).trunk_yaw)]
        assert np.ptp(angles, axis=1).max() < 1e-15
        assert np.abs(angles.sum(axis=1)).max() == pytest.approx(0.6, rel=1e-3)
        assert trunk_amplitude(robot, gait) == pytest.approx(0.6)


def test_knots_run_from_the_head_and_are_met_at_every_hinge_of_as_many():
    robot = ROBOTS["pleurobot"]
    knots = (0.4, 0.8, 0.2, 0.6)
    gait = replace(default_gait(robot), axis=(Bend(part="trunk", amplitude=knots),))
    amplitude = np.abs(cycle_targets(robot, gait, CLOCK)).max(axis=0)
    hinges = yaw_hinges(robot)
    trunk = [hinges.servos[k] for k in hinges.indices_in("trunk")]
    assert [hinges.axial_positions[k] for k in hinges.indices_in("trunk")] == sorted(
        hinges.axial_positions[k] for k in hinges.indices_in("trunk")
    )
    assert amplitude[trunk] == pytest.approx(np.array(knots) / 4, rel=1e-3)
    two = replace(gait, axis=(Bend(part="trunk", amplitude=(0.4, 1.0)),))
    assert np.abs(cycle_targets(robot, two, CLOCK)).max(axis=0)[trunk] == pytest.approx(
        np.array([0.4, 0.6, 0.8, 1.0]) / 4, rel=1e-3
    )


def test_a_standing_wave_has_one_phase_and_a_running_one_lags_toward_the_tail():
    robot, running = ROBOTS["swimmer"], GAITS["undulation"]
    hinges = yaw_hinges(robot)
    left = np.array(hinges.signs)

    def crests(gait):
        return np.argmin(left * cycle_targets(robot, gait, CLOCK[:-1])[:, list(hinges.servos)], axis=0) / 200

    assert np.mod(crests(running) - crests(running)[0], 1.0) == pytest.approx(np.arange(10) / 11, abs=0.006)
    standing = running.with_numbers(waves=0.0)
    assert np.ptp(crests(standing)) == 0.0
    backward = crests(running.reversed())
    assert np.mod(backward - backward[0], 1.0)[1:] == pytest.approx(1.0 - np.arange(1, 10) / 11, abs=0.006)


def test_an_offset_of_the_axis_turns_it_left_by_its_nths():
    place, count = layout(SALAMANDER), len(yaw_hinges(SALAMANDER).servos)
    turned = replace(WALK, axis=(*WALK.axis, Bend(part="axis", offset=count * radians(2))))
    more = cycle_targets(SALAMANDER, turned, CLOCK) - cycle_targets(SALAMANDER, WALK, CLOCK)
    np.testing.assert_allclose(
        more[:, list(place.axial_yaw)], radians(2) * np.array(place.axial_left) + 0 * more[:, :1], atol=1e-12
    )


def test_a_vertical_bend_is_shared_by_the_pitch_hinges_and_down_is_positive(robot, crawl_gait):
    place = layout(robot)
    waved = replace(crawl_gait, axis=(*crawl_gait.axis, Bend(part="trunk", turn="pitch", amplitude=(0.2,), offset=0.1)))
    angles = cycle_targets(robot, waved, CLOCK)[:, list(place.trunk_pitch)].sum(axis=1)
    assert (angles.min(), angles.max()) == pytest.approx((-0.1, 0.3), abs=1e-3)
    assert cycle_targets(robot, waved, CLOCK)[:, place.tail_pitch[0]] == pytest.approx(0.2)


@pytest.mark.parametrize("name", BODIES)
def test_bends_of_trunk_and_tail_are_the_sums_of_the_hinges(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    place, clock, here = layout(robot), np.linspace(0.0, 1.0, 7), movement(robot, gait)
    z, targets = here.axis_of_clock(clock), cycle_targets(robot, gait, clock)
    assert here.bend_of("trunk", z) == pytest.approx(targets[:, list(place.trunk_yaw)].sum(axis=1), abs=1e-9)
    if not place.cables:
        assert -here.bend_of("tail", z) == pytest.approx(targets[:, list(place.tail_yaw)].sum(axis=1), abs=1e-9)


# steering


@pytest.mark.parametrize("name", BODIES)
def test_with_nothing_asked_it_is_the_gait_itself(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    clock = np.linspace(0.0, 3.0, 17)
    assert at(robot, gait, clock, Steer()) == pytest.approx(cycle_targets(robot, gait, clock), abs=1e-12)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("control", [Walking(), Coordinated(limbs=LAWS["off"], spine=None, tail=None)])
def test_controllers_without_a_rule_command_the_open_loop_on_every_body(name, control):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    runs, period = Runs.identical(control, robot, gait, ticks=400), control_period(robot)
    ours, theirs = (
        control.start(runs, period),
        OpenLoop.start(Runs.identical(OpenLoop(), robot, gait, ticks=400), period),
    )
    first, moved = ours.rest().copy(), 0.0
    for tick in (0, 200, 237, 399):
        now, open_loop = ours.command(tick, None), theirs.command(tick, None)
        assert now.phase == pytest.approx(open_loop.phase)
        assert now.targets == pytest.approx(open_loop.targets, abs=1e-9)
        moved = max(moved, float(np.abs(now.targets - first).max()))
    assert moved > 0.1  # a walk that holds the body still would agree with nothing


def test_size_shrinks_strokes_and_bends_and_leaves_what_is_steady(robot, crawl_gait):
    still = at(robot, crawl_gait, CLOCK, Steer(size=np.zeros(len(CLOCK))))
    place = layout(robot)
    assert not still[:, list(place.trunk_yaw)].any()
    assert still[:, place.tail_pitch[0]] == pytest.approx(0.2)
    feet = reached(robot, still)
    assert feet[..., 1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", WALKERS)
def test_a_steady_bend_is_shared_out_over_the_trunk_and_nothing_else_moves(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    yaw = list(layout(robot).trunk_yaw)
    change = at(robot, gait, 0.2, Steer(bend=np.array([0.1]))) - at(robot, gait, 0.2, Steer())
    assert change[0, yaw] == pytest.approx(0.1 / len(yaw))
    assert np.delete(change[0], yaw) == pytest.approx(0.0)


@pytest.mark.parametrize("name", ["pleurobot", "salamander", "strider", "caiman"])
def test_a_shorter_stroke_on_one_side_moves_the_limbs_of_that_side_alone(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    place = layout(robot)
    left = np.array([[0.5 if limb.side > 0 else 1.0 for limb in place.limbs]])
    change = abs(at(robot, gait, 0.05, Steer(stroke=left)) - at(robot, gait, 0.05, Steer()))[0]
    moved = {limb.name for limb in place.limbs if change[limb.servos].max() > 1e-6}
    assert moved == {limb.name for limb in place.limbs if limb.side > 0}


def test_lower_feet_are_lower_by_as_much(robot):
    walk = GAITS["high_walk"]
    lower, phase = np.array([0.01, -0.01, 0.005, 0.0]), PHASE + np.array(walk.limb_phases)
    steer = Steer(lowering=np.broadcast_to(lower, phase.shape))
    there = reached(robot, movement(robot, walk).targets(phase, STRAIGHT, steer))
    assert there - feet_of(robot, walk, phase) == pytest.approx(
        np.broadcast_to(lower[:, None] * [0, 0, 1], there.shape), abs=1e-9
    )


def test_a_steered_leg_points_to_a_foot_out_of_reach_and_an_unsteered_one_is_refused(robot):
    walk, phase = GAITS["high_walk"], np.full((1, 4), 0.9)
    here, straight = movement(robot, walk), np.zeros(1, dtype=complex)
    there = reached(robot, here.targets(phase, straight, Steer(lowering=np.full((1, 4), 0.3))))[0, 2]
    hip = np.array([robot.hind_leg.hip_offset, 0, 0])
    asked = feet_of(robot, walk, phase)[0, 2] + [0.0, 0.0, 0.3]
    assert np.linalg.norm(there - hip) == pytest.approx(robot.hind_leg.reach[1], abs=1e-5)
    assert np.cross(there - hip, asked - hip) == pytest.approx(np.zeros(3), abs=1e-6)
    high = walk.with_numbers(height=1.5)
    with pytest.raises(OutsideLimits, match="outside its reach"):
        limb_targets(robot, high, phase)
    assert movement(robot, high).out_of_reach(phase).max() > 0.01


# batches


def test_a_batch_of_different_gaits_and_bodies_says_what_each_says_alone(robot, crawl_gait):
    thorax = replace(robot.tables.thorax, shoulder=0.9 * robot.tables.thorax.shoulder)
    other = crocodile(replace(robot.tables, name="other", thorax=thorax))
    gaits = [crawl_gait, crawl_gait.strode(0.5), GAITS["high_walk"], crawl_gait.lagged(0.1), GAITS["semi_erect"]]
    robots = [robot, robot, robot, other, other]
    rng = np.random.default_rng(0)
    limbs = np.array([gait.limb_phases for gait in gaits]) + rng.uniform(-0.1, 0.1, (5, 4))
    steer = Steer(
        rng.uniform(0.5, 1.0, 5), rng.uniform(0.5, 1.0, (5, 4)), np.zeros((5, 4)), *rng.uniform(-0.1, 0.1, (2, 5))
    )
    batch = Batch(robots, gaits)
    assert len(batch.groups) == 3  # the two crawls share one call, and so do the two walks of the other body
    axis = batch.axis_phase(limbs, np.zeros(5))
    together, plain = batch.targets(limbs, axis, steer), batch.targets(limbs, axis)
    for i, (body, gait) in enumerate(zip(robots, gaits, strict=True)):
        here = movement(body, gait)
        mine = Steer(*(np.asarray(field)[i : i + 1] for field in steer))
        z = here.axis_phase(limbs[i : i + 1])
        assert axis[i] == z[0]
        assert together[i] == pytest.approx(here.targets(limbs[i : i + 1], z, mine)[0], abs=1e-14)
        assert plain[i] == pytest.approx(here.targets(limbs[i : i + 1], z)[0], abs=1e-14)
        swing, steady = (part[i] for part in batch.swing_and_offset("trunk"))
        assert batch.bend_of("trunk", axis)[i] == pytest.approx(steady + (swing * z[0]).real, abs=1e-14)


def test_a_bend_has_the_same_bits_whoever_is_in_the_batch(robot, crawl_gait):
    knots = replace(crawl_gait, axis=(Bend(part="trunk", amplitude=(0.4, 0.7, 1.1)),))
    gaits = [crawl_gait, knots, crawl_gait.strode(0.5)]  # one part's bend whole, hinge by hinge, and whole again
    batch, z = Batch([robot] * 3, gaits), np.exp(2j * np.pi * np.array([0.13, 0.29, 0.71]))
    assert len(batch.groups) == 1
    alone = [movement(robot, gait).bend_of("trunk", z[i : i + 1])[0] for i, gait in enumerate(gaits)]
    assert batch.bend_of("trunk", z).tolist() == alone


def test_servo_names_of_a_given_bend(robot, crawl_gait):
    straight = crawl_gait.straightened()
    here = movement(robot, straight)
    targets = here.targets(np.array([crawl_gait.limb_phases]), np.zeros(1, dtype=complex), Steer(bend=np.array([0.6])))
    angle = dict(zip(servo_names(), targets[0], strict=True))
    assert [angle[f"spine_yaw_{i}"] for i in (1, 2, 3)] == pytest.approx([0.2, 0.2, 0.2])
    assert angle["tail_cable"] == angle["spine_pitch_1"] == angle["spine_pitch_2"] == 0.0


@pytest.mark.parametrize(
    "indices", [(), (4,), (0, 1, 2), (12, 14, 16), (16, 14, 12), (2, 1, 0), (0, 1, 3), (5, 5), (7, 3)]
)
def test_places_in_steps_are_those_of_their_indices(indices):
    values = np.arange(40).reshape(2, 20)
    np.testing.assert_array_equal(values[:, in_steps(indices)], values[:, list(indices)] if indices else values[:, :0])
    assert isinstance(in_steps(indices), slice) == (indices not in {(), (0, 1, 3), (5, 5)})
