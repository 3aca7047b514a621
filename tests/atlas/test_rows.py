"""The rows as they stand: each has its flow, its data and its source."""

import re

import numpy as np
import pytest

from evidence.atlas import CASES, GROUPS, LONGEST, ROWS, chosen, published
from suchus.core.errors import UnknownName, UnreadableFile


def test_there_are_at_least_as_many_rows_as_were_asked_for():
    assert len(ROWS) >= 48


def test_every_flow_is_read_and_every_row_has_one():
    assert {row.case for row in ROWS.values()} == set(CASES)
    assert sum(len(rows) for rows in GROUPS.values()) == len(ROWS)
    assert set(LONGEST) <= set(CASES)


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_the_data_of_a_row_are_numbers_with_a_source(row):
    table = published(row.data)
    about = " ".join(table.description)
    assert re.search(r"(19|20)\d\d, .*(J\.|Comput\.|Phys\.|Notes)", about), "a source has a year and a journal"
    if row.kind == "numbers":
        columns = [name for name in table.columns if name != "quantity"]
        values = np.stack([table.values(name) for name in columns])
        assert np.isfinite(values).any(axis=0).all()
        return
    x, y = table.values(row.x), table.values(row.y)
    assert x.size >= 10
    assert np.isfinite(x).all()
    assert np.isfinite(y).all()
    assert row.computed_curve
    assert all(row.labels)
    for name, abscissa, ordinate, _ in row.other_sources:
        other = published(name)
        assert other.values(abscissa).size == other.values(ordinate).size


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_a_flow_says_how_it_is_set_up_and_a_trial_is_smaller(case):
    assert case.setup.format(cells=1, coarse=2)
    assert "{cells}" in case.setup
    assert ("{coarse}" in case.setup) == bool(case.full.coarse)
    assert case.quick_effort.cells < case.full.cells
    assert case.quick_effort.until <= case.full.until


def test_rows_are_chosen_by_their_names():
    assert chosen(()) == tuple(ROWS.values())
    assert [row.name for row in chosen(("duetsch_force", "dfg_2d1", "duetsch_force"))] == ["duetsch_force", "dfg_2d1"]
    with pytest.raises(UnknownName, match="Did you mean 'duetsch_force'"):
        chosen(("dutsch_force",))


def test_a_table_that_is_not_there_is_named():
    with pytest.raises(UnreadableFile, match="no data named 'atlantis'"):
        published("atlantis")
