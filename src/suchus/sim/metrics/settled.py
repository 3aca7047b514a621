"""From which cycle on a swim is settled, its mean from there, and the interval of that mean."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.special import stdtrit

from suchus.core import rotation

MIN_BATCHES = 4
"""Fewest batches from which an interval is made [-]; Student's factor is 3.2 with four and 4.3 with three."""
MIN_SETTLED_CYCLES = 2 * MIN_BATCHES
"""Fewest cycles over which a mean can be settled [-]: four batches of two."""
SETTLED_TOLERANCE = 0.02
"""Greatest distance of the mean of settled cycles from the limit of the fit, over the scale of the quantity [-]."""
VISIBLE_TREND = 0.005
"""Distance above which a trend that stands out from the scatter is refused, over the scale of the quantity [-]."""
_CONFIDENCE = 0.95
_DECAY_TIMES = 12  # number of time constants that are tried [-]


class SettledMean(NamedTuple):
    """Mean of a quantity over its settled cycles."""

    start: int
    """First cycle of the mean, counted from 0 [-]."""
    mean: float
    """Mean from there to the end, in the unit of the quantity."""
    low: float
    """Lower end of the interval of the settled mean; NaN where the series is too short to be settled."""
    high: float
    """Upper end of that interval; NaN where the series is too short to be settled."""
    is_settled: bool
    """Whether the quantity is settled; False means *too short to be settled*."""


def settled_mean(
    cycle_values: Float[np.ndarray, " cycle"],
    *,
    scale: float | None = None,
    fallback_cycles: int = 1,
) -> SettledMean:
    """Return the mean of a quantity from the first cycle on from which it has no trend.

    An exponential approach ``limit + distance exp(-i / time)`` is fitted to the cycles i from a candidate on, by least
    squares, with time constants from a third of a cycle to the number of these cycles. The mean of the fitted approach
    must be nearer to its limit than ``SETTLED_TOLERANCE`` times the scale. If it is farther than ``VISIBLE_TREND``
    times the scale, it must also be less than two standard errors of the fit. A constant drift is an approach with the
    longest time constant, and so is refused. The first accepted candidate is the start. At least
    ``MIN_SETTLED_CYCLES`` must follow.

    The interval is Student's of 95 % on the means of batches of equal length. Batches of short length are correlated,
    and few batches say little of the scatter. So all numbers of batches from ``MIN_BATCHES`` on are tried, and the
    widest interval is returned. The remaining distance to the limit is added to it.

    Args:
        cycle_values: value of each cycle, from rest.
        scale: magnitude to which the tolerance belongs, in the unit of the values; the size of the mean if None.
        fallback_cycles: last cycles whose mean is returned where the series is too short to be settled [-].

    Raises:
        ValueError: there is no cycle.

    Source: Law 2015, Simulation Modeling and Analysis, 5th edition, section 9.5 (batch means).
    """
    values = np.asarray(cycle_values, float)
    if not values.size:
        raise ValueError("A settled mean needs at least one cycle; the series is empty.")
    for start in range(len(values) - MIN_SETTLED_CYCLES + 1):
        tail = values[start:]
        mean = float(tail.mean())
        distance, standard_error = _distance_to_limit(tail)
        relative_distance = distance / max(abs(mean) if scale is None else scale, np.finfo(float).tiny)
        is_visible = relative_distance > VISIBLE_TREND and distance > 2.0 * standard_error
        if relative_distance <= SETTLED_TOLERANCE and not is_visible:
            half_width = _half_width(tail) + distance
            return SettledMean(start, mean, mean - half_width, mean + half_width, True)
    start = len(values) - min(max(fallback_cycles, 1), len(values))
    return SettledMean(start, float(values[start:].mean()), float("nan"), float("nan"), False)


def _distance_to_limit(tail: np.ndarray) -> tuple[float, float]:
    """Return how far the mean of the fitted exponential approach is from its limit, and the standard error of that.

    Both are NaN if a value is not finite.

    Args:
        tail: values of the candidate's cycles.
    """
    cycles, deviations = np.arange(len(tail)), tail - tail.mean()
    least_residual, distance, standard_error = np.inf, float("nan"), float("nan")
    for time_constant in np.geomspace(1.0 / 3.0, len(tail), _DECAY_TIMES):
        decay = np.exp(-cycles / time_constant)
        decay_deviations = decay - decay.mean()
        norm = float(decay_deviations @ decay_deviations)
        amplitude = float(decay_deviations @ deviations) / norm
        residual = float(np.sum((deviations - amplitude * decay_deviations) ** 2))
        if residual < least_residual:
            least_residual, distance = residual, abs(amplitude) * float(decay.mean())
            standard_error = float(np.sqrt(residual / (len(tail) - 2) / norm) * decay.mean())
    return distance, standard_error


def _half_width(tail: np.ndarray) -> float:
    """Return half of the widest Student interval on batch means."""
    half_widths = []
    for batches in range(MIN_BATCHES, len(tail) + 1):
        length = len(tail) // batches
        means = tail[len(tail) - batches * length :].reshape(batches, length).mean(axis=1)
        student = float(stdtrit(batches - 1, 0.5 + 0.5 * _CONFIDENCE))
        half_widths.append(student * float(means.std(ddof=1)) / np.sqrt(batches))
    return float(max(half_widths))


def whole_cycles(time: Float[np.ndarray, " time"], period: float, start: float = 0.0) -> int:
    """Return how many whole cycles a record has; the last may end half a sample after it.

    A run ends at the control period nearest to its duration.

    Args:
        time: time of the samples, equally spaced [s].
        period: period of the cycle [s].
        start: time at which the first cycle begins [s].
    """
    half_sample = 0.5 * (time[-1] - time[-2]) if len(time) > 1 else 0.0
    return max(int((time[-1] - start + half_sample) / period + 1e-6), 0)


def cycle_speeds(record: xr.Dataset, period: float, start: float = 0.0) -> Float[np.ndarray, " cycle"]:
    """Return the mean speed of the centre of mass in each whole cycle [m/s].

    The speed is that of the horizontal displacement of a cycle. It is negative where the body moves tail first.

    Args:
        record: record of one run, with ``centre_of_mass`` and ``orientation``.
        period: period of the cycle [s].
        start: time at which the first cycle begins [s].
    """
    time = record.time.values.astype(float)
    ends = start + period * np.arange(whole_cycles(time, period, start) + 1)
    centre = record.centre_of_mass.transpose("time", "xyz").values[:, :2]
    facing = rotation.rotate(record.orientation.transpose("time", "wxyz").values, np.array([1.0, 0.0, 0.0]))[:, :2]
    positions = np.stack([np.interp(ends, time, column) for column in centre.T], axis=1)
    headings = np.stack([np.interp(ends, time, column) for column in facing.T], axis=1)
    steps = np.diff(positions, axis=0)
    forward = np.einsum("ij,ij->i", steps, headings[1:] + headings[:-1])
    return np.asarray(np.copysign(np.hypot(*steps.T), forward) / period)
