"""What the feet did: when they were loaded, and what gait that makes."""

import numpy as np
import xarray as xr

from suchus.metrics.window import between
from suchus.motion import START

LOADED = 0.5
"""Least normal force of a foot that counts as standing [N]; about a sixteenth of its share of the weight."""


def loaded(record: xr.Dataset, threshold: float = LOADED) -> xr.DataArray:
    """Tell which feet stand, from their pressure."""
    return record.foot_force.sel(xyz="z") > threshold


def duty_factor(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which each foot stands [-]."""
    return loaded(_cycles(record, start, end)).mean("time")


def two_feet_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which exactly two feet stand, as in a trot [-]."""
    return (loaded(_cycles(record, start, end)).sum("leg") == 2).mean("time")


def foot_clearance(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far each foot is lifted above its lowest place on even ground [m]."""
    height = between(record, start, end).foot_position.sel(xyz="z")
    return height.max("time") - height.min("time")


def sensed_phase(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the phase by which each leg is ahead of LF, from the first harmonic of its stance [cycle].

    Args:
        record: over a whole number of cycles.
        start: [s].
        end: [s]; the last sample if None.
    """
    part = _cycles(record, start, end)
    stands = loaded(part).astype(float)
    turn = np.exp(-2j * np.pi * (part.time - part.time[0]) / part.period)
    angle = xr.apply_ufunc(np.angle, (stands * turn).sum("time"))
    return np.mod((angle - angle.sel(leg="LF", drop=True)) / (2 * np.pi), 1.0)


def diagonal_phase_error(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far apart in phase the stances of a diagonal pair are, of the pair that is farther [cycle]."""
    phase = sensed_phase(record, start, end)
    of = {leg: phase.sel(leg=leg, drop=True) for leg in ("RF", "LH", "RH")}
    apart = [np.abs((difference + 0.5) % 1.0 - 0.5) for difference in (of["RH"], of["RF"] - of["LH"])]
    return np.maximum(*apart)


def _cycles(record: xr.Dataset, start: float, end: float | None) -> xr.Dataset:
    """Return the window without its last sample, which begins the next cycle."""
    return between(record, start, end).isel(time=slice(0, -1))
