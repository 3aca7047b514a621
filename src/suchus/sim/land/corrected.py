"""Factors on what the pieces of a robot feel in its water, written into its model."""

from typing import Any

import numpy as np

from suchus.core.water_table import HEADER, WIDTH, column, pack_table, unpack_table
from suchus.robot.design.correction import SectionCorrection

_ADDED_MASS_COLUMNS, _DRAG_COLUMNS = ("added", "shed"), ("area", "roll", "skin", "end")
"""Columns of the table of pieces that each factor is on."""


def correct(model: Any, correction: SectionCorrection) -> None:
    """Multiply added mass and drag of the pieces of each corrected body, in a model that is the caller's own.

    Args:
        model: an ``MjModel`` that carries a table of pieces; bodies that it lacks, as limbs left out, are passed over.
        correction: the factors.
    """
    numbers = model.numeric_data
    table = unpack_table(numbers)
    for name, factors in correction.factors.items():
        ids = [body for body in range(model.nbody) if model.body(body).name == name]
        is_corrected = np.isin(table[:, 0].astype(int), ids)
        for columns, factor in ((_ADDED_MASS_COLUMNS, factors.added), (_DRAG_COLUMNS, factors.drag)):
            for column_name in columns:
                column(table, column_name)[is_corrected] *= factor
    numbers[:] = pack_table(table, float(numbers[2]), (len(numbers) - HEADER) // WIDTH)
