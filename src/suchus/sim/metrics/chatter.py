"""Chatter: how much of the servos' motion and torque is far above the frequency of the gait."""

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.robot.motion import START
from suchus.sim.metrics.energy import effort
from suchus.sim.metrics.window import time_window

CHATTER_HARMONIC = 10.0
"""Multiple of the gait's frequency above which motion is chatter [-]."""


def chatter(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the fraction of the power of the servos' torques above ten times the frequency of the gait [-].

    The power is that of the torque less its mean, added up over the servos. Between samples it is that of the mean
    torques, seen through a Hann window; within the time between two samples it is the mean square less the square of
    the mean. It is not a number in a run that ended early or moves nothing, over less than one cycle, and where ten
    times the frequency is beyond what the samples show.

    Args:
        record: record of one run or several.
        start: [s].
        end: [s]; the last sample if None.

    Raises:
        IncompatibleRecord: the record does not hold what the servos do.
    """
    mean = effort(record, "servo_mean_torque", start, end)
    within = (effort(record, "servo_mean_square_torque", start, end) - mean**2).clip(min=0.0)
    fraction = _high_fraction(mean, record.period)
    slow, fast = mean.var("time").sum("servo"), within.mean("time").sum("servo")
    result = (fraction * slow + fast) / (slow + fast)
    return result.assign_attrs(fraction.attrs)


def speed_chatter(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the fraction of the power of the servos' speeds above ten times the frequency of the gait [-].

    The speeds are those at the samples: a trembling with the control period itself is not seen. See ``chatter``.
    """
    return _high_fraction(time_window(record, start, end).servo_velocity, record.period)


def _high_fraction(series: xr.DataArray, period: xr.DataArray) -> xr.DataArray:
    """Return the fraction of the power of samples of all servos above ten times the gait's frequency [-]."""
    step = float(series.time[1] - series.time[0])
    ordered = series.transpose(..., "servo", "time")
    values = np.ascontiguousarray(ordered.values)
    limits = np.broadcast_to(CHATTER_HARMONIC / period.values, values.shape[:-2])
    fractions = np.empty(values.shape[:-2])
    for run in np.ndindex(*fractions.shape):
        fractions[run] = _fraction(values[run], step, float(limits[run]))
    return xr.DataArray(
        fractions,
        dims=ordered.dims[:-2],
        coords={name: series.coords[name] for name in ordered.dims[:-2] if name in series.coords},
        attrs={"units": "1", "long_name": "fraction of the power above ten times the gait's frequency"},
    )


def _fraction(values: Float[np.ndarray, "servo time"], step: float, limit: float) -> float:
    """Return the fraction of the power of equidistant values above a frequency.

    Args:
        values: the values of all servos.
        step: time between two of them [s].
        limit: the frequency [Hz].
    """
    count = values.shape[1]
    lasts_a_cycle = count * step >= CHATTER_HARMONIC / limit
    if not lasts_a_cycle or limit >= 0.5 / step or not np.isfinite(values).all():
        return float("nan")
    deviations = values - values.mean(axis=1, keepdims=True)
    power = (np.abs(np.fft.rfft(deviations * np.hanning(count))) ** 2).sum(axis=0)
    total = float(power.sum())
    if total <= _STILL * count**2:
        return float("nan")
    return float(power[np.fft.rfftfreq(count, step) > limit].sum()) / total


_STILL = 1e-12
"""Power over the square of the number of samples below which nothing moves [rad2/s2, N2 m2]."""

measures = (chatter, speed_chatter)
