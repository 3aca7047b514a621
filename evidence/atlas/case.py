"""A row of the atlas: a flow to compute, published data to compare it with, and the bound, set beforehand."""

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

from suchus.core.errors import UnreadableFile
from suchus.core.progress import Progress

Curves = Mapping[str, np.ndarray]
"""Results of a flow by name: a curve of shape (2, point), abscissa and ordinate, or a number of shape ()."""

UNKNOWN_SCATTER = 0.08
"""Bound of the rms difference over the peak where only one source is known, whose own error is unknown [-]."""

FINEST = 0.02
"""Smallest bound: two sources may agree better than the accuracy to which either was digitised [-]."""


LONG_STEP = 1.0
"""Courant number of the flows that take the most time: the largest that the solver allows, whose own choice is 0.8 [-].

On a moving cylinder at Re 185, on 48 cells, and on a snake at Re 1000 the force changes by 0.05 and 0.07 % of its peak
(rms), and a fifth to a quarter of the steps are saved. An error of the step counts among those of the cells, with which
it goes.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunEffort:
    """Resolution and duration of the computation of a flow."""

    cells: int
    """Cells per diameter, chord or width [-]."""
    until: float
    """Duration of the run, in the units of the case [s]."""
    coarse: int = 0
    """Cells per diameter of the run before, in which the wake forms; 0 where there is none [-]."""
    initial_duration: float = 0.0
    """Duration of that run, in the units of the case [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A flow that is computed once, for one row or for several."""

    name: str
    """Name of the flow, and of the file of its outcome."""
    setup: str
    """Domain, motion and averaging in one or two sentences; ``{cells}`` stands for the cells."""
    run: Callable[[RunEffort, Progress], Curves]
    """Function that computes its curves."""
    grids: tuple[RunEffort, ...]
    """The efforts of a judged run, on the finest cells, which are compared, first; on three grids the run tells its own
    uncertainty too."""
    quick_effort: RunEffort
    """The effort of a quick trial, whose result is drawn and not judged."""
    code: tuple[str, ...]
    """Files of this package that decide its curves, beside the flow solver itself."""

    @property
    def full(self) -> RunEffort:
        """The effort of the run that is compared."""
        return self.grids[0]

    def effort(self, grid: int, *, quick: bool) -> RunEffort:
        """Return the effort of one of its runs; a trial has one grid, 1."""
        return self.quick_effort if quick else self.grids[grid - 1]


def grids(cells: tuple[int, ...], until: float, *, coarse: int = 0, before: float = 0.0) -> tuple[RunEffort, ...]:
    """Return the efforts of a flow on several grids, the finest first, that differ in nothing else."""
    return tuple(RunEffort(cells=each, until=until, coarse=coarse, initial_duration=before) for each in cells)


@dataclass(frozen=True, slots=True, kw_only=True)
class AtlasRow:
    """One published data set beside the same quantity of ours."""

    name: str
    """Name of the row on the command line."""
    title: str
    """Heading: the flow, the quantity and the source."""
    case: str
    """Name of the flow that it is read from."""
    data: str
    """Name of the table of published data."""
    x: str = "x"
    """Column of the abscissa."""
    y: str = "y"
    """Column of the ordinate."""
    kind: Literal["curve", "loop", "numbers"] = "curve"
    """Ordinate over abscissa, a closed curve, or single numbers by their names."""
    computed_curve: str = ""
    """Name of our curve; numbers are found by their own names."""
    labels: tuple[str, str] = ("", "")
    """Abscissa and ordinate with their units."""
    scale: tuple[float, float] = (1.0, 1.0)
    """Factors on the published abscissa and ordinate that give ours [-]."""
    shift: tuple[float, float] = (0.0, 0.0)
    """Offsets that are added to them after that."""
    window: tuple[float, float] = (-np.inf, np.inf)
    """Range of our abscissae that is compared, both ends included."""
    excluded_spacing: tuple[float, float] | None = None
    """Spacing of abscissae, and the half-width around each multiple of it, that are left out."""
    period: float | None = None
    """Period of the abscissa; None for one that has none."""
    other_sources: tuple[tuple[str, str, str, float], ...] = ()
    """Further sources of the same curve: table, its columns, factor on its abscissa, which the row then shifts as
    its own; they give the scatter."""
    any_cycle: bool = False
    """Whether the source shows one instant of a flow that may beat and does not say in which cycle: each cycle of ours
    counts then, curves named ``ours`` with a number behind it, and the nearest is compared."""
    cycle_of: "AtlasRow | None" = None
    """Row of the same source whose nearest cycle is taken, so that this one chooses nothing; None for its own."""
    error_column: str = ""
    """Column of the error that the source states of its ordinate; empty for none."""
    is_printed: bool = False
    """Whether the source prints its numbers, so that their last digit tells its error; else they were read off a
    figure."""
    choice: str = "The source shows one instant and does not say of which cycle"
    """With ``any_cycle``, why one of ours is chosen."""
    skin: bool = False
    """Whether it is read along the skin, where the reading has an error of its own."""
    note: str = ""
    """Note on the page: why data were left out, or the measured cause of a difference."""


def bound(scatter: float | None) -> float:
    """Return the largest rms difference over the peak that counts as agreement, from the sources' own scatter [-].

    Twice the scatter, at least ``FINEST`` and at most ``UNKNOWN_SCATTER``, unless the scatter itself is larger.
    """
    if scatter is None:
        return UNKNOWN_SCATTER
    return max(scatter, min(UNKNOWN_SCATTER, max(FINEST, 2 * scatter)))


_FOLDER = Path(__file__).parent / "data"


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedCurves:
    """A table of numbers and where it comes from."""

    description: tuple[str, ...]
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
        description=tuple(line.removeprefix("# ") for line in lines if line.startswith("#")),
        columns={name: tuple(row[name] for row in rows) for name in rows[0]},
    )
