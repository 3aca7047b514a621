"""The last seconds of a walk, for plots."""

from collections import deque
from collections.abc import Mapping

import numpy as np
import xarray as xr

from suchus.design import LEGS

WINDOW = 12.0
"""How far back the plots look [s]."""
COLUMNS = ("time", "height", "forward", "aside", *LEGS, "belly", "tail")
"""Time [s], height and way of the centre of mass [m], what feet, belly and tail carry [N]."""


class History:
    """Rows of ``COLUMNS``, the oldest forgotten.

    Args:
        every: between two rows [s].
    """

    def __init__(self, every: float = 0.02) -> None:
        self._every = every
        self._rows: deque[list[float]] = deque(maxlen=round(WINDOW / every) + 1)

    def note(self, time: float, now: Mapping[str, np.ndarray], way: tuple[float, float]) -> None:
        """Keep an instant, if it is time for one.

        Args:
            time: [s].
            now: the instant, by the names of ``record.VARIABLES``.
            way: forward and to the left since the walk began [m].
        """
        if self._rows and time - self._rows[-1][0] < self._every - 1e-9:
            return
        feet = now["foot_force"][:, 2]
        self._rows.append([time, float(now["centre_of_mass"][2]), *way, *map(float, feet),
                           float(now["belly_force"][:, 2].sum()), float(now["tail_force"][2])])  # fmt: skip

    def table(self) -> dict[str, np.ndarray]:
        """Return the columns by name, each of shape (row,)."""
        rows = np.array(self._rows).reshape(len(self._rows), len(COLUMNS))
        return {name: rows[:, i] for i, name in enumerate(COLUMNS)}


def table_of(record: xr.Dataset, origin: np.ndarray) -> dict[str, np.ndarray]:
    """Return the same columns of a whole record of one run.

    Args:
        record: of one run.
        origin: from where the way is counted, (3,) [m].
    """
    com, feet = record.centre_of_mass.values, record.foot_force.sel(xyz="z").values
    way = com - origin
    columns = [record.time.values, com[:, 2], way[:, 0], way[:, 1], *feet.T]
    columns += [record.belly_force.sel(xyz="z").sum("segment").values, record.tail_force.sel(xyz="z").values]
    return dict(zip(COLUMNS, (np.asarray(column, dtype=float) for column in columns), strict=True))
