"""What the feet did: when they were loaded, and what gait that makes."""

import numpy as np
import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.robot.motion import START
from suchus.sim.metrics.contact import ground_force, limb_load
from suchus.sim.metrics.window import time_window

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
    return limb_load(record).sel(xyz="z") > threshold_of(record, threshold)


def threshold_of(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray | float:
    """Return the least normal force of what carries [N]: the one given, or ``LOADED_SHARE`` of the weight."""
    return LOADED_SHARE * GRAVITY * record.mass if threshold is None else threshold


def duty_factor(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which each foot stands [-]."""
    return loaded(_cycles(record, start, end)).mean("time")


def two_feet_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which exactly two feet stand, as in a trot [-]."""
    return (loaded(_cycles(record, start, end)).sum("leg") == 2).mean("time")


def foot_clearance(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far each foot is lifted above its lowest place on even ground [m]."""
    height = time_window(record, start, end).foot_position.sel(xyz="z")
    return height.max("time") - height.min("time")


def sensed_phase(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the phase by which each leg is ahead of the first, LF, from the first harmonic of its stance [cycle].

    Args:
        record: over a whole number of cycles.
        start: [s].
        end: [s]; the last sample if None.
    """
    window = _cycles(record, start, end)
    stands = loaded(window).astype(float)
    turn = np.exp(-2j * np.pi * (window.time - window.time[0]) / window.period)
    angle = xr.apply_ufunc(np.angle, (stands * turn).sum("time"))
    return np.mod((angle - angle.isel(leg=0, drop=True)) / (2 * np.pi), 1.0)


def diagonal_phase_error(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far apart in phase the stances of a diagonal pair are, of the pair that is farthest [cycle].

    Diagonal are a limb and that of the other side of the next girdle; a body of one girdle has no such pair.
    """
    phase = sensed_phase(record, start, end)
    phase_errors = [
        abs((phase.isel(leg=first_leg, drop=True) - phase.isel(leg=second_leg, drop=True) + 0.5) % 1.0 - 0.5)
        for first_leg, second_leg in diagonals(phase.sizes["leg"])
    ]
    if not phase_errors:
        return phase.isel(leg=0, drop=True) * float("nan")
    return xr.concat(phase_errors, "pair", coords="minimal", compat="override").max("pair")


def diagonals(legs: int) -> list[tuple[int, int]]:
    """Return the diagonal pairs of limbs that are listed girdle by girdle, left before right."""
    return [pair for i in range(0, legs - 2, 2) for pair in ((i, i + 3), (i + 1, i + 2))]


def _cycles(record: xr.Dataset, start: float, end: float | None) -> xr.Dataset:
    """Return the window without its last sample, which begins the next cycle."""
    return time_window(record, start, end).isel(time=slice(0, -1))


def flight_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which neither limbs nor belly nor tail carry any of the weight [-].

    Carrying is more than a thousandth of the weight, so that the rounding of a contact does not count.
    """
    window = time_window(record, start, end)
    return (ground_force(window).sel(xyz="z") < 1e-3 * record.mass * GRAVITY).mean("time")


measures = (diagonal_phase_error, duty_factor, flight_share, foot_clearance, sensed_phase, two_feet_share)
