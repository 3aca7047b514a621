import numpy as np
import pytest
import xarray as xr

from suchus.errors import OutsideLimits
from suchus.motion import check_swim
from suchus.water import (
    Quarters,
    Swum,
    attempts,
    convex_higher,
    crossings,
    efficiency,
    fit,
    greatest,
    printed_wave,
    readings_table,
    scaled,
    survey,
    swing,
)

PHASE = np.arange(1, 121) / 120


def _held(thrust, aside, difference):
    at = 2 * np.pi * PHASE
    data = {"thrust": thrust(at), "aside": aside(at), "difference": difference(at), "place": 0.2 + 0.6 * PHASE}
    return xr.Dataset(
        {name: ("phase", values) for name, values in data.items()},
        coords={"phase": PHASE, "instant": [0.25, 0.5, 0.75, 1.0]},
    )


def test_a_mirrored_stroke_is_what_the_article_says():
    held = _held(lambda p: 3 - np.cos(2 * p), lambda p: 5 * np.sin(p), lambda p: 100 * np.sin(p))
    said = Quarters.of(held)
    assert said.convex
    assert said.diagonal
    assert said.falls
    assert said.mirrored
    assert said.moves == pytest.approx(0.15)
    assert said.asymmetry == pytest.approx(0.0, abs=1e-12)
    assert convex_higher(held) == pytest.approx(0.5, abs=0.01)


def test_a_lopsided_stroke_is_not():
    held = _held(np.sin, lambda p: 5 * np.sin(p), lambda p: -100 * np.cos(p) - 1)
    said = Quarters.of(held)
    assert not said.convex
    assert not said.falls
    assert not said.mirrored
    assert said.asymmetry == pytest.approx(0.4)


def test_a_swim_in_numbers():
    t = np.arange(241) / 120
    free = xr.Dataset(
        {
            "speed": ("cycle", [0.3, 0.4]),
            "power": ("cycle", [7.0, 8.0]),
            "wave_speed": 1.6,
            "weight": 100.0,
            "tail_y": ("sample", 0.1 * np.sin(2 * np.pi * t) + 0.02 * t),
            "snout_y": ("sample", 0.05 * np.sin(2 * np.pi * t) - 0.3 * t),
            "heading": ("sample", 0.2 * np.cos(2 * np.pi * t)),
        }
    )
    swum = Swum.of(free, 2.0)
    assert swum.speed == 0.4
    assert swum.gain == pytest.approx(1 / 3)
    assert swum.slip == pytest.approx(0.25)
    assert swum.strouhal == pytest.approx(2.0 * 0.2 / 0.4, rel=1e-6)
    assert swum.cost_of_transport == pytest.approx(0.2)
    assert swum.head_yaw == pytest.approx(0.2)
    assert crossings(free) >= 3
    assert efficiency(5.0, 0.4, 8.0) == pytest.approx(0.25)


def test_a_swing_is_as_much_of_a_sine_as_it_is():
    t, drift = np.arange(241) / 120, 0.3 * np.arange(241) / 240
    pure, zigzag, twice = np.sin(2 * np.pi * t), 2 * np.abs(2 * (t % 1) - 1) - 1, np.sin(4 * np.pi * t)
    amplitude, share = swing(np.column_stack([0.2 * pure + drift, zigzag, pure + twice, 0 * t]))
    np.testing.assert_allclose(amplitude, [0.2, 8 / np.pi**2, 1.0, 0.0], atol=1e-3)
    np.testing.assert_allclose(share, [1.0, 96 / np.pi**4, 0.5, 0.0], atol=1e-3)


def test_every_reading_is_tried_and_the_table_says_why_not(robot):
    tried = attempts(robot, frequency=1.0)
    made = {one.letter for one in tried if one.fitted is not None}
    assert {"A", "C", "F", "H", "I", "K"} <= made
    assert not made & {"B", "D", "G", "J"}
    table = readings_table(tried, {"I": "28.0 N/m"})
    assert len(table.splitlines()) == 2 + 11
    assert "spine_yaw_1 for 2.09 rad" in table
    assert "28.0 N/m" in table


def test_a_survey_follows_frequency_and_amplitude(robot):
    motion = fit(robot, printed_wave(robot)).swim
    slow, fast, small = (scaled(motion, *how) for how in ((1.0, 0.5), (1.0, 1.0), (0.5, 1.0)))
    found = survey(robot, [slow, fast, small, scaled(motion, 1.0, 4.0)], stations=49)
    speed = found.speed.values
    assert np.all(speed[:, 1] > 1.8 * speed[:, 0])  # friction's share falls with the speed
    assert np.all(speed[:, 2] < 0.6 * speed[:, 1])
    assert found.possible.values.tolist() == [True, True, True, False]
    assert np.all((found.efficiency > 0) & (found.efficiency < 1))
    assert np.all(found.cost_of_transport > 0)


def test_the_greatest_amplitude_is_the_last_that_can_be_followed(robot):
    motion = fit(robot, printed_wave(robot)).swim
    for frequency, joint in ((1.5, "tail_cable at"), (0.25, "bends tail_cable")):
        slow = scaled(motion, 1.0, frequency)
        most = greatest(robot, slow)
        check_swim(robot, scaled(motion, most, frequency))
        with pytest.raises(OutsideLimits, match=joint):
            check_swim(robot, scaled(motion, most + 2e-4, frequency))
    assert greatest(robot, scaled(motion, 1e-3, 0.1), most=2.0) == 2.0
