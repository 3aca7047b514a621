"""Water for any MuJoCo model has the exact and the published answers, and the data and the page say so."""

from pathlib import Path

import pytest

from evidence.water.__main__ import DATA, END, PAGE, START, read_data, tables, write_data
from evidence.water.cases import CASES


@pytest.mark.parametrize("group", CASES)
def test_each_case_has_its_answer_and_stands_in_the_data(group):
    checks = CASES[group]()
    assert [check for check in checks if not check.holds] == []
    kept = [row for row in read_data() if row["group"] == group]
    assert [(row["case"], row["quantity"]) for row in kept] == [(check.case, check.quantity) for check in checks]
    for row, check in zip(kept, checks, strict=True):
        assert float(row["reference"]) == pytest.approx(check.reference, rel=1e-6, abs=1e-12)
        assert abs(float(row["computed"]) - check.reference) <= float(row["tolerance"])


def test_the_page_has_the_tables_of_the_data():
    page = PAGE.read_text(encoding="utf-8")
    assert page.partition(START)[2].partition(END)[0].strip() == tables(read_data())


def test_data_are_written_as_they_are_read(tmp_path: Path):
    checks = CASES["drafts"]()
    write_data({"drafts": checks}, tmp_path / "checks.csv")
    rows = read_data(tmp_path / "checks.csv")
    assert rows == [row for row in read_data(DATA) if row["group"] == "drafts"] or len(rows) == len(checks)
    assert [row["unit"] for row in rows] == ["m"] * len(checks)
