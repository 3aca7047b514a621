"""What the feet did: when they were loaded, and what gait that makes."""

import numpy as np
import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.robot.motion import START
from suchus.sim.metrics.contact import ground_force, limb_load
from suchus.sim.metrics.window import time_window

LOADED_SHARE = 0.0145
"""Least normal force of a limb that carries at an instant [weight of the robot]."""


STANCE_BEGIN_LOAD, STANCE_END_LOAD = 0.05, 0.025
"""Mean loads of a limb above which its stance begins and below which it ends [weight of the robot]."""
MIN_STANCE_FRACTION = 0.04
"""Fraction of the cycle over which a limb's load is averaged; also the shortest stance and swing [cycle]."""


def stance(record: xr.Dataset) -> xr.DataArray:
    """Return over time whether each limb is in stance, by its vertical load over the robot's weight [-].

    A foot on stiff ground bounces, so that the load drops to zero for single physics steps. Stances are found in three
    passes:

    1. The load is averaged over ``MIN_STANCE_FRACTION`` of the cycle. A stance begins where this mean rises above
       ``STANCE_BEGIN_LOAD``, and ends where it falls below ``STANCE_END_LOAD``.
    2. Swings shorter than ``MIN_STANCE_FRACTION`` are filled. Then stances that are shorter are dropped.
    3. The mean rises before the load does and falls after it. Each stance is therefore trimmed: it lasts from the
       first sample of the load itself above ``STANCE_BEGIN_LOAD`` to the last one above ``STANCE_END_LOAD``.

    Duty factors and phases change by less than 0.01 between time steps of 0.5 and 5 ms. ``loaded`` says which limbs
    carry at an instant.

    Args:
        record: record of one run or several, over at least one cycle.

    Returns:
        True in stance, with the dimensions of ``limb_load`` but for ``xyz``.
    """
    load = limb_load(record).sel(xyz="z", drop=True) / (record.mass * GRAVITY)
    sample_interval = float(record.time[1] - record.time[0]) if record.sizes["time"] > 1 else np.inf
    in_stance: xr.DataArray = xr.apply_ufunc(
        _stance_of_limb,
        load,
        record.period,
        input_core_dims=[["time"], []],
        output_core_dims=[["time"]],
        kwargs={"sample_interval": sample_interval},
        vectorize=True,
        output_dtypes=[bool],
    )
    return in_stance.transpose(*load.dims)


def _stance_of_limb(load: np.ndarray, period: float, sample_interval: float) -> np.ndarray:
    """Return whether one limb is in stance, shape (time,).

    Args:
        load: vertical load, shape (time,) [weight of the robot]; NaN where nothing is known.
        period: period of the gait [s].
        sample_interval: time between samples [s].
    """
    window_samples = MIN_STANCE_FRACTION * period / sample_interval
    half_window = min(round(window_samples / 2), len(load) - 1)
    padded = np.pad(np.nan_to_num(load), half_window, mode="edge")
    mean = np.convolve(padded, np.full(2 * half_window + 1, 1.0 / (2 * half_window + 1)), mode="valid")
    is_decided = (mean > STANCE_BEGIN_LOAD) | (mean < STANCE_END_LOAD)
    last_decision = np.maximum.accumulate(np.where(is_decided, np.arange(len(load)), 0))
    in_stance = without_short_intervals(mean[last_decision] > STANCE_BEGIN_LOAD, round(window_samples))
    return in_stance & _between_loads(in_stance, np.nan_to_num(load))


def _between_loads(in_stance: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Return whether each sample lies from the first load of its stance to the last one, shape (time,).

    The record's first and last samples may lie within a stance, which then reaches to the record's end.

    Args:
        in_stance: whether the limb is in stance, shape (time,).
        load: shape (time,) [weight of the robot].
    """
    interval_index = np.cumsum(np.diff(in_stance, prepend=in_stance[:1]))  # of the interval of equal state
    index, count = np.arange(len(in_stance)), int(interval_index[-1]) + 1
    first, last = np.full(count, len(in_stance)), np.full(count, -1)
    is_above_begin, is_above_end = load > STANCE_BEGIN_LOAD, load > STANCE_END_LOAD
    np.minimum.at(first, interval_index[is_above_begin], index[is_above_begin])
    np.maximum.at(last, interval_index[is_above_end], index[is_above_end])
    first[0], last[-1] = 0, len(in_stance)
    return np.asarray((index >= first[interval_index]) & (index <= last[interval_index]))


def without_short_intervals(state: np.ndarray, samples: int, values: tuple[bool, ...] = (False, True)) -> np.ndarray:
    """Return a state over time without intervals shorter than some samples, shape (time,).

    Intervals at the ends of the record stay: nobody knows how long they are.

    Args:
        state: true or false, shape (time,).
        samples: number of samples from which on an interval stays [-].
        values: values whose short intervals are removed, in this order.
    """
    for value in values:
        starts = np.concatenate([[0], np.flatnonzero(np.diff(state)) + 1])
        lengths = np.diff([*starts, len(state)])
        is_short = (state[starts] == value) & (lengths < samples)
        is_short[[0, -1]] = False
        state = np.repeat(state[starts] ^ is_short, lengths)
    return state


def loaded(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray:
    """Tell which limbs carry at each instant; for stances, which last, see ``stance``.

    Args:
        record: record of one run or several, or one instant.
        threshold: least normal force of a limb that carries [N]; ``LOADED_SHARE`` of the weight if None.
    """
    return limb_load(record).sel(xyz="z") > threshold_of(record, threshold)


def threshold_of(record: xr.Dataset, threshold: float | None = None) -> xr.DataArray | float:
    """Return the least normal force of what carries [N]: the one given, or ``LOADED_SHARE`` of the weight."""
    return LOADED_SHARE * GRAVITY * record.mass if threshold is None else threshold


def duty_factor(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which each foot stands [-]."""
    return _stance_in_cycles(record, start, end).mean("time")


def two_feet_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which exactly two feet stand, as in a trot [-]."""
    return (_stance_in_cycles(record, start, end).sum("leg") == 2).mean("time")


def foot_clearance(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far each foot is lifted above its lowest place on even ground [m]."""
    height = time_window(record, start, end).foot_position.sel(xyz="z")
    return height.max("time") - height.min("time")


def sensed_phase(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the phase by which each leg is ahead of the first, LF, from the first harmonic of its stance [cycle].

    Args:
        record: record over a whole number of cycles.
        start: [s].
        end: [s]; the last sample if None.
    """
    window = _cycles(record, start, end)
    stands = _stance_in_cycles(record, start, end).astype(float)
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


def _stance_in_cycles(record: xr.Dataset, start: float, end: float | None) -> xr.DataArray:
    """Return the stances in whole cycles, as what lies before and after them decides."""
    return stance(record).sel(time=_cycles(record, start, end).time)


def flight_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which neither limbs nor belly nor tail carry any of the weight [-].

    Carrying is more than a thousandth of the weight, so that the rounding of a contact does not count.
    """
    window = time_window(record, start, end)
    return (ground_force(window).sel(xyz="z") < 1e-3 * record.mass * GRAVITY).mean("time")


measures = (diagonal_phase_error, duty_factor, flight_share, foot_clearance, sensed_phase, two_feet_share)
