"""Stance: exact answers on made loads, and convergence with the time step of the physics."""

import numpy as np
import pytest
import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import duty_factor, sensed_phase, stance, two_feet_share


def record_of(loads, step=0.01, period=1.0):
    """Return a record of one leg whose foot carries these shares of the weight."""
    force = np.zeros((len(loads), 1, 3))
    force[:, 0, 2] = loads
    return xr.Dataset(
        {"foot_force": (("time", "leg", "xyz"), force), "mass": 1.0 / GRAVITY, "period": period},
        coords={"time": step * np.arange(len(loads)), "leg": ["LF"], "xyz": list("xyz")},
    )


def stances(loads, **settings):
    return stance(record_of(np.asarray(loads, dtype=float), **settings)).sel(leg="LF").values


def test_a_foot_that_bounces_stands_on():
    loads = np.tile([0.25, 0.0], 100)
    assert stances(loads).all()


def test_a_load_between_the_bounds_changes_nothing():
    levels = np.repeat([0.0, 0.04, 0.1, 0.04, 0.0], 20)
    expected = np.repeat([False, False, True, True, False], 20)
    assert (stances(levels) != expected).sum() <= 4  # the mean over 5 samples rounds each edge off


def test_short_swings_and_stances_do_not_count():
    loads = np.full(100, 0.3)
    loads[40:43] = 0.0
    assert stances(loads).all()
    loads = np.zeros(100)
    loads[40] = 0.06
    assert not stances(loads).any()


def test_a_long_swing_counts_and_a_gap_in_the_record_does_not_stand():
    loads = np.full(100, 0.3)
    loads[40:60] = 0.0
    assert stances(loads).sum() == pytest.approx(80, abs=5)
    loads[80:] = np.nan
    assert not stances(loads)[83:].any()


def test_the_period_decides_what_is_short():
    loads = np.full(400, 0.3)
    loads[100:110] = 0.0
    assert not stances(loads, period=1.0).all()
    assert stances(loads, period=4.0).all()


TIMESTEPS = (0.005, 0.002, 0.001, 0.0005)
CONVERGED = {"duty": 0.01, "phase": 0.01, "two": 0.015}
"""Greatest change with the time step [cycle]; that both ends of a stance move by a sample of the record is none."""


CYCLES = {"semi_erect": 6}
"""Cycles over which a gait is measured if more than one: a foot of this gait taps in single cycles as it lands."""


def gait_measures(gait, timestep, cycles):
    robot = ROBOTS["caiman"]
    duration = round(100 * (START + cycles * gait.period)) / 100
    record = simulate([Run(robot=robot, gait=gait)], duration=duration, timestep=timestep, effort=False).isel(run=0)
    return {"duty": duty_factor(record).values, "phase": sensed_phase(record).values,
            "two": float(two_feet_share(record))}  # fmt: skip


def assert_converged(gait, timesteps):
    cycles = CYCLES.get(gait, 1)
    fine = gait_measures(GAITS[gait], timesteps[-1], cycles)
    samples = 2.0 * control_period(ROBOTS["caiman"]) / GAITS[gait].period * (1.0 + 1e-9)
    bounds = {name: max(bound * (1.0 + 1e-9), samples) for name, bound in CONVERGED.items()}
    for timestep in timesteps[:-1]:
        coarse = gait_measures(GAITS[gait], timestep, cycles)
        assert np.abs(coarse["duty"] - fine["duty"]).max() <= bounds["duty"], timestep
        assert np.abs((coarse["phase"] - fine["phase"] + 0.5) % 1.0 - 0.5).max() <= bounds["phase"], timestep
        assert abs(coarse["two"] - fine["two"]) <= bounds["two"], timestep


@pytest.mark.parametrize("gait", ["belly_crawl", "high_walk", "semi_erect"])
def test_a_gait_does_not_depend_on_the_time_step(gait):
    assert_converged(gait, (0.005, 0.002, 0.001))


@pytest.mark.slow("a time step of half a millisecond takes more than ten seconds")
@pytest.mark.parametrize("gait", ["belly_crawl", "high_walk", "semi_erect", "limbs_only"])
def test_a_gait_converges_down_to_half_a_millisecond(gait):
    assert_converged(gait, TIMESTEPS)
