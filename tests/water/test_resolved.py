from dataclasses import replace

import numpy as np
import pytest
from tests.swims import crocodile_swim

import suchus
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.progress import silent
from suchus.robot.motion import straight_gait
from suchus.swimming.water import ExactWave, Outline
from suchus.swimming.water.immersed import immersed
from suchus.swimming.water.resolved import (
    ON_THE_SPOT,
    TETHERED,
    SwimSetting,
    check_resolved_swim,
    resolved_swim,
    towed_drag,
)

MOTION = crocodile_swim(yaw=(0.35, 0.15, 0.1), yaw_lag=(0.1, -0.1, -0.3), tail_lag=-0.1)
COARSE = SwimSetting(cells=32, viscosity=1e-3, cycles=1)
COARSE_TETHERED = replace(COARSE, free=TETHERED)


@pytest.mark.parametrize("time", [0.2, 0.47, 1.3])
def test_the_sections_move_as_the_midline_changes(robot, time):
    shape = immersed(Outline(robot, 65), MOTION, sway=0.01 + 0.02j, turn=0.1 - 0.05j, grow=0.5)
    now, before, after = (shape.spine(t) for t in (time, time - 1e-6, time + 1e-6))
    for name in ("x", "y", "heading"):
        difference = (getattr(after, name) - getattr(before, name)) / 2e-6
        np.testing.assert_allclose(getattr(now, f"{name}_rate"), difference, atol=1e-6)


def test_a_motion_grows_from_a_straight_body_at_rest(robot):
    spine = immersed(Outline(robot, 65), MOTION, turn=0.1, grow=0.5).spine(0.0)
    assert np.all(spine.y == 0.0)
    assert np.all(spine.y_rate == 0.0)


def test_a_body_that_does_not_move_feels_nothing(robot):
    record = resolved_swim(robot, straight_gait(robot), COARSE_TETHERED)
    assert float(abs(record.thrust).max()) < 1e-9
    assert float(abs(record.joint_torque).max()) < 1e-9


def test_a_mirrored_start_gives_a_mirrored_track(robot):
    here, there = (resolved_swim(robot, motion, COARSE) for motion in (MOTION, MOTION.lagged(0.5)))
    assert float(here.speed[-1]) == pytest.approx(float(there.speed[-1]), abs=1e-4)
    np.testing.assert_allclose(here.snout_y, -there.snout_y, atol=1e-4)
    assert float(abs(here.snout_y).max()) > 1e-3


class _Flat:
    """A wave of even amplitude, so that head and tail differ by the body's outline alone."""

    period = 1.0

    def __init__(self, length, sign):
        self.length, self.rate, self.number = length, sign * 2 * np.pi, 2 * np.pi / length

    def displacement(self, x, time):
        return 0.05 * self.length * np.sin(self.number * x + self.rate * time)

    def slope(self, x, time):
        return 0.05 * self.length * self.number * np.cos(self.number * x + self.rate * time)


def test_a_reversed_wave_gives_a_reversed_thrust(robot):
    to_tail, to_head = (
        float(
            resolved_swim(robot, ExactWave(name="flat", wave=_Flat(robot.length, sign)), COARSE_TETHERED).thrust.mean()
        )
        for sign in (-1, 1)
    )
    assert to_tail > 0 > to_head


def test_a_towed_body_is_dragged_more_than_a_plate_and_less_than_a_wall(robot):
    speed, setting = 0.1, COARSE
    drag = towed_drag(robot, speed, setting, lengths=2.5)
    plate = 2 * 0.664 * 1000.0 * speed**2 * robot.length / np.sqrt(speed * robot.length / setting.viscosity)
    assert plate < drag < 0.5 * 1000.0 * speed**2 * robot.length


def test_a_longer_box_holds_the_same_body(robot):
    record = resolved_swim(robot, MOTION, replace(COARSE, box=(3.0, 1.5)))
    assert float(abs(record.speed[-1])) > 0


@pytest.mark.parametrize(
    ("box", "said"), [((0.9, 2.0), "0.9 body lengths long"), ((3.0, 0.4), "0.4 body lengths wide")]
)
def test_a_box_too_small_for_the_body_is_refused(box, said):
    with pytest.raises(InvalidDesign, match=said):
        replace(COARSE, box=box)


def test_impossible_swims_are_refused(robot):
    with pytest.raises(OutsideLimits, match="tail_cable"):
        resolved_swim(robot, replace(MOTION, period=1 / 3), COARSE)
    with pytest.raises(InvalidDesign, match="cells"):
        SwimSetting(cells=8, viscosity=1e-3, cycles=1)
    with pytest.raises(InvalidDesign, match="boundary layer"):
        resolved_swim(suchus.ROBOTS["caiman"], MOTION, replace(COARSE_TETHERED, viscosity=1e-6))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"axes": 4}, "setting.axes is 4; 2 is a slice and 3 the body in space"),
        (
            {"limbs": True, "tail_height": 0.1},
            "setting.tail_height, limbs is for a body in space, and",
        ),
        ({"axes": 3, "blunt": 1.75}, "setting.blunt is for a slice, and setting.axes is 3: leave it out"),
        ({"axes": 3, "cells": 2048}, "cells is 2048"),
    ],
)
def test_a_setting_of_the_other_kind_is_refused(given, said):
    with pytest.raises(InvalidDesign, match=said):
        replace(COARSE, **given)
    assert replace(COARSE, cells=2048).cells == 2048


def test_a_free_body_is_given_no_motion_of_its_head(robot):
    with pytest.raises(InvalidDesign, match=r"turn of the head are 0\+0j m and 0.1\+0j rad, and the body is free"):
        check_resolved_swim(robot, MOTION, COARSE, turn=0.1 + 0j)
    check_resolved_swim(robot, MOTION, COARSE_TETHERED, turn=0.1 + 0j)


def test_a_slice_kept_from_moving_on_stays_and_sways(robot):
    record = resolved_swim(robot, MOTION, replace(COARSE, free=ON_THE_SPOT), progress=silent)
    assert float(abs(record.speed).max()) == 0.0
    assert float(np.ptp(record.course_centre.values)) > 1e-3
