"""The swims of swim_free in a flow: what is measured of a record, and a whole run in space."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.errors import InvalidDesign
from suchus.experiments import EXPERIMENTS
from suchus.experiments.swim_free.in_flow import flow_speed, water_of
from suchus.land.waters import Slice, Space


def test_the_speed_is_that_of_the_last_cycle():
    time = np.linspace(0.0, 3.0, 301)
    x = np.where(time < 2.0, 0.1 * time, 0.2 + 0.4 * (time - 2.0))
    centre = np.stack([x, 0 * x, 0 * x], axis=1)[None]
    record = xr.Dataset(
        {"flow_centre_of_mass": (("flow_run", "flow_time", "xyz"), centre), "flow_period": ((), 1.0)},
        coords={"flow_run": ["whole"], "flow_time": time, "xyz": list("xyz")},
    )
    assert flow_speed(record, "whole") == pytest.approx(0.4)


def test_the_rung_has_the_settings_that_were_asked_for():
    assert water_of("slice", 64, 1e3, 0.1) == Slice(cells=64, reynolds=1e3)
    assert water_of("space", 64, 1e3, 0.1) == Space(cells=64, reynolds=1e3, tail_height=0.1)


def test_impossible_settings_are_refused():
    one = EXPERIMENTS["swim_free"]
    with pytest.raises(InvalidDesign, match="in_flow names sideways"):
        replace(one, in_flow=("sideways",))
    with pytest.raises(InvalidDesign, match="flow_cycles is 1"):
        replace(one, flow_cycles=1)


@pytest.mark.slow("two cycles of a robot in a flow")
def test_a_robot_swims_in_space_beside_its_swims_at_the_surface():
    outcome = replace(EXPERIMENTS["swim_free"].quick(), water="space").run()
    m = {name: measure.value for name, measure in outcome.measures.items()}
    assert 0.0 < m["coupling_residual"] < 0.01
    assert m["coupling_residual"] < m["coupling_first"]
    assert m["energy_error"] < 0.02
    assert m["power_error"] < 0.05
    assert abs(m["speed_space"]) > 1e-3
    assert m["link_added"] > 0
    assert {"link_r2", "joint_r2"} <= m.keys()  # which the words name
    drawn = EXPERIMENTS["swim_free"].draw(outcome)
    assert {"flow_speeds", "flow_links", "flow_residual", "flow_balance"} <= {*drawn}
    assert "residual.md" in outcome.tables
    assert "swim_in_flow.gif" in outcome.films
    assert "solved together" in outcome.decides
