"""The last seconds of a walk, for plots."""

from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

WINDOW = 12.0
"""Length of time that the plots show [s]."""


def columns(limbs: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the columns: time [s], height and displacement of the centre of mass [m], then loads [N].

    Args:
        limbs: names of the limbs; the loads are those of their feet, of the belly and of the tail.
    """
    return ("time", "height", "forward", "aside", *limbs, "belly", "tail")


class History:
    """Rows of ``columns``, the oldest forgotten.

    Args:
        limbs: names of the limbs.
        interval: between two rows [s].
    """

    def __init__(self, limbs: Sequence[str], interval: float = 0.02) -> None:
        self._interval, self._columns = interval, columns(limbs)
        self._rows: deque[list[float]] = deque(maxlen=round(WINDOW / interval) + 1)

    def note(self, time: float, state: Mapping[str, np.ndarray], displacement: tuple[float, float]) -> None:
        """Store a row, if the interval since the last row has passed.

        Args:
            time: [s].
            state: the instant, by the names of ``record.VARIABLES``.
            displacement: forward and to the left since the walk began [m].
        """
        if self._rows and time - self._rows[-1][0] < self._interval - 1e-9:
            return
        feet = state["foot_force"][:, 2]
        self._rows.append([time, float(state["centre_of_mass"][2]), *displacement, *map(float, feet),
                           float(state["belly_force"][:, 2].sum()), float(state["tail_force"][2])])  # fmt: skip

    def table(self) -> dict[str, np.ndarray]:
        """Return the columns by name, each of shape (row,)."""
        rows = np.array(self._rows).reshape(len(self._rows), len(self._columns))
        return {name: rows[:, i] for i, name in enumerate(self._columns)}


def table_of(record: xr.Dataset, origin: np.ndarray) -> dict[str, np.ndarray]:
    """Return the same columns of a whole record of one run.

    Args:
        record: record of one run.
        origin: from where the displacement is counted, (3,) [m].
    """
    com, feet = record.centre_of_mass.values, record.foot_force.sel(xyz="z").values
    displacement = com - origin
    values = [record.time.values, com[:, 2], displacement[:, 0], displacement[:, 1], *feet.T]
    values += [record.belly_force.sel(xyz="z").sum("segment").values, record.tail_force.sel(xyz="z").values]
    names = columns([str(limb) for limb in record.leg.values])
    return dict(zip(names, (np.asarray(column, dtype=float) for column in values), strict=True))
