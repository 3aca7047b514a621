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


def measured(record: xr.Dataset, names: tuple[str, ...]) -> dict[str, float]:
    """Return the numbers of one run by column: ``slip``, ``displacement_x``, ``peak_torque_LF_yaw``.

    Args:
        record: of one run.
        names: of ``MEASURES``.

    Raises:
        IncompatibleRecord: the record is too short to be measured.
    """
    columns: dict[str, float] = {}
    for name in names:
        array = MEASURES[name](record)
        dims = [str(d) for d in array.dims]
        for index in np.ndindex(*array.shape):
            labels = [str(array[dim].values[i]) for dim, i in zip(dims, index, strict=True)]
            columns["_".join([name, *labels])] = float(array.values[index])
    return columns


def unit_of(name: str) -> str:
    """Return the unit of a measure, from its docstring."""
    return unit((inspect.getdoc(MEASURES[name]) or "").partition("\n")[0])
