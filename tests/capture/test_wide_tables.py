"""A table of a hundred thousand columns is refused at once: its headings are not compared with each other."""

import pytest

from suchus.animals.capture import table
from suchus.core.errors import UnreadableFile


def test_a_wide_table_is_refused_before_its_headings_are_read(tmp_path, monkeypatch):
    count = 50_000
    header = ",".join(["time [s]", *(f"k{i}_x [px],k{i}_y [px]" for i in range(count))])
    file = tmp_path / "wide.csv"
    file.write_text(f"{header}\n{','.join(['1'] * (2 * count + 1))}\n")
    monkeypatch.setattr(table, "_columns", lambda *_: pytest.fail("the headings were read"))
    with pytest.raises(UnreadableFile, match="has 100001 columns; at most 5000 are read"):
        table.read_table(file, names={}, confidence=0.5, y_down=None)
