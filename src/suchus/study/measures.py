"""What can be measured: the functions of ``suchus.metrics`` that turn a record and a window into numbers."""

import inspect
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
import xarray as xr

from suchus import metrics
from suchus.design.meaning import unit

Metric = Callable[[xr.Dataset], xr.DataArray]


def _is_measure(function: object) -> bool:
    """Whether it needs a record alone, takes a start and an end, and returns an array."""
    if not inspect.isfunction(function):
        return False
    signature = inspect.signature(function)
    needed = [p.name for p in signature.parameters.values() if p.default is p.empty]
    return needed == ["record"] and {"start", "end"} <= set(signature.parameters) and _arrays(function)


def _arrays(function: Callable[..., object]) -> bool:
    return inspect.signature(function).return_annotation in (xr.DataArray, "xr.DataArray")


MEASURES: Mapping[str, Metric] = MappingProxyType(
    {name: getattr(metrics, name) for name in sorted(metrics.__all__) if _is_measure(getattr(metrics, name))}
)
"""By name."""


def measured(record: xr.Dataset, names: tuple[str, ...]) -> list[dict[str, float]]:
    """Return the numbers of each run by column: ``slip``, ``displacement_x``, ``peak_torque_LF_yaw``.

    Args:
        record: of runs that came to their end.
        names: of ``MEASURES``.

    Raises:
        IncompatibleRecord: the record is too short to be measured.
    """
    rows: list[dict[str, float]] = [{} for _ in range(record.sizes["run"])]
    for name in names:
        array = MEASURES[name](record).transpose("run", ...)
        dims = [str(d) for d in array.dims[1:]]
        for index in np.ndindex(*array.shape[1:]):
            labels = [str(array[dim].values[i]) for dim, i in zip(dims, index, strict=True)]
            column = "_".join([name, *labels])
            for row, values in zip(rows, array.values, strict=True):
                row[column] = float(values[index])
    return rows


def unit_of(name: str) -> str:
    """Return the unit of a measure, from its docstring."""
    return unit((inspect.getdoc(MEASURES[name]) or "").partition("\n")[0])
