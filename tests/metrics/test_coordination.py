from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from suchus.robot.design import LEGS
from suchus.sim.metrics.coordination import cycles_until, phase_error


def phases(values):
    return xr.DataArray(np.atleast_2d(values), dims=("time", "leg"), coords={"leg": list(LEGS)})


@given(st.floats(-3.0, 3.0))
def test_limbs_in_the_gaits_phases_have_no_error_whenever_it_is(crawl_gait, now):
    for gait in (crawl_gait, crawl_gait.mirrored(), replace(crawl_gait, limb_phases=(0.0, 0.5, 0.75, 0.25))):
        assert phase_error(phases(now + np.array(gait.limb_phases)), gait).item() == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("leg", "off", "error"), [(0, 0.2, 0.2), (1, -0.3, 0.3), (2, 0.5, 0.5), (3, 0.8, 0.2)])
def test_one_limb_that_is_off_is_the_error_on_the_circle(crawl_gait, leg, off, error):
    values = np.array(crawl_gait.limb_phases)
    values[leg] += off
    assert phase_error(phases(values), crawl_gait).item() == pytest.approx(error)


def test_pairs_that_walk_together_instead_of_in_turns_are_half_a_cycle_off(crawl_gait):
    assert phase_error(phases(np.zeros(4)), crawl_gait).item() == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("outside", "expected"),
    [
        ((), 0.0),
        ((0.0, 2.0), 2.1),  # seconds from the start in which the error is large; a sample lasts 0.1 cycle
        ((0.0, 2.0, 3.0, 3.4), 3.5),  # a relapse counts
        ((2.0, 3.0), 3.1),
        ((0.0, 9.0), np.inf),  # not held for two cycles
        ((0.0, 10.0), np.inf),
    ],
)
def test_convergence_is_for_good_or_not_at_all(outside, expected):
    cycles = np.arange(-5, 101) / 10
    error = np.zeros(cycles.size)
    error[:5] = 0.4  # before the start nothing counts
    for low, high in zip(outside[::2], outside[1::2], strict=True):
        error[(cycles > low - 1e-9) & (cycles < high + 1e-9)] = 0.3
    series = xr.DataArray(error, dims="time", coords={"time": 1.0 + 4.0 * cycles})
    assert cycles_until(series, 4.0, start=1.0, hold=2.0).item() == pytest.approx(expected)
