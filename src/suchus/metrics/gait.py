"""What the feet did: when they were loaded, and what gait that makes."""

import numpy as np
import xarray as xr

LOADED = 0.5
"""Least normal force of a foot that counts as standing [N]; about a sixteenth of its share of the weight."""


def loaded(record: xr.Dataset, threshold: float = LOADED) -> xr.DataArray:
    """Tell which feet stand, from their pressure."""
    return record.foot_force.sel(xyz="z") > threshold


def duty_factor(record: xr.Dataset, threshold: float = LOADED) -> xr.DataArray:
    """Return the share of the time in which each foot stands [-]."""
    return loaded(record, threshold).mean("time")


def sensed_phase(record: xr.Dataset, threshold: float = LOADED) -> xr.DataArray:
    """Return the phase by which each leg is ahead of LF, from the first harmonic of its stance [cycle].

    Args:
        record: over a whole number of cycles.
        threshold: least normal force of a standing foot [N].
    """
    stands = loaded(record, threshold).astype(float)
    turn = np.exp(-2j * np.pi * (record.time - record.time[0]) / record.period)
    angle = xr.apply_ufunc(np.angle, (stands * turn).sum("time"))
    return np.mod((angle - angle.sel(leg="LF", drop=True)) / (2 * np.pi), 1.0)
