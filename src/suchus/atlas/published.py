"""The published data: small CSV files beside this module, whose first lines say where each comes from."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from suchus.errors import UnreadableFile

_FOLDER = Path(__file__).parent / "data"


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedCurves:
    """A table of numbers and where it comes from."""

    about: tuple[str, ...]
    """What it is, where it was published, how it was digitised: the lines at the head of the file."""
    columns: Mapping[str, tuple[str, ...]]
    """The texts of each column by its name, all of one length."""

    def values(self, column: str) -> np.ndarray:
        """Return a column as numbers, NaN where it is empty, shape (row,)."""
        return np.array([float(text) if text else np.nan for text in self.columns[column]])


@cache
def published(name: str) -> PublishedCurves:
    """Return one of the tables of this package by the name of its file without the ending.

    Raises:
        UnreadableFile: there is no such table.
    """
    path = _FOLDER / f"{name}.csv"
    if not path.is_file():
        raise UnreadableFile(f"the atlas has no data named {name!r}; its tables are the files of {_FOLDER}.")
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return PublishedCurves(
        about=tuple(line.removeprefix("# ") for line in lines if line.startswith("#")),
        columns={name: tuple(row[name] for row in rows) for name in rows[0]},
    )
