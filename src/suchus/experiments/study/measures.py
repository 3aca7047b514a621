"""What can be measured of a run: functions from a record to numbers, by name."""

import inspect
from collections.abc import Callable

import numpy as np
import xarray as xr

from suchus.core.catalog import Catalog
from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.robot.design.meaning import unit

Metric = Callable[[xr.Dataset], xr.DataArray]
MEASURES: Catalog[Metric] = Catalog("measure", "suchus.sim.metrics", "collections.abc:Callable", scattered=True)
"""The measures by name: those that the modules of ``suchus.sim.metrics`` declare, and the user's."""


def measured(record: xr.Dataset, names: tuple[str, ...]) -> list[dict[str, float]]:
    """Return the numbers of each run by column: ``slip``, ``displacement_x``, ``peak_torque_LF_yaw``.

    Args:
        record: record of runs that came to their end.
        names: names of ``MEASURES``.

    Raises:
        IncompatibleRecord: the record is too short to be measured.
        InvalidDesign: a measure of the user's is no array with a number for each run.
    """
    rows: list[dict[str, float]] = [{} for _ in range(record.sizes["run"])]
    for name in names:
        array = _of_each_run(name, MEASURES[name](record))
        dims = [str(d) for d in array.dims[1:]]
        for index in np.ndindex(*array.shape[1:]):
            labels = [str(array[dim].values[i]) for dim, i in zip(dims, index, strict=True)]
            column = "_".join([name, *labels])
            for row, values in zip(rows, array.values, strict=True):
                row[column] = float(values[index])
    return rows


def _of_each_run(name: str, array: object) -> xr.DataArray:
    """Return a measured array with the runs as its first dimension."""
    if not isinstance(array, xr.DataArray) or "run" not in array.dims or "time" in array.dims:
        shape_text = (
            f"the dimensions {', '.join(map(str, array.dims))}" if isinstance(array, xr.DataArray) else show(array)
        )
        raise InvalidDesign(
            f"the measure {name} returns {shape_text}; an xarray.DataArray with the dimension run and without time is "
            "needed."
        )
    return array.transpose("run", ...)


def unit_of(name: str) -> str:
    """Return the unit of a measure, from its docstring."""
    return unit((inspect.getdoc(MEASURES[name]) or "").partition("\n")[0])
