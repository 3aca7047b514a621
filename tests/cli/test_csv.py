"""Records as CSV, from the command line."""

import pytest

from suchus.apps.cli import main

STUDY = """name = "small"
robot = "caiman"
gait = "belly_crawl"
duration = 1.3
measure = ["displacement"]

[[vary]]
field = "gait.stroke"
values = [0.02, 0.03]
"""


@pytest.mark.usefixtures("fakes")
def test_a_record_is_written_as_csv_beside_itself_where_that_is_asked_for(tmp_path, capsys):
    assert main(["run", "wave", "--quick", "--csv", "--out", str(tmp_path)]) == 0
    folder = tmp_path / "wave" / "csv"
    assert (folder / "time.csv").read_text().startswith("time,height [m]\n0.0,0.0\n")
    assert str(folder) in capsys.readouterr().out
    assert main(["run", "wave", "--quick", "--out", str(tmp_path)]) == 0
    assert not folder.exists()


def test_results_of_a_study_are_written_with_their_units(tmp_path, capsys):
    (tmp_path / "small.toml").write_text(STUDY)
    words = ["study", str(tmp_path / "small.toml"), "--out", str(tmp_path / "store")]
    for _ in range(2):  # the second finds everything done
        assert main([*words, "--csv"]) == 0
    header, *rows = (tmp_path / "store" / "csv" / "sample.csv").read_text().splitlines()
    assert "displacement_x [m]" in header
    assert len(rows) == 2
    assert "with units" in capsys.readouterr().out
