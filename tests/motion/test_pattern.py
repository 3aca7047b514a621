"""Movements of any body: foot paths, cranks, held limbs, the wave along the axis."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from suchus.design import layout
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.gaits import GAITS
from suchus.kinematics import landmarks
from suchus.motion import AxialWave, Held, Sweep, hip_height, middle_stance, pattern_targets
from suchus.motion.any_body import bend, check_limbs, path
from suchus.robots import ROBOTS

SALAMANDER, WALK = ROBOTS["salamander"], GAITS["salamander_walk"]
CLOCK = np.linspace(0.0, 1.0, 201)


def test_feet_are_where_their_paths_are():
    targets = pattern_targets(SALAMANDER, WALK, CLOCK)
    place = layout(SALAMANDER)
    angles = np.zeros((len(CLOCK), len(place.hinges)))
    angles[:, list(place.servo_hinges)] = targets
    angles[:, place.ahead] = 0.0  # a straight axis, so that girdles are parallel to the root
    feet = landmarks(SALAMANDER, angles).feet
    for i, limb in enumerate(place.limbs):
        does, girdle = WALK.girdles[limb.number], limb.girdle
        reach = girdle.limb.reach
        ahead, up = np.moveaxis(path(WALK, does, CLOCK + WALK.limb_phases[i]), -1, 0) * reach
        rest = landmarks(SALAMANDER, 0 * angles[0]).feet[i] - [0.0, limb.side * reach, 0.0]
        found = feet[:, i] - rest
        np.testing.assert_allclose(found[:, 0], ahead, atol=1e-12)
        np.testing.assert_allclose(limb.side * found[:, 1], does.outward * reach, atol=1e-12)
        down = hip_height(SALAMANDER, WALK) + girdle.above - girdle.limb.foot.radius
        np.testing.assert_allclose(found[:, 2], up - down, atol=1e-12)


def test_a_stance_goes_back_at_constant_speed_and_does_not_lift():
    does = WALK.girdles[0]
    stance = np.linspace(1.0 - WALK.duty_factor, 1.0, 50)
    ahead, up = np.moveaxis(path(WALK, does, stance), -1, 0)
    np.testing.assert_allclose(np.diff(ahead), np.diff(ahead)[0], atol=1e-12)
    assert (ahead[0], ahead[-1]) == pytest.approx((does.stroke, -does.stroke))
    assert not up.any()
    swing = np.linspace(0.0, 1.0 - WALK.duty_factor, 51)
    assert path(WALK, does, swing)[:, 1].max() == pytest.approx(does.lift)


def test_a_standing_wave_has_one_phase_and_a_running_one_lags_toward_the_tail():
    running = replace(GAITS["undulation"])
    crests = [np.argmin(bend(running, s, CLOCK[:-1])) / 200 for s in (0.0, 0.25, 0.5, 0.75)]
    assert crests == pytest.approx([0.0, 0.25, 0.5, 0.75], abs=0.006)
    standing = replace(running, wave=replace(running.wave, waves=0.0))
    assert {int(np.argmin(bend(standing, s, CLOCK[:-1]))) for s in (0.0, 0.5, 1.0)} == {0}


def test_the_trunk_is_concave_on_the_right_when_lf_touches_down_and_an_offset_turns_it_left():
    place = layout(SALAMANDER)
    touch_down = 0.75 - WALK.duty_factor / 2 - WALK.limb_phases[0]
    there = pattern_targets(SALAMANDER, WALK, np.array(touch_down))
    assert (there[list(place.trunk_yaw)] < 0).all()  # positive is left
    turned = replace(WALK, wave=replace(WALK.wave, offset=radians(2)))
    more = pattern_targets(SALAMANDER, turned, CLOCK) - pattern_targets(SALAMANDER, WALK, CLOCK)
    np.testing.assert_allclose(
        more[:, list(place.axial_yaw)], radians(2) * np.array(place.axial_left) + 0 * more[:, :1]
    )


def test_a_crank_stands_slowly_below_and_returns_over_the_top():
    robot, gait = ROBOTS["salamandra"], GAITS["salamandra_walk"]
    place = layout(robot)
    angle = pattern_targets(robot, gait, CLOCK)[:, place.limbs[0].servos.start]
    assert (np.diff(angle) < 0).all()
    stands = (1.0 - gait.duty_factor <= CLOCK) & (CLOCK < 1.0)
    low = gait.girdles[0].stance / 2 + 1e-9
    assert (np.abs(angle[stands]) <= low).all()
    over = np.angle(np.exp(1j * angle[~stands]))
    assert (np.abs(over) >= low - 2e-9).all()
    assert angle[-1] - angle[0] == pytest.approx(-2 * np.pi)


def test_limbs_can_be_held_back_as_in_swimming():
    held = Held(angles=(radians(-85), 0.0, 0.0, 0.0))
    swim = replace(WALK, name="swim", girdles=(held, held))
    targets = pattern_targets(SALAMANDER, swim, CLOCK)
    assert (targets[:, 0] == radians(-85)).all()
    with pytest.raises(OutsideLimits, match="holds 1 angles of girdle F; its limbs have 4 servos"):
        check_limbs(SALAMANDER, replace(swim, girdles=(Held(angles=(0.0,)), held)))


def test_in_the_middle_of_stance_the_axis_is_straight_and_all_feet_stand_level():
    servos = middle_stance(SALAMANDER, WALK)
    place = layout(SALAMANDER)
    assert not servos[list(place.axial_yaw)].any()
    angles = np.zeros(len(place.hinges))
    angles[list(place.servo_hinges)] = servos
    assert np.ptp(landmarks(SALAMANDER, angles).feet[:, 2]) < 1e-12


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: replace(WALK, limb_phases=(0.0, 0.5)), "2 limb phases for 2 girdles"),
        (lambda: replace(WALK, limb_phases=(0.0, 0.5, 0.5, 7.0)), "-1 to 1 cycle is allowed"),
        (lambda: replace(WALK, period=0.0), r"pattern.period is 0 s"),
        (lambda: replace(WALK.girdles[0], stroke=2.0), r"foot_path.stroke is 2 limb reach"),
        (lambda: AxialWave(amplitude=((0.5, 0.1), (0.5, 0.2)), waves=0.0, phase=0.0), "a place that increases"),
        (lambda: AxialWave(amplitude=(), waves=0.0, phase=0.0), "a place that increases"),
        (lambda: Sweep(stance=7.0, down=0.0), r"sweep.stance is 7 rad"),
    ],
)
def test_an_impossible_movement_is_refused(make, says):
    with pytest.raises(InvalidDesign, match=says):
        make()
