"""The midline that joints really took, from the angles of a run."""

import numpy as np
import pytest
import xarray as xr
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign
from suchus.robot.design import cable_joints, layout
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline, motion_of_record, undulation, unevenness

YAW, YAW_LAG, TAIL, TAIL_LAG = (0.5, 0.4, 0.2), (0.3, 0.1, 0.0), 0.6, 0.6
SWIM = crocodile_swim(frequency=0.8, yaw=YAW, yaw_lag=YAW_LAG, tail=TAIL, tail_lag=TAIL_LAG)
ROBOT = ROBOTS["caiman"]
OUTLINE = Outline(ROBOT, 65)


def record(shares, *, duration=5.0, mean=0.0, step=0.02):
    """Return a run in which the cable's bend is shared out among its joints so, beside a mean bend [rad]."""
    time = np.arange(0.0, duration + step / 2, step)
    turn = 2 * np.pi * SWIM.frequency * time
    angles = {name: np.full(time.size, 0.3) for name in layout(ROBOT).hinges}  # nothing but yaw is looked at
    for name, size, lag in zip(OUTLINE.joints[:3], YAW, YAW_LAG, strict=True):
        angles[name] = size * np.cos(turn - 2 * np.pi * lag)
    for name, share in zip(cable_joints(ROBOT), shares, strict=True):
        angles[name] = share * TAIL * np.cos(turn - 2 * np.pi * TAIL_LAG) + mean
    for name in OUTLINE.joints[9:]:
        angles[name] = np.zeros(time.size)
    data = np.column_stack([angles[name] for name in layout(ROBOT).hinges])
    return xr.Dataset({"joint_angle": (("time", "joint"), data)}, {"time": time, "joint": list(layout(ROBOT).hinges)})


def test_joints_that_share_evenly_take_the_midline_that_was_commanded():
    found = motion_of_record(OUTLINE, record([1 / 6] * 6, mean=0.1), frequency=0.8, cycles=2)
    meant = undulation(OUTLINE, SWIM)
    assert np.abs(found.middles[:2] - meant.middles).max() < 1e-3  # samples do not fill the cycle to the last digit
    assert unevenness(found, meant) < 2e-3


def test_a_bend_that_is_shared_out_anew_is_another_midline_of_the_same_end():
    found = motion_of_record(OUTLINE, record([0.4, 0.3, 0.2, 0.1, 0.0, 0.0]), frequency=0.8, cycles=2)
    meant = undulation(OUTLINE, SWIM)
    assert abs(found.stations[1, -1]) == pytest.approx(abs(meant.stations[1, -1]), rel=2e-3)
    assert unevenness(found, meant) > 0.05
    doubled = motion_of_record(OUTLINE, record([1 / 3] * 6), frequency=0.8, cycles=2)
    behind = [OUTLINE.s > OUTLINE.joint_positions[8] + OUTLINE.reaches[8]]
    assert np.abs(doubled.stations[1] - meant.stations[1])[*behind] == pytest.approx(TAIL, rel=2e-3)


def test_a_passive_end_counts():
    one = record([1 / 6] * 6)
    straight = motion_of_record(OUTLINE, one, frequency=0.8, cycles=2)
    one.joint_angle.loc[{"joint": "fin_yaw_1"}] = 0.2 * np.cos(2 * np.pi * 0.8 * one.time.values)
    bent = motion_of_record(OUTLINE, one, frequency=0.8, cycles=2)
    assert abs(bent.stations[1, -1] - straight.stations[1, -1]) == pytest.approx(0.2, rel=2e-3)
    assert np.abs(bent.stations[1, :40] - straight.stations[1, :40]).max() < 1e-6


@pytest.mark.parametrize(("more", "cycles", "message"), [
    ({"duration": 2.0}, 2, "the run lasts 2 s, and 2 cycles of 1.25 s"),
    ({"step": 0.25}, 2, "has 5 samples; 8 are needed"),
])  # fmt: skip
def test_runs_that_say_too_little_are_refused(more, cycles, message):
    with pytest.raises(InvalidDesign, match=message):
        motion_of_record(OUTLINE, record([1 / 6] * 6, **more), frequency=0.8, cycles=cycles)
    assert motion_of_record(OUTLINE, record([1 / 6] * 6, duration=2.5), frequency=0.8, cycles=2).frequency == 0.8


def test_a_trunk_that_bends_its_front_to_the_left_turns_what_is_behind_to_the_right():
    tip = OUTLINE.joints_at(OUTLINE.s)[-1]
    assert tip[:3] == pytest.approx([-1.0] * 3)
    assert tip[3:9] == pytest.approx([1.0] * 6)
