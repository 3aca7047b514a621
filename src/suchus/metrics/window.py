"""A part of a record in time."""

import xarray as xr

from suchus.errors import IncompatibleRecord
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
