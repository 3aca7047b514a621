"""A part of a record in time."""

import xarray as xr

from suchus.errors import Diverged, IncompatibleRecord
from suchus.motion import START

_SLACK = 1e-9  # [s]; sample times are multiples of the control period up to rounding


def between(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.Dataset:
    """Return the samples from ``start`` to ``end``, both included.

    Args:
        record: of a run.
        start: [s].
        end: [s]; the last sample if None.

    Raises:
        IncompatibleRecord: fewer than two samples are left.
    """
    last = float(record.time[-1])
    part = record.sel(time=slice(start - _SLACK, (last if end is None else end) + _SLACK))
    if part.sizes["time"] < 2:
        raise IncompatibleRecord(
            f"the record reaches from {float(record.time[0]):.2f} to {last:.2f} s; "
            f"nothing to measure is left between {start} and {last if end is None else end} s."
        )
    return part


def whole(record: xr.Dataset) -> xr.Dataset:
    """Return a record none of whose runs ended early.

    Args:
        record: of several runs.

    Raises:
        Diverged: the simulation of a run diverged; the error carries the time and the record of that run so far.
    """
    for i, cause in enumerate(record.cause.values):
        if cause:
            one = record.isel(run=i)
            time = float(one.ended)
            raise Diverged(
                f"run {i} of {record.sizes['run']}, {one.label.item()}, diverged at {time:.2f} s: {cause}. "
                "A shorter timestep may help.",
                time=time,
                record=one.sel(time=slice(None, time + _SLACK)),
            )
    return record
