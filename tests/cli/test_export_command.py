import sys

import pytest

from suchus.apps.cli import main
from suchus.sim.model.export import MARK


def test_export_writes_a_folder_named_after_robot_and_format(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["export", "--format", "urdf"]) == 0
    assert "export/caiman_urdf" in capsys.readouterr().out
    assert (tmp_path / "export" / "caiman_urdf" / MARK).is_file()


def test_usd_without_its_library_is_one_sentence(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "pxr", None)
    assert main(["export", "--format", "usd"]) == 2
    assert capsys.readouterr().err == "suchus: USD needs usd-core; install it with: pip install 'suchus[usd]'.\n"
    assert list(tmp_path.iterdir()) == []


BAD = {
    "--format udrf": "Did you mean 'urdf'?",
    "--format=usdz": "Did you mean 'usd'?",
    "--format": "missing value",
    "--robot kaiman": "Did you mean 'caiman'?",
    "--out /dev/null/here": "cannot be written",
    "--out .": "nothing says that suchus wrote it",
    "--formt urdf": "Did you mean '--format'?",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_words_are_one_sentence_and_leave_nothing(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.txt").write_text("mine")
    assert main(["export", *words.split()]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert BAD[words] in err
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]
