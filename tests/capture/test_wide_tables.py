"""A table of a hundred thousand columns is refused at once."""

import time

import pytest

from suchus.animals.capture.table import read_table
from suchus.core.errors import UnreadableFile


def test_a_wide_table_is_refused_within_a_second(tmp_path):
    count = 50_000
    header = ",".join(["time [s]", *(f"k{i}_x [px],k{i}_y [px]" for i in range(count))])
    file = tmp_path / "wide.csv"
    file.write_text(f"{header}\n{','.join(['1'] * (2 * count + 1))}\n")
    begin = time.process_time()
    with pytest.raises(UnreadableFile, match="has 100001 columns; at most 5000 are read"):
        read_table(file, names={}, confidence=0.5, y_down=None)
    assert time.process_time() - begin < 1.0
