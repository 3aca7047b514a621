import socket
import sys

import pytest

from suchus.apps.cli import main


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nobody"], "no robot named 'nobody'"),
        (["caiman", "trot"], "no gait named 'trot'"),
        (["caiman", "belly_crawl", "more"], "one word too many"),
        (["--timestep", "0.003"], "must divide the control period"),
        (["--port", "99999"], "suchus: view.port is 99999; 0 to 65535 is allowed"),
        (["none.nc"], "there is no file none.nc"),
        (["swim", "none.nc"], "there is no file none.nc"),
        (["--hots", "here"], "no option named '--hots'"),
    ],
)
def test_bad_words_are_told_in_a_sentence(words, said, capsys):
    assert main(["view", *words]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1


def test_a_file_that_is_no_record_is_told_in_a_sentence(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("not a record")
    assert main(["view", str(tmp_path / "notes.txt")]) == 2
    assert "is not a NetCDF file" in capsys.readouterr().err


def test_without_the_extra_the_remedy_is_told(monkeypatch, capsys):
    for name in [name for name in sys.modules if name.startswith("suchus.apps.viewer.")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delattr("suchus.apps.viewer.pages", raising=False)
    monkeypatch.setitem(sys.modules, "viser", None)
    assert main(["view"]) == 2
    assert "pip install 'suchus[viewer]'" in capsys.readouterr().err


def test_a_taken_port_is_told_in_a_sentence(capsys):
    pytest.importorskip("viser", reason="the extra viewer is not installed")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert main(["view", "--port", str(taken.getsockname()[1])]) == 2
    assert "take another --port" in capsys.readouterr().err


def test_help_needs_nothing(capsys):
    assert main(["view", "--help"]) == 0
    assert "suchus view swim RECORD.nc" in capsys.readouterr().out
