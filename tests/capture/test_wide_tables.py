"""A table of a hundred thousand columns is refused at once: its headings are not compared with each other."""

import pytest

from suchus.animals.capture import markers, table
from suchus.core.errors import UnreadableFile


def test_a_wide_table_is_refused_before_its_headings_are_read(tmp_path, monkeypatch):
    count = 50_000
    header = ",".join(["time [s]", *(f"k{i}_x [px],k{i}_y [px]" for i in range(count))])
    file = tmp_path / "wide.csv"
    file.write_text(f"{header}\n{','.join(['1'] * (2 * count + 1))}\n")
    monkeypatch.setattr(table, "_columns", lambda *_: pytest.fail("the headings were read"))
    with pytest.raises(UnreadableFile, match="has 100001 columns; at most 5000 are read"):
        table.read_table(file, names={}, confidence=0.5, y_down=None)


def test_so_are_marker_files(tmp_path, monkeypatch):
    count = 33_333
    names = "\t\t\t".join(f"m{i}" for i in range(count))
    lines = [
        "PathFileType\t4\t(X/Y/Z)\twide.trc",
        "DataRate\tUnits",
        "100\tmm",
        f"Frame#\tTime\t{names}",
        "\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(count)),
        "1\t0\t" + "\t".join(["1"] * (3 * count)),
    ]
    file = tmp_path / "wide.trc"
    file.write_text("\n".join(lines) + "\n")
    monkeypatch.setattr(markers, "map_keypoint_names", lambda *_: pytest.fail("names were compared"))
    with pytest.raises(UnreadableFile, match=r"wide\.trc has 100001 columns; at most 5000 are read"):
        markers.read_markers(file, names={})
