"""What the experiments in water measured keeps the bounds that were set before; a new run that does not is seen."""

from math import inf, isfinite

import pytest

from pages.stated import kept

TABLE = 1e-3  # share by which the public table may be missed
WANTED = {
    "floating": {
        "draft_error": (0.0, 1e-6),
        "heave_period_error": (0.0, 1e-3),
        "energy_gain": (-inf, 0.02),
        "energy_gain_rk4": (-inf, 1e-4),
        "impulse_drift": (0.0, 1e-5),
        "volume_error": (0.0, 1e-3),
        "share_above": (0.048, 0.052),
        "roll_at_rest": (0.0, 0.035),
        "vanishing_floating": (2.618, inf),
        "acceleration_neutral": (-1e-9, 1e-9),
        "force_of_ballast": (-29.43 * (1 + TABLE), -29.43 * (1 - TABLE)),
        "acceleration_of_keel": (1.1187 * (1 - TABLE), 1.1187 * (1 + TABLE)),
    },
    "swim_free": {
        "speed_reversed": (-inf, -1e-3),
        "roll_amplitude": (0.0, 0.035),
        "turn_radius": (-1.0, 1.0),
        "step_change": (0.0, 0.01),
        "pitch_deep": (-0.05, 0.05),
        "pitch_deep_held": (-0.05, 0.05),
        "pitch_deep_in_foam": (-inf, -0.35),  # what the chambers are for
        "depth_error_deep_held": (0.0, 0.05),
    },
    "shore": {
        "ashore_share": (0.9, 1.0),
        "falls": (0.0, 0.0),
        "switches": (0.0, 2.0),
        "into_water_share": (0.8, 1.0),  # one, on the flattest and most slippery shore, still wades at the end
    },
    "sections": {"held_out": (0.0, 0.15)},
}
ROWS = [(name, measure, *bounds) for name, rows in WANTED.items() for measure, bounds in rows.items()]


def outside(value, low, high):
    return not (isfinite(value) and low <= value <= high)


@pytest.mark.parametrize(("name", "measure", "low", "high"), ROWS, ids=[f"{row[0]}-{row[1]}" for row in ROWS])
def test_what_was_measured_keeps_its_bounds(name, measure, low, high):
    assert not outside(kept(name)[measure], low, high)


@pytest.mark.parametrize(("value", "broken"), [(0.048, False), (0.0479, True), (0.0521, True), (float("nan"), True)])
def test_a_measure_beyond_its_bounds_or_lost_is_seen(value, broken):
    assert outside(value, *WANTED["floating"]["share_above"]) is broken


def test_dives_are_nearer_to_level_and_faster_than_with_the_air_in_the_foam():
    m = kept("swim_free")
    assert m["speed_deep"] > 2.0 * m["speed_deep_in_foam"]
    assert m["dive_time_deep_pitched"] < m["dive_time_deep"]
    assert 0.0 < m["front_air"] < 1.0
