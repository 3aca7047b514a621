"""Measures of the swims below the surface, on hand-made records; and which robots swim there."""

from dataclasses import replace
from math import isnan

import numpy as np
import pytest
import xarray as xr
from tests.swims import crocodile_swim

from evidence import store
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_free import submerged
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake

ROBOT, LAKE = ROBOTS["floating_caiman"], Lake(level=2.0)
SWIM = crocodile_swim(yaw=(0.1, 0.2, 0.3), yaw_lag=(0.0, 0.0, 0.0), tail=0.5, tail_lag=0.0)
TIME = np.linspace(0.0, 10.0, 101)


def record(depth, pitch=0.1, speed=0.2):
    """Two dives: one along the given depths, and one at the surface."""
    both = {
        "deep_pitch": np.array([np.full(101, pitch), np.zeros(101)]),
        "deep_depth": np.array([depth, np.zeros(101)]),
        "deep_along": np.array([speed * TIME, 0.0 * TIME]),
    }
    found = xr.Dataset(
        {name: (("dive", "dive_time"), values) for name, values in both.items()},
        coords={"dive": ["deep", "in_foam"], "dive_time": TIME},
        attrs={"deep_from": 6.0, "depth": 0.6, "frequency": 1.0, "measured_cycles": 4},
    )
    return found.assign(deep_trim=("dive", [0.0, -0.6]), deep_front=("dive", [0.3, 0.1]))


def test_a_dive_ends_where_it_stays_near_its_depth():
    depth = np.where(TIME < 4.0, 0.15 * TIME, 0.6 + 0.03 * np.sin(TIME))
    found = submerged.measures(record(depth))
    assert found["dive_time_deep"].value == pytest.approx(3.7, abs=0.1001)
    assert found["depth_error_deep"].value == pytest.approx(0.03 * np.abs(np.sin(TIME[60:])).max())
    assert found["pitch_deep"].value == pytest.approx(0.1)
    assert found["speed_deep"].value == pytest.approx(0.2)
    assert isnan(found["dive_time_deep_in_foam"].value)
    assert found["depth_error_deep_in_foam"].value == pytest.approx(0.6)
    again = submerged.measures(record(np.where(TIME > 9.0, 0.7, depth)))
    assert isnan(again["dive_time_deep"].value)  # it left


def test_what_is_said_of_the_swims_has_the_sign_of_their_pitch():
    explain = EXPERIMENTS["swim_free"].explain
    kept = store.load("swim_free").values
    afloat = {name: value for name, value in kept.items() if "deep" not in name}
    for pitch, words in ((0.1, "nose down by 6 degrees"), (-0.1, "nose up by 6 degrees"), (0.005, "level")):
        m = {name: one.value for name, one in submerged.measures(record(np.full(101, 0.6), pitch)).items()}
        assert f"it swims {words} (level with all air in the foam), at" in explain(afloat | m)
    assert "Below the surface" not in explain(afloat)
    assert submerged.measures(xr.Dataset()) == {}


def test_a_robot_dives_in_as_many_ways_as_its_air_allows():
    def names(robot):
        return [run.label for run in submerged.deep_runs(robot, SWIM, LAKE, 0.6)]

    assert names(ROBOT) == list(submerged.DIVE_LABELS)
    assert names(replace(ROBOT, hull=replace(ROBOT.hull, chambers=()))) == ["deep", "held", "pitched"]
    assert names(replace(ROBOT, hull=replace(ROBOT.hull, air=1e-5))) == []
    assert names(ROBOTS["caiman"]) == []


def test_what_hovers_is_level_by_design_and_nose_up_with_the_air_in_its_foam():
    runs = {run.label: run for run in submerged.deep_runs(ROBOT, SWIM, LAKE, 0.6)}
    assert abs(submerged._hovering(runs["deep"])) < 1e-6
    assert submerged._hovering(runs["in_foam"]) < -0.5
    assert EXPERIMENTS["swim_free"].depth == 0.6
