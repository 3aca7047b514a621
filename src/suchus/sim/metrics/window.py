"""A part of a record in time; the mean of several cycles in it, and the first harmonic of that."""

import numpy as np
import xarray as xr

from suchus.core.errors import Diverged, IncompatibleRecord
from suchus.robot.motion import START

_SLACK = 1e-9  # [s]; sample times are multiples of the control period up to rounding


def time_window(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.Dataset:
    """Return the samples from ``start`` to ``end``, both included.

    Args:
        record: record of a run.
        start: [s].
        end: [s]; the last sample if None.

    Raises:
        IncompatibleRecord: fewer than two samples are left.
    """
    end_time = float(record.time[-1])
    window = record.sel(time=slice(start - _SLACK, (end_time if end is None else end) + _SLACK))
    if window.sizes["time"] < 2:
        raise IncompatibleRecord(
            f"the record reaches from {float(record.time[0]):.2f} to {end_time:.2f} s; "
            f"nothing to measure is left between {start} and {end_time if end is None else end} s."
        )
    return window


def require_complete(record: xr.Dataset) -> xr.Dataset:
    """Return a record none of whose runs ended early.

    Args:
        record: record of several runs.

    Raises:
        Diverged: the simulation of a run diverged; the error carries the time and the record of that run so far.
    """
    for i, cause in enumerate(record.cause.values):
        if cause:
            run_record = record.isel(run=i)
            time = float(run_record.ended)
            raise Diverged(
                f"run {i} of {record.sizes['run']}, {run_record.label.item()}, diverged at {time:.2f} s: {cause}. "
                "A shorter timestep may help.",
                time=time,
                record=run_record.sel(time=slice(None, time + _SLACK)),
            )
    return record


def mean_cycle(values: xr.DataArray, start: float, period: float, cycles: int) -> xr.DataArray:
    """Return the mean of whole cycles over the phase, dimension ``phase`` [cycle].

    Args:
        values: values of one run, with the dimension ``time``.
        start: time at which the first cycle begins [s].
        period: period of the cycle [s].
        cycles: number of cycles.

    Raises:
        IncompatibleRecord: the record is too short.
    """
    return each_cycle(values, start, period, cycles).mean("cycle", keep_attrs=True)


def each_cycle(values: xr.DataArray, start: float, period: float, cycles: int) -> xr.DataArray:
    """Return whole cycles along the dimensions ``cycle`` and ``phase`` [cycle]; see ``mean_cycle``.

    Values are interpolated between samples, since a period need not be a whole number of samples.
    """
    time = values.time.values
    if start + cycles * period > time[-1] + 1e-9 or start < time[0] - 1e-9 or cycles < 1:
        raise IncompatibleRecord(
            f"{cycles} cycles of {period:g} s from {start:g} s are needed; the record reaches from {time[0]:g} to "
            f"{time[-1]:g} s: let it run longer."
        )
    count = max(2, round(period / float(time[1] - time[0])))
    phase = np.arange(count) / count
    times = start + period * (np.arange(cycles)[:, None] + phase)
    flat = values.transpose("time", ...)
    other_dims = flat.dims[1:]
    columns = flat.values.reshape(len(time), -1)
    cycle_values = np.stack([np.interp(times, time, column) for column in columns.T], axis=-1)
    return xr.DataArray(
        cycle_values.reshape(cycles, count, *flat.shape[1:]),
        dims=("cycle", "phase", *other_dims),
        coords={"phase": phase, **{dim: flat[dim] for dim in other_dims if dim in flat.coords}},
        attrs=values.attrs,
    )


def first_harmonic(cycle: xr.DataArray) -> xr.DataArray:
    """Return the complex amplitude of the first harmonic of one cycle over ``phase``: ``Re A exp(2 pi i phase)``."""
    turn = np.exp(-2j * np.pi * cycle.phase)
    return 2.0 * (cycle * turn).mean("phase")
