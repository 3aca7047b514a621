"""The mean of several cycles, and its first harmonic."""

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import IncompatibleRecord
from suchus.sim.metrics import each_cycle, first_harmonic, mean_cycle


def waved(end=5.0, dt=0.01):
    time = np.arange(0.0, end + dt / 2, dt)
    values = np.stack([1.0 + 0.5 * np.cos(2 * np.pi * (time - 0.1)), time], axis=-1)
    return xr.DataArray(values, dims=("time", "leg"), coords={"time": time, "leg": ["a", "b"]})


def test_a_wave_is_its_own_mean_and_a_drift_is_taken_at_its_middle():
    mean = mean_cycle(waved(), 1.0, 1.0, 3)
    assert mean.dims == ("phase", "leg")
    assert mean.sel(leg="b").values == pytest.approx(2.0 + mean.phase.values)
    first = first_harmonic(mean.sel(leg="a"))
    assert abs(complex(first)) == pytest.approx(0.5)
    assert np.angle(complex(first)) == pytest.approx(-0.2 * np.pi)


def test_a_period_that_is_no_whole_number_of_samples_is_interpolated():
    one = each_cycle(waved().sel(leg=["b"]), 0.005, 1.237, 2)
    assert one.sizes == {"cycle": 2, "phase": 124, "leg": 1}
    assert one.values[1, 0, 0] == pytest.approx(1.242)


@pytest.mark.parametrize(("start", "cycles"), [(0.0, 6), (-1.0, 2), (4.5, 1), (0.0, 0)])
def test_cycles_beyond_the_record_are_refused(start, cycles):
    with pytest.raises(IncompatibleRecord, match="cycles of 1 s"):
        mean_cycle(waved(), start, 1.0, cycles)
