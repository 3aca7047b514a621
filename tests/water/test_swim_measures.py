from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import OutsideLimits
from suchus.robot.motion import check_limits, check_speeds
from suchus.swimming.water import (
    Quarters,
    Sway,
    SwimMeasures,
    convex_higher,
    efficiency,
    fit,
    fits_of_readings,
    max_amplitude_factor,
    printed_wave,
    readings_table,
    survey,
    swing,
    wave_form,
)

PHASE = np.arange(1, 121) / 120


def _held(thrust, aside, difference):
    """Return a held swim of two measured cycles, the last as the functions of the angle say, the first twice that."""
    at = 2 * np.pi * np.array([0.25, 0.5, 0.75, 1.0])
    data = {"thrust": thrust(at), "aside": aside(at), "difference": difference(at), "place": 0.2 + 0.3 * at / np.pi}
    return xr.Dataset(
        {f"quarter_{name}": (("settled", "instant"), [2 * values, values]) for name, values in data.items()}
        | {"difference": ("phase", difference(2 * np.pi * PHASE))},
        coords={"phase": PHASE, "settled": [2, 3], "instant": [0.25, 0.5, 0.75, 1.0]},
    )


def scaled(motion, amplitude, frequency):
    return replace(motion.bent(amplitude), period=1.0 / frequency)


def check_swim(robot, motion):
    check_limits(robot, motion)
    check_speeds(robot, motion)


def test_the_quarters_of_every_cycle_are_read_the_last_one_last():
    held = _held(lambda p: 3 - np.cos(2 * p), lambda p: 4 * np.sin(p), lambda p: 100 * np.sin(p) + 10)
    first, last = Quarters.from_record(held)
    assert last.difference == pytest.approx([110, 10, -90, 10])
    assert first.difference == pytest.approx([220, 20, -180, 20])
    assert last.moves == pytest.approx(0.3)
    assert convex_higher(held) == pytest.approx(0.5, abs=0.04)


def test_a_sway_is_what_comes_once_a_cycle_and_its_noise_the_rest():
    t = np.arange(161) / 40
    once, twice = np.sin(2 * np.pi * t + 0.3), np.sin(4 * np.pi * t)
    sway = Sway.from_track(0.02 * once + 0.005 * twice + 0.1 * t, 4)
    assert sway.amplitude == pytest.approx(0.02)
    assert sway.noise == pytest.approx(2 * 0.005 / np.sqrt(2), rel=1e-3)
    growing = Sway.from_track(0.01 * (1 + (t >= 2.0)) * once, 4)
    assert growing.noise > 0.005
    straight = Sway.from_track(0.3 * t, 4)
    assert straight.amplitude == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(ValueError, match="no whole number"):
        Sway.from_track(once[:-1], 4)


def test_a_wave_of_the_form_is_found_and_another_is_not():
    s = np.linspace(0.0, 1.0, 65)
    linear, quadratic, waves, share = wave_form(s, 0.01 * s + 0.09 * s**2, 0.8 * s + 0.35)
    assert (abs(linear), abs(quadratic), waves) == pytest.approx((0.01, 0.09, 0.8), rel=1e-3)
    assert share == pytest.approx(1.0, abs=1e-9)
    assert wave_form(s, 0.01 * s + 0.09 * s**2, -0.8 * s)[2] == pytest.approx(-0.8, rel=1e-3)  # from tail to head
    assert wave_form(s, 0.1 * (1 - s) + 0.01, 0.8 * s)[3] < 0.8  # the head swings most


def test_a_swim_in_numbers():
    t = np.arange(241) / 120
    free = xr.Dataset(
        {
            "speed": ("cycle", [0.3, 0.4]),
            "power": ("cycle", [7.0, 8.0]),
            "wave_speed": 1.6,
            "weight": 100.0,
            "tail_y": ("sample", 0.1 * np.sin(2 * np.pi * t) + 0.02 * t),
            "heading": ("sample", 0.2 * np.cos(2 * np.pi * t)),
        }
    )
    swum = SwimMeasures.from_record(free, 2.0)
    assert swum.speed == 0.4
    assert swum.gain == pytest.approx(1 / 3)
    assert swum.slip == pytest.approx(0.25)
    assert swum.strouhal == pytest.approx(2.0 * 0.2 / 0.4, rel=1e-6)
    assert swum.water_cost_of_transport == pytest.approx(0.2)
    assert swum.head_yaw == pytest.approx(0.2)
    assert efficiency(5.0, 0.4, 8.0) == pytest.approx(0.25)


def test_a_swing_is_as_much_of_a_sine_as_it_is():
    t, drift = np.arange(241) / 120, 0.3 * np.arange(241) / 240
    pure, zigzag, twice = np.sin(2 * np.pi * t), 2 * np.abs(2 * (t % 1) - 1) - 1, np.sin(4 * np.pi * t)
    swung = swing(np.column_stack([0.2 * pure + drift, zigzag, pure + twice, 0 * t]))
    np.testing.assert_allclose(swung.amplitude, [0.2, 8 / np.pi**2, 1.0, 0.0], atol=1e-3)
    assert swung.phase_lag[0] == pytest.approx(0.25)  # a sine comes a quarter of a cycle after a cosine
    np.testing.assert_allclose(swung.variance_fraction, [1.0, 96 / np.pi**4, 0.5, 0.0], atol=1e-3)


def test_every_reading_is_tried_and_the_table_says_why_not(robot):
    tried = fits_of_readings(robot, frequency=1.0)
    made = {one.letter for one in tried if one.fit is not None}
    assert {"A", "C", "F", "H", "I", "K"} <= made
    assert not made & {"B", "D", "G", "J"}
    table = readings_table(tried, {"I": "28.0 N/m"})
    assert len(table.splitlines()) == 2 + 11
    assert "spine_yaw_1 for 2.09 rad" in table
    assert "28.0 N/m" in table


def test_a_survey_follows_frequency_and_amplitude(robot):
    motion = fit(robot, printed_wave(robot)).gait
    slow, fast, small = (scaled(motion, *how) for how in ((1.0, 0.5), (1.0, 1.0), (0.5, 1.0)))
    found = survey(robot, [slow, fast, small, scaled(motion, 1.0, 4.0)], stations=49)
    speed = found.speed.values
    assert np.all(speed[:, 1] > 1.8 * speed[:, 0])  # friction's share falls with the speed
    assert np.all(speed[:, 2] < 0.6 * speed[:, 1])
    assert found.possible.values.tolist() == [True, True, True, False]
    assert np.all((found.efficiency > 0) & (found.efficiency < 1))
    assert np.all(found.water_cost_of_transport > 0)


def test_the_greatest_amplitude_is_the_last_that_can_be_followed(robot):
    motion = fit(robot, printed_wave(robot)).gait
    for frequency, joint in ((1.5, "asks tail_cable of"), (0.25, "the hinges of cable tail_cable")):
        slow = scaled(motion, 1.0, frequency)
        most = max_amplitude_factor(robot, slow)
        check_swim(robot, scaled(motion, most, frequency))
        with pytest.raises(OutsideLimits, match=joint):
            check_swim(robot, scaled(motion, most + 2e-4, frequency))
    assert max_amplitude_factor(robot, scaled(motion, 1e-3, 0.1), max_factor=2.0) == 2.0
