"""Pitch held by air that moves between chambers: signs and limits by hand, a plant of one line, then the water."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.felt import felt as feels
from tests.start_batch import start_batch
from tests.swims import crocodile_swim

from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle
from suchus.robot.control import DepthHold, PitchHold, Sensed, Swimming
from suchus.robot.control.holding import neutral_air_fraction
from suchus.robot.control.trim import PitchHolds
from suchus.robot.design.pieces import chambers
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate

ROBOT, PERIOD = ROBOTS["floating_caiman"], 0.01
IN_FOAM = replace(ROBOT, hull=replace(ROBOT.hull, chambers=()))
WAVE = crocodile_swim()
FAST = {"memory": 0.0, "pump": 100.0, "integral_gain": 0.0}
AIR = np.array(chambers(ROBOT))
LEFT = np.array([0.0, 1.0, 0.0])


def sensed(*, pitch=0.0, rate=0.0, depth=0.6):
    """What a robot feels whose nose is down by ``pitch``."""
    return feels(ROBOT, orientation=from_axis_angle(LEFT, pitch), angular_velocity=[0.0, rate, 0.0], depth=depth)


def hold(rule, depth=0.6, robot=ROBOT):
    return PitchHolds([rule], [depth], [robot], PERIOD)


@pytest.mark.parametrize(("pitch", "rate"), [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.05), (0.0, -0.05)])
def test_a_nose_that_is_down_gets_air_ahead_and_the_whole_stays(pitch, rate):
    kept = hold(PitchHold(**FAST)).split(np.array([0.5]), sensed(pitch=pitch, rate=rate))[0]
    moved = 0.2 * pitch + 0.4 * rate
    assert kept - 0.5 == pytest.approx(moved * AIR.sum() / AIR * [1.0, -1.0])
    assert kept @ AIR == pytest.approx(0.5 * AIR.sum())


@given(st.floats(0.0, 1.0), st.floats(-1.5, 1.5), st.floats(-5.0, 5.0))
def test_no_chamber_is_more_than_full_or_less_than_empty(air_fraction, pitch, rate):
    machine = hold(PitchHold(memory=0.0, pump=100.0, integral_gain=5.0))
    for _ in range(3):
        kept = machine.split(np.array([air_fraction]), sensed(pitch=pitch, rate=rate))[0]
        assert ((kept >= -1e-12) & (kept <= 1.0 + 1e-12)).all()
        assert kept @ AIR == pytest.approx(air_fraction * AIR.sum(), abs=1e-15)


def test_air_moves_no_faster_than_the_pump():
    machine, before = hold(PitchHold(pump=0.1)), None
    for _ in range(50):
        kept = machine.split(np.array([0.5]), sensed(pitch=1.0))[0, 0]
        if before is not None:
            assert kept - before == pytest.approx(0.1 * PERIOD * AIR.sum() / AIR[0])
        before = kept


def test_an_air_fraction_that_is_left_to_the_lake_stays_so_and_another_run_is_not_touched():
    machine = PitchHolds([PitchHold(**FAST), None], [0.6, 0.6], [ROBOT, ROBOT], PERIOD)
    felt = sensed(pitch=0.1)
    both = {name: np.repeat(getattr(felt, name), 2, axis=0) for name in Sensed.__dataclass_fields__ if name != "time"}
    kept = machine.split(np.array([np.nan, 0.5]), Sensed(time=0.0, **both))
    assert np.isnan(kept[0]).all()
    assert kept[1].tolist() == [0.5, 0.5]


def test_it_dives_nose_down_and_rises_nose_up_and_no_steeper_than_asked():
    rule = PitchHold(dive=1.0, steepest=0.3, **FAST)
    for depth, asked in ((0.5, 0.1), (0.7, -0.1), (0.0, 0.3), (5.0, -0.3), (0.6, 0.0)):
        kept = hold(rule).split(np.array([0.5]), sensed(pitch=asked, depth=depth))[0]
        assert kept == pytest.approx([0.5, 0.5])
    level = hold(rule).split(np.array([0.5]), sensed(depth=0.5))[0]
    assert level[0] < 0.5  # too high: air goes behind, the nose down


def pitch_after(rule, seconds, moment=0.0):
    """Return the pitch over time of a hovering body that is pushed nose down, in quadratic drag."""
    machine, theta, q, found = hold(rule), 0.6, 0.0, []
    neutral = neutral_air_fraction(ROBOT)
    for _ in range(round(seconds / PERIOD)):
        kept = machine.split(np.array([neutral]), sensed(pitch=theta, rate=q))[0]
        ahead = (kept[0] - neutral) * AIR[0] * 1000 * 9.81
        q += PERIOD * (moment - 0.37 * ahead - 0.18 * np.sin(theta) - 0.3 * abs(q) * q) / 0.4
        theta += PERIOD * q
        found.append(theta)
    return np.array(found)


def test_the_pitch_settles_within_a_degree_and_left_alone_it_swings_on():
    held = pitch_after(PitchHold(), 40.0)
    free = pitch_after(PitchHold(gain=0.0, rate_gain=0.0, integral_gain=0.0), 40.0)
    assert np.abs(held[-500:]).max() < 0.0175
    assert np.abs(free[-1000:]).max() > 0.1


def test_a_moment_that_stays_is_learnt():
    held = pitch_after(PitchHold(), 80.0, moment=0.05)
    without = pitch_after(PitchHold(integral_gain=0.0), 80.0, moment=0.05)
    assert np.abs(held[-500:]).max() < 0.0175
    assert np.abs(without[-500:]).min() > 0.05


def test_a_swim_at_depth_is_level_and_with_the_air_in_its_foam_nose_up():
    swim = Swimming(depth=DepthHold(depth=0.5))
    runs = [
        Run(robot=robot, gait=WAVE, lake=Lake(level=2.0), control=control)
        for robot, control in ((ROBOT, replace(swim, pitch=PitchHold())), (IN_FOAM, swim))
    ]
    record = simulate(runs, duration=14.0, timestep=0.005, sample_stride=10)
    end = record.sel(time=slice(11.0, None))
    held, foam = rotation.pitch(end.orientation.values).mean(axis=1)
    assert abs(held) < 0.05
    assert foam < -0.35  # nose up
    depth = (end.water_level - end.position.sel(xyz="z")).values
    assert np.abs(depth[0] - 0.5).max() < 0.05
    air = end.isel(run=0)
    rear = (air.air_fraction - air.air_fraction_front * AIR[0] / AIR.sum()) * AIR.sum() / AIR[1]
    assert float(np.abs(air.air_fraction_front - rear).max()) > 0.01  # it does move air


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PitchHold(pitch=2.0), "pitch_hold.pitch is 2 rad"),
        (lambda: PitchHold(pump=0.0), "pitch_hold.pump is 0 1/s"),
        (lambda: Swimming(pitch=PitchHold()), "swimming.depth is None; give it a DepthHold"),
        (
            lambda: start_batch(
                Swimming(depth=DepthHold(depth=1.0), pitch=PitchHold()),
                [replace(ROBOT, hull=replace(ROBOT.hull, foam=one_sided(), air=3e-4, chambers=()))],
                [WAVE],
                [0],
                10,
                PERIOD,
            ),
            "no air that could move between a front and a rear chamber",
        ),
    ],
)
def test_a_pitch_that_cannot_be_held_is_refused(make, message):
    with pytest.raises(InvalidDesign, match=message):
        make()


def one_sided():
    """Return the foam without that of the thorax, so that all air is behind."""
    return tuple(foam for foam in ROBOT.hull.foam if foam.body != "thorax")
