from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog.pattern_generator.experiment import _lags, _lock_measures, experiment, lock_error
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS


def test_the_lock_error_is_that_of_the_farthest_oscillator_whatever_they_have_in_common():
    place = np.array([0.0, 0.25, 0.5, 0.9])
    assert lock_error(place + 7.3, place) == pytest.approx(0.0, abs=1e-6)
    one_off = place + np.array([0.0, 0.0, 0.0, 0.1])
    common = np.angle(3 + np.exp(0.2j * np.pi))
    assert lock_error(one_off, place) == pytest.approx(0.2 * np.pi - common)
    both = lock_error(np.stack([place, one_off]), place)
    assert both == pytest.approx([0.0, 0.2 * np.pi - common], abs=1e-6)


def record(error, within=0.1, hold=2.0):
    """Return a record of starts whose errors are given once a cycle."""
    rows = np.array(error, dtype=float)
    return xr.Dataset(
        {"walk_error": (("walk_start", "walk_cycle"), rows)},
        coords={"walk_cycle": np.arange(rows.shape[1], dtype=float)},
        attrs={"within": within, "hold": hold},
    )


def test_a_start_is_locked_from_when_it_stays_for_long_enough():
    found = _lock_measures(
        record(
            [
                [1.0, 1.0, 0.05, 0.05, 0.05, 0.05],  # locked from cycle 2 on
                [1.0, 0.05, 1.0, 0.05, 0.05, 0.05],  # for good from cycle 3 on
                [1.0, 1.0, 1.0, 1.0, 0.05, 0.05],  # not for long enough
                [0.05] * 6,  # always
            ]
        ),
        "walk",
        "",
    )
    assert found["locked_share"].value == 0.75
    assert found["lock_cycles"].value == pytest.approx(5 / 3)
    assert found["lock_cycles_most"].value == 3.0
    none = _lock_measures(record([[1.0] * 6]), "walk", "")
    assert none["locked_share"].value == 0.0
    assert np.isnan(none["lock_cycles"].value)


def test_lags_are_counted_from_head_to_tail_the_short_way_round():
    assert _lags(np.array([0.0, -0.1, -0.2, -0.7])) == pytest.approx([0.1, 0.1, -0.5])
    assert _lags(np.array([0.0, 0.9, 0.8])) == pytest.approx([0.1, 0.1])
    assert _lags(np.zeros(1)) == pytest.approx([0.0])


def measures(**changes):
    found = {
        "standing_index_walk": 0.92,
        "standing_index_swim": 0.1,
        "frequency_walk": 1.0,
        "lag_swim": 0.125,
        "frequency_below": 1.5,
        "frequency_above": 2.25,
        "frequency_jump": 1.5,
        "turn_steering": 0.08,
        "turn_asymmetry": 0.01,
        "turn_straight": 0.0,
        "drive_swim_speed": 0.16,
        "drive_walk_speed": 0.08,
        "drive_changes": 1.0,
        "drive_ashore": 0.6,
        "drive_ashore_unfelt": -1.9,
    }
    for end in ("", "_swim"):
        found |= {f"locked_share{end}": 1.0, f"lock_cycles{end}": 1.0, f"lock_cycles{end}_most": 2.0}
    return found | changes


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "they entrain the axis: a standing wave"),
        ({"standing_index_walk": 0.79}, "they entrain the axis: no standing wave"),
        ({"standing_index_swim": 0.81}, "oscillates by itself: a standing wave"),
        ({}, "frequency rises from"),
        ({"frequency_jump": 0.5}, "frequency falls from"),
        ({"frequency_jump": 1.005}, "frequency stays from"),
        ({}, "the bend turns more"),
        ({"turn_asymmetry": -0.2}, "the bend turns less"),
    ],
)
def test_what_it_says_follows_from_its_measures(changes, said):
    assert said in experiment.explain(measures(**changes))


def test_it_refuses_what_cannot_walk_and_settings_that_ask_nothing():
    with pytest.raises(UnsuitedRobot, match="needs limbs to walk on; robot 'swimmer' lacks that"):
        replace(experiment, robot=ROBOTS["swimmer"], gait=GAITS["undulation"]).run()
    with pytest.raises(InvalidDesign, match="swim is 3"):
        replace(experiment, swim=3.0)
    with pytest.raises(InvalidDesign, match="drives is"):
        replace(experiment, drives=(6.0,))
