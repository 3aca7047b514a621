"""Factors and form on what the pieces of a robot feel in its water, written into its model."""

from typing import Any, NamedTuple

import numpy as np

from suchus.core.water_table import HEADER, WIDTH, column, pack_table, unpack_table
from suchus.robot.design.correction import SectionCorrection
from suchus.robot.design.form import BodyForm, formed

_ADDED_MASS_COLUMNS, _DRAG_COLUMNS = ("added", "shed"), ("area", "roll", "skin", "end")
"""Columns of the table of pieces that each factor is on."""


class SectionChange(NamedTuple):
    """What a lake changes of the table of pieces."""

    form: BodyForm | None
    """Form of the body; None where the table has its own."""
    correction: SectionCorrection | None
    """Factors on the pieces with their form; None for none."""


def change_sections(model: Any, change: SectionChange) -> None:
    """Write a form, then the factors of a correction, into a model that is the caller's own.

    Args:
        model: an ``MjModel`` that carries a table of pieces; bodies that it lacks, as limbs left out, are passed over.
        change: form and factors.
    """
    numbers = model.numeric_data
    table = unpack_table(numbers)
    if change.form is not None:
        table = formed(table, change.form)
    factors_by_body = {} if change.correction is None else change.correction.factors
    for name, factors in factors_by_body.items():
        ids = [body for body in range(model.nbody) if model.body(body).name == name]
        is_corrected = np.isin(table[:, 0].astype(int), ids)
        for columns, factor in ((_ADDED_MASS_COLUMNS, factors.added), (_DRAG_COLUMNS, factors.drag)):
            for column_name in columns:
                column(table, column_name)[is_corrected] *= factor
    numbers[:] = pack_table(table, float(numbers[2]), (len(numbers) - HEADER) // WIDTH)
