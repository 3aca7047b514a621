"""Measures of the page are those of ``sim.metrics`` on the same records."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.laboratory.page_modules import needs_node, run

import suchus
from suchus.apps.laboratory.description import physics_facts
from suchus.robot.design import GRAVITY
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import cost_of_transport, displacement, duty_factor
from suchus.sim.metrics.contact import limb_load
from suchus.sim.metrics.gait import stance
from suchus.sim.metrics.stability import height_peak_to_peak

pytestmark = needs_node


def case(record, end=None):
    """Return a record as the page keeps it, and the window to measure."""
    load = limb_load(record).sel(xyz="z").transpose("time", "leg").values
    return {
        "record": {
            "time": record.time.values.tolist(),
            "com": record.centre_of_mass.values.tolist(),
            "load": load.tolist(),
            "power": record.servo_absolute_power.sum("servo").values.tolist(),
        },
        "start": START,
        "end": float(record.time[-1]) if end is None else end,
        "weight": float(record.mass) * GRAVITY,
        "period": float(record.period),
        "loads": physics_facts(ROBOTS["caiman"], GAITS["belly_crawl"], swims=False)["loads"],
    }


@pytest.fixture(scope="module")
def records():
    caiman, strider = ROBOTS["caiman"], ROBOTS["strider"]
    quick = replace(GAITS["belly_crawl"], period=1.0)
    return [
        suchus.crawl(caiman, quick, cycles=2, timestep=0.005),
        suchus.crawl(strider, default_gait(strider), cycles=2, timestep=0.005),
    ]


def test_they_agree_over_whole_cycles_and_over_a_part(records):
    cases = [(record, end) for record in records for end in (None, START + 1.0, START + 1.37)]
    results = run("measures", cases=[case(*one) for one in cases])
    for (record, end), found in zip(cases, results, strict=True):
        assert found["displacement"] == pytest.approx(displacement(record, end=end).values, abs=1e-12)
        assert found["height"] == pytest.approx(float(height_peak_to_peak(record, end=end)), abs=1e-12)
        assert found["cost"] == pytest.approx(float(cost_of_transport(record, end=end)), rel=1e-9)
        assert found["duty"] == pytest.approx(duty_factor(record, end=end).values, abs=1e-12)


def test_stances_of_loads_that_bounce_at_the_ends_and_between(records):
    rng = np.random.default_rng(0)
    record = records[0]
    weight, time = float(record.mass) * GRAVITY, np.arange(401) * 0.01
    steps = np.repeat(rng.uniform(size=(80, 4)), 6, axis=0)[: len(time)]  # flips of some lengths about both bounds
    load = np.where(steps < 0.4, rng.uniform(0.0, 0.03, steps.shape), rng.uniform(0.02, 0.5, steps.shape))
    load[rng.uniform(size=load.shape) < 0.2] = 0.0
    made = record.isel(time=np.zeros(len(time), dtype=int)).assign_coords(time=time)
    force = np.zeros((len(time), 4, 3))
    force[..., 2] = weight * load
    made = made.assign(foot_force=(("time", "leg", "xyz"), force)).drop_vars("limb_force")
    found = run("measures", cases=[case(made)])[0]["duty"]
    in_window = stance(made).sel(time=made.time[(made.time > START - 1e-9)][:-1])
    assert 0.1 < float(in_window.mean()) < 0.9
    assert found == pytest.approx(in_window.mean("time").values, abs=1e-12)
    assert isinstance(made, xr.Dataset)
