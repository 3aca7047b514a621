"""Measures of a servo's loop, on responses with a known answer."""

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog.joint_loops.experiment import JointLoops, overshoot, rise_time

TIME = np.linspace(0.0, 2.0, 2001)


def test_the_rise_time_of_a_first_order_lag_is_ln_9_time_constants():
    assert rise_time(TIME, 0.2 * (1 - np.exp(-TIME / 0.1)), 0.2) == pytest.approx(0.1 * np.log(9), abs=0.002)
    assert np.isnan(rise_time(TIME, 0.2 * 0.5 * TIME / 2.0, 0.2))


def test_the_overshoot_of_a_damped_swing_is_that_of_the_textbook():
    damping = 0.5
    swing = damping / np.sqrt(1 - damping**2)
    angle = 1 - np.exp(-damping * 20 * TIME) * (
        np.cos(20 * np.sqrt(1 - damping**2) * TIME) + swing * np.sin(20 * np.sqrt(1 - damping**2) * TIME)
    )
    assert overshoot(0.3 * angle, 0.3) == pytest.approx(np.exp(-np.pi * swing), abs=1e-4)
    assert overshoot(0.3 * (1 - np.exp(-TIME)), 0.3) == 0.0


def record(droops=(0.03, 0.01), end=0.1, ripple=0.0):
    """Two gains; the step ends at ``end`` of 0.1 rad, the load at ``droops``."""
    angle = np.empty((3, 2, len(TIME)))
    angle[[0, 2]] = end + 0.5 * ripple * np.cos(50 * TIME)
    angle[1] = np.array(droops)[:, None]
    told = {
        "angle": (("test", "ki", "time"), angle),
        "unlimited_angle": (("test", "time"), angle[:, 1] * np.array([1.0, 0.25, 1.0])[:, None]),
        "error_ms": (("ki", "servo"), np.array([[4e-4, 2e-4], [1e-4, 1e-4]])),
        "less_droop_ms": ("servo", np.array([1e-4, 5e-5])),
        "less_both_ms": ("servo", np.array([1e-4, 2e-5])),
        "forward": ("ki", [0.7, 0.8]),
    }
    coords = {"ki": [0.0, 20.0], "test": ["step", "load", "let_go"], "time": TIME, "servo": ["a", "b"]}
    return xr.Dataset(told, coords=coords, attrs={"step": 0.1, "load": 1.2, "kp": 40.0, "joint": "a"})


def test_measures_of_a_record_with_a_known_answer():
    m = {name: measure.value for name, measure in JointLoops().measure(record(ripple=0.002)).items()}
    assert m["droop_taken_pid"] == pytest.approx(2 / 3)
    assert m["load_error_pid"] == pytest.approx(0.01)
    assert m["load_error_pid_unlimited"] == pytest.approx(0.0025)
    assert m["droop_taken_pid_unlimited"] == pytest.approx(11 / 12)
    assert m["droop_by_kp"] == pytest.approx(0.03)
    assert m["ripple_pid"] == pytest.approx(0.002, rel=1e-3)
    assert m["tracking_error_ki_0"] == pytest.approx(np.sqrt(3e-4))
    assert m["tracking_by_droop"] == pytest.approx(0.75)
    assert m["tracking_by_damping"] == pytest.approx(0.05)
    assert JointLoops().measure(record(end=0.13))["step_error_pid"].value == pytest.approx(0.03)
    assert JointLoops().measure(record(droops=(0.01, 0.03)))["droop_taken_pid"].value == pytest.approx(-2.0)


def test_a_shortened_run_is_not_judged():
    assert JointLoops().unjudged() == ""
    assert "integrals has 2 values" in JointLoops().quick().unjudged()
    with pytest.raises(InvalidDesign, match="must begin with 0"):
        JointLoops(integrals=(5.0, 20.0))
