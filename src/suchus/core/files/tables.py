"""A record as tidy CSV files, for people and spreadsheets: one file for each set of dimensions."""

import csv
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.writing import new_folder

COLUMNS = "columns.csv"
"""Lists every column of every file with its unit and meaning; by it a folder of tables is known."""
_SINGLE = "single"  # values without any dimension
_ROWS = 65536  # that are turned into text at a time


def write_tables(record: xr.Dataset, folder: str | Path) -> Path:
    """Write a record as CSV files into a folder, which appears whole or not at all, and return its path.

    A file is named after its dimensions, as ``run_time_leg.csv``. It has a column for each of them and one for each
    variable along just these, with units in the header, and a row for each combination. Numbers read back to the same
    bits; what is not a number is left empty.

    Args:
        record: any; labels along a dimension that are not its own are columns too.
        folder: an older one is replaced where suchus wrote it and nobody changed it.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    folder = Path(folder)
    column_rows: list[tuple[str, str, str, str]] = []
    with new_folder(folder) as draft:
        for dims, names in _sets(record).items():
            file = "_".join(dim.replace("/", "-") for dim in dims) or _SINGLE
            _write(
                draft / f"{file}.csv", [_headed(record, name) for name in (*dims, *names)], _rows(record, dims, names)
            )
            column_rows += [
                (f"{file}.csv", _headed(record, name), *_unit_and_name(record, name)) for name in (*dims, *names)
            ]
        _write(draft / COLUMNS, ["file", "column", "unit", "meaning"], iter(column_rows))
    return folder


def _sets(record: xr.Dataset) -> dict[tuple[str, ...], list[str]]:
    """Return the variables by their dimensions, whose order is that of the first variable that has them."""
    orders: dict[frozenset[str], tuple[str, ...]] = {}
    sets: dict[tuple[str, ...], list[str]] = {}
    for name, variable in record.variables.items():
        if name in record.dims:
            continue
        dims = tuple(str(dim) for dim in variable.dims)
        sets.setdefault(orders.setdefault(frozenset(dims), dims), []).append(str(name))
    return sets


def _rows(record: xr.Dataset, dims: Sequence[str], names: Sequence[str]) -> Iterator[tuple[Any, ...]]:
    """Yield a row for each combination of labels: the labels, then the value of each variable."""
    labels = product(*(record[dim].values.tolist() for dim in dims))
    values = [record[name].variable.transpose(*dims).values.reshape(-1) for name in names]
    for start in range(0, len(values[0]), _ROWS):
        rows = zip(*(_plain(column[start : start + _ROWS]) for column in values), strict=True)
        for row in rows:
            yield (*next(labels), *row)


def _plain(column: np.ndarray) -> list[Any]:
    return [None if value != value else value for value in column.tolist()]  # only what is not a number differs


def _headed(record: xr.Dataset, name: str) -> str:
    unit = _unit_and_name(record, name)[0]
    return f"{name} [{unit}]" if unit and unit != "1" else name


def _unit_and_name(record: xr.Dataset, name: str) -> tuple[str, str]:
    attributes = record[name].attrs if name in record.variables else {}
    return str(attributes.get("units", "")), str(attributes.get("long_name", ""))


def _write(file: Path, header: Sequence[str], rows: Iterator[tuple[Any, ...]]) -> None:
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
