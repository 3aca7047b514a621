"""Metrics on records made by hand, whose answers are known exactly."""

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import IncompatibleRecord
from suchus.robot.motion import START
from suchus.sim.metrics import (
    cost_of_transport,
    diagonal_phase_error,
    displacement,
    duty_factor,
    foot_clearance,
    heading_change,
    height_peak_to_peak,
    height_std,
    lateral_bend,
    line_distance,
    line_distance_max,
    net_cost_of_transport,
    net_work,
    path_length,
    path_speed,
    peak_torque,
    rms_torque,
    roll_peak_to_peak,
    sensed_phase,
    slip,
    smaller_swing,
    speed,
    spine_sine_share,
    spine_swings,
    support_distance,
    support_polygon,
    tail_amplitude,
    tail_load_share,
    tail_swing_least,
    tail_swings,
    tilt,
    time_window,
    two_feet_alone_share,
    two_feet_share,
    work,
)
from suchus.sim.record import EFFORT

TIME = np.arange(0, 901) * 0.01
LEGS = ["LF", "RF", "LH", "RH"]
JOINTS = [f"spine_yaw_{i}" for i in (1, 2, 3)]
FEET = np.array([[0.3, 0.15, 0.0], [0.3, -0.15, 0.0], [0.0, 0.15, 0.0], [0.0, -0.15, 0.0]])


def hand_made(**changes) -> xr.Dataset:
    """Return a record of a robot that stands still at the origin, with some variables replaced."""
    n = len(TIME)
    arrays = {
        "centre_of_mass": (("time", "xyz"), np.tile([0.1, 0.0, 0.08], (n, 1))),
        "orientation": (("time", "wxyz"), np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))),
        "foot_position": (("time", "leg", "xyz"), np.tile(FEET, (n, 1, 1))),
        "foot_force": (("time", "leg", "xyz"), np.tile([0.0, 0.0, 5.0], (n, 4, 1))),
        "joint_angle": (("time", "joint"), np.zeros((n, 3))),
        "tail_force": (("time", "xyz"), np.zeros((n, 3))),
        "belly_force": (("time", "segment", "xyz"), np.zeros((n, 2, 3))),
        "tail_tip": (("time", "xyz"), np.tile([-0.5, 0.0, 0.01], (n, 1))),
        "servo_torque": (("time", "servo"), np.zeros((n, 2))),
        "servo_velocity": (("time", "servo"), np.zeros((n, 2))),
        **{name: (dims, np.zeros((n, 2))) for name, (dims, _, _) in EFFORT.items()},
        "limb_phase": (("time", "leg"), np.tile([0.0, 0.5, 0.5, 0.0], (n, 1))),
        "mass": ((), 2.0),
        "period": ((), 4.0),
        "duty_factor": ((), 0.5),
    }
    arrays |= {name: (arrays[name][0], values) for name, values in changes.items()}
    coords = {"time": TIME, "xyz": list("xyz"), "wxyz": list("wxyz"), "leg": LEGS, "joint": JOINTS}
    return xr.Dataset(arrays, coords=coords)


def moving(x=0.0, y=0.0, z=0.0) -> np.ndarray:
    return np.stack(np.broadcast_arrays(x, y, z, TIME), axis=-1)[:, :3].astype(float)


def about(axis: int, angle) -> np.ndarray:
    quaternion = np.zeros((len(TIME), 4))
    quaternion[:, 0], quaternion[:, 1 + axis] = np.cos(angle / 2), np.sin(angle / 2)
    return quaternion


def test_displacement_is_measured_from_the_beginning_of_the_walk():
    record = hand_made(centre_of_mass=moving(x=0.5 * TIME, y=-0.1 * TIME))
    assert displacement(record).values == pytest.approx([4.0, -0.8, 0.0])
    assert displacement(record, 2.0, 3.0).values == pytest.approx([0.5, -0.1, 0.0])


def test_path_length_counts_turns_but_not_the_sway_within_a_cycle():
    sway = 0.05 * np.sin(2 * np.pi * TIME / 4.0 - np.pi / 2)
    there_and_back = np.where(TIME < 5.0, TIME - 1.0, 9.0 - TIME)
    record = hand_made(centre_of_mass=moving(x=there_and_back, y=sway))
    assert float(path_length(record)) == pytest.approx(8.0)
    assert displacement(record).values[0] == pytest.approx(0.0)


def test_a_path_that_closes_on_itself_has_a_speed_along_it():
    """A circle of radius 1 m, once in eight seconds, two cycles long: the chords of half circles are 2 m each."""
    angle = 2 * np.pi * (TIME - 1.0) / 8.0
    record = hand_made(centre_of_mass=moving(x=np.sin(angle), y=1.0 - np.cos(angle)))
    assert float(speed(record)) == pytest.approx(0.0, abs=1e-9)
    assert float(path_speed(record)) == pytest.approx(4.0 / 8.0)
    assert float(path_speed(record, START, START + 4.0)) == pytest.approx(2.0 / 4.0)
    assert float(path_speed(record, START, START + 6.0)) == pytest.approx(2.0 / 4.0)  # one whole cycle and a half
    both = path_speed(xr.concat([record, record.assign(period=2.0)], "run"))
    assert both.values == pytest.approx([0.5, 4 * 2**0.5 / 8.0])


def test_each_run_of_a_batch_is_sampled_at_its_own_period():
    zigzag = moving(y=0.1 * (np.mod(TIME - 1, 4.0) >= 2.0))
    slow = hand_made(centre_of_mass=zigzag)
    fast = slow.assign(period=2.0)
    both = path_length(xr.concat([slow, fast], "run"))
    assert both.values == pytest.approx([float(path_length(slow)), float(path_length(fast))])
    assert both.values == pytest.approx([0.0, 0.4])


def test_a_turn_to_the_left_is_positive_and_may_exceed_half_a_turn():
    record = hand_made(orientation=about(2, 1.2 * (TIME - 1.0)))
    assert float(heading_change(record)) == pytest.approx(1.2 * 8.0)


def test_heading_is_the_mean_of_the_girdles():
    bend = np.zeros((len(TIME), 3))
    bend[:, 0] = 0.4 * (TIME - 1) / 8
    assert float(heading_change(hand_made(joint_angle=bend))) == pytest.approx(0.2)


def test_height_of_a_sine():
    record = hand_made(centre_of_mass=moving(z=0.08 + 0.01 * np.sin(2 * np.pi * (TIME - 1) / 4)))
    assert float(height_std(record)) == pytest.approx(0.01 / np.sqrt(2), rel=2e-3)
    assert float(height_peak_to_peak(record)) == pytest.approx(0.02, rel=1e-4)


def test_roll_is_positive_with_the_left_side_up_and_pitch_with_the_nose_down():
    assert tilt(hand_made(orientation=about(0, np.full(len(TIME), 0.1))))["roll"].values == pytest.approx(0.1)
    assert tilt(hand_made(orientation=about(1, np.full(len(TIME), 0.1))))["pitch"].values == pytest.approx(0.1)
    swing = hand_made(orientation=about(0, 0.1 * np.sin(np.pi * TIME)))
    assert float(roll_peak_to_peak(swing)) == pytest.approx(0.2, rel=1e-3)


def test_duty_factor_and_phase_of_square_waves():
    force = np.zeros((len(TIME), 4, 3))
    for i, (phase, duty) in enumerate([(0.0, 0.5), (0.5, 0.5), (0.3, 0.5), (0.9, 0.5)]):
        force[:, i, 2] = 5.0 * (np.mod((TIME - 1) / 4 + phase, 1.0) < duty)
    walk = hand_made(foot_force=force)
    assert duty_factor(walk).values == pytest.approx(0.5, abs=2e-3)
    assert np.mod(sensed_phase(walk).values + 1e-6, 1.0) == pytest.approx([0.0, 0.5, 0.3, 0.9], abs=5e-3)


def test_a_foot_slips_by_what_it_slides_times_what_it_carries():
    feet = np.tile(FEET, (len(TIME), 1, 1))
    feet[:, 0, 0] += 0.1 * TIME
    walk = {"foot_position": feet, "centre_of_mass": moving(x=0.2 * TIME)}
    assert float(slip(hand_made(**walk))) == pytest.approx(0.8 * 5.0 / (2.0 * 9.81) / 1.6)
    lifted = np.tile([0.0, 0.0, 5.0], (len(TIME), 4, 1))
    lifted[:, 0] = 0.0
    assert float(slip(hand_made(**walk, foot_force=lifted))) == 0.0


def test_work_counts_braking_as_much_as_driving():
    """One servo drives with 1 W, another brakes with 0.25 W; what happened before the window does not count."""
    each = np.ones((len(TIME), 1))
    power, peaks = each * [1.0, -0.25], each * [2.0, 1.0]
    power[TIME <= START + 1e-9] = peaks[TIME <= START + 1e-9] = 99.0
    record = hand_made(
        servo_power=power, servo_absolute_power=np.abs(power), servo_peak_torque=peaks,
        servo_mean_square_torque=peaks**2, centre_of_mass=moving(x=0.2 * TIME),
    )  # fmt: skip
    assert float(work(record)) == pytest.approx(8 * 1.25)
    assert float(net_work(record)) == pytest.approx(8 * 0.75)
    assert float(cost_of_transport(record)) == pytest.approx(10.0 / (2.0 * 9.81 * 1.6))
    assert float(net_cost_of_transport(record)) == pytest.approx(6.0 / (2.0 * 9.81 * 1.6))
    assert peak_torque(record).values == pytest.approx([2.0, 1.0])
    assert rms_torque(record).values == pytest.approx([2.0, 1.0])


def test_support_is_the_hull_of_the_standing_feet():
    record = hand_made()
    assert len(support_polygon(record, 2.0)) == 4
    assert support_distance(record, 2.0) == pytest.approx(-0.1)  # the hind edge is nearest
    force = np.tile([0.0, 0.0, 5.0], (len(TIME), 4, 1))
    force[:, 0] = 0.0
    outside = hand_made(foot_force=force, centre_of_mass=moving(x=0.25, y=0.1))
    assert support_distance(outside, 2.0) > 0
    force[:, 3] = 0.0
    diagonal = hand_made(foot_force=force)
    assert support_distance(diagonal, 2.0) == pytest.approx(0.05 * np.cos(np.pi / 4), abs=1e-9)


def test_a_loaded_tail_is_a_third_support():
    loads = standing(1, 2)  # RF and LH
    lying = hand_made(foot_force=loads, tail_force=np.tile([0.0, 0.0, 1.0], (len(TIME), 1)))
    assert len(support_polygon(lying, 2.0)) == 3
    assert support_distance(lying, 2.0) == pytest.approx(-0.05 / np.sqrt(2))  # inside, the pair's line is nearest
    ahead = hand_made(foot_force=loads, tail_force=lying.tail_force.values, centre_of_mass=moving(x=0.2, z=0.08))
    assert support_distance(ahead, 2.0) == pytest.approx(0.05 / np.sqrt(2))
    lifted = hand_made(foot_force=loads, tail_force=np.tile([0.0, 0.0, 0.28], (len(TIME), 1)))
    assert len(support_polygon(lifted, 2.0)) == 2


def test_line_of_the_standing_pair():
    pair = hand_made(foot_force=standing(1, 2))
    assert line_distance(pair).values == pytest.approx(0.05 / np.sqrt(2))
    swept = hand_made(foot_force=standing(1, 2), centre_of_mass=moving(x=0.15 + 0.1 * np.sin(TIME)))
    assert float(line_distance_max(swept)) == pytest.approx(0.1 / np.sqrt(2), rel=1e-3)
    for feet in ((0, 1, 2), (1,), ()):
        assert np.isnan(line_distance(hand_made(foot_force=standing(*feet)))).all()
        assert np.isnan(line_distance_max(hand_made(foot_force=standing(*feet))))
    assert float(two_feet_alone_share(pair)) == 1.0
    half, share = np.zeros((len(TIME), 3)), float(np.mean(TIME[TIME >= 1.0] >= 5.0))
    half[TIME >= 5.0, 2] = 1.0
    beside = {"tail_force": half, "belly_force": np.stack([half, 0 * half], axis=1)}
    for name, force in beside.items():  # a tail or a belly that lies on the ground is a third support
        third = swept.assign({name: swept[name].copy(data=force)})
        assert float(two_feet_alone_share(third)) == pytest.approx(1.0 - share)
        assert np.isnan(line_distance_max(third, 5.0))
        assert float(line_distance_max(third)) > 0.0


def test_two_feet_stand_for_a_share_of_the_time():
    force = standing(1, 2)
    half = TIME >= 5.0
    force[half] = standing(0, 1, 2)[half]
    assert float(two_feet_share(hand_made(foot_force=force))) == pytest.approx(0.5, abs=2e-3)
    assert float(two_feet_share(hand_made())) == 0.0


def test_a_foot_is_lifted_by_how_far_it_rises():
    feet = np.tile(FEET, (len(TIME), 1, 1))
    feet[:, 2, 2] = 0.03 * np.sin(np.pi * TIME / 4) ** 2
    assert foot_clearance(hand_made(foot_position=feet)).values == pytest.approx([0.0, 0.0, 0.03, 0.0], abs=1e-6)


def test_the_tail_carries_a_share_of_the_weight():
    lying = hand_made(tail_force=np.tile([0.0, 0.0, 0.1 * 2.0 * 9.81], (len(TIME), 1)))
    assert float(tail_load_share(lying)) == pytest.approx(0.1)


def test_stances_of_a_diagonal_pair_that_come_apart():
    def walking(*phases):
        force = np.zeros((len(TIME), 4, 3))
        for i, phase in enumerate(phases):
            force[:, i, 2] = 5.0 * (np.mod((TIME - 1) / 4 + phase, 1.0) < 0.5)
        return float(diagonal_phase_error(hand_made(foot_force=force)))

    assert walking(0.0, 0.5, 0.5, 0.0) == pytest.approx(0.0, abs=5e-3)
    assert walking(0.0, 0.5, 0.5, 0.2) == pytest.approx(0.2, abs=5e-3)
    assert walking(0.0, 0.3, 0.5, 0.0) == pytest.approx(0.2, abs=5e-3)
    assert walking(0.0, 0.5, 0.45, 0.95) == pytest.approx(0.05, abs=5e-3)


def bending(tail) -> xr.Dataset:
    """Return a record whose tail's two joints share a bend."""
    record = hand_made().drop_vars(["joint_angle", "joint"])
    names = [*JOINTS, "tail_yaw_1", "tail_yaw_2"]
    angles = np.column_stack([np.full(len(TIME), -0.1)] * 3 + [0.75 * tail, 0.25 * tail])
    return record.assign(joint_angle=(("time", "joint"), angles)).assign_coords(joint=names)


def test_a_bend_is_the_sum_of_its_joints_to_the_right():
    record = bending(0.4 * np.sin(2 * np.pi * (TIME - 1) / 4))
    assert lateral_bend(record, "spine").values == pytest.approx(0.3)  # its yaw turns the front end left
    assert float(tail_amplitude(record)) == pytest.approx(0.4, rel=1e-3)
    assert float(tail_swing_least(record)) == pytest.approx(0.4, rel=1e-3)
    assert float(tail_swings(record)) == pytest.approx(2.0)
    assert float(spine_swings(record)) == 0.0


def test_a_tail_that_never_gets_to_one_side_swings_less_than_nothing_there():
    record = bending(0.3 + 0.1 * np.sin(2 * np.pi * (TIME - 1) / 4))
    assert float(tail_swing_least(record)) == pytest.approx(-0.2, rel=1e-3)
    both_sides = record.time.copy(data=0.1 + 0.3 * np.sin(2 * np.pi * (TIME - 1) / 4))
    assert float(smaller_swing(both_sides)) == pytest.approx(0.2, rel=1e-3)
    assert float(smaller_swing(-both_sides)) == pytest.approx(0.2, rel=1e-3)
    assert float(tail_swings(record)) == 0.0


def test_small_wiggles_are_no_swings_and_two_waves_a_cycle_are_four_changes():
    turn = 2 * np.pi * (TIME - 1) / 4
    assert float(tail_swings(bending(np.sin(turn) + 0.02 * np.sin(40 * turn)))) == pytest.approx(2.0)
    assert float(tail_swings(bending(np.sin(2 * turn)))) == pytest.approx(4.0)


def test_how_much_of_a_bend_is_a_sine():
    turn = 2 * np.pi * (TIME - 1) / 4
    for wave, share in ((np.sin(turn + 0.3), 1.0), (np.sign(np.sin(turn)), 8 / np.pi**2), (np.sin(2 * turn), 0.0)):
        record = hand_made(joint_angle=np.column_stack([wave, wave, wave]))
        assert float(spine_sine_share(record)) == pytest.approx(share, abs=5e-3)
    assert float(spine_sine_share(hand_made())) == 0.0


def standing(*feet) -> np.ndarray:
    """Return forces under which the given feet stand."""
    force = np.zeros((len(TIME), 4, 3))
    force[:, list(feet), 2] = 5.0
    return force


def test_a_window_outside_the_record_is_a_sentence():
    with pytest.raises(IncompatibleRecord, match="nothing to measure is left between 20"):
        time_window(hand_made(), 20.0, 30.0)
