"""What the feet did: when they were loaded, and what gait that makes."""

import numpy as np
import xarray as xr

from suchus.design import GRAVITY

LOADED_SHARE = 0.0145
"""Least normal force of a foot that counts as standing [weight of the robot]."""
LOADED = 0.5
"""The same for the article's robot [N]; about a sixteenth of a foot's share of its weight."""


def loaded(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray:
    """Tell which feet stand, from their pressure.

    Args:
        record: of one run or several.
        threshold: least normal force of a standing foot [N]; ``LOADED_SHARE`` of the weight if None.
    """
    least = LOADED_SHARE * GRAVITY * record.mass if threshold is None else threshold
    return record.foot_force.sel(xyz="z") > least


def duty_factor(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray:
    """Return the share of the time in which each foot stands [-]."""
    return loaded(record, threshold).mean("time")


def sensed_phase(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray:
    """Return the phase by which each leg is ahead of the first, LF, from the first harmonic of its stance [cycle].

    Args:
        record: over a whole number of cycles.
        threshold: see ``loaded``.
    """
    stands = loaded(record, threshold).astype(float)
    turn = np.exp(-2j * np.pi * (record.time - record.time[0]) / record.period)
    angle = xr.apply_ufunc(np.angle, (stands * turn).sum("time"))
    return np.mod((angle - angle.isel(leg=0, drop=True)) / (2 * np.pi), 1.0)
