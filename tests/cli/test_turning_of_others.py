"""A body whose limbs cannot follow what ``turning`` tries refuses in a sentence; it is no failed experiment."""

import shutil
from pathlib import Path

from suchus.apps.cli import main

FILES = Path(__file__).parent.parent / "data" / "imports"


def test_strokes_that_a_limb_cannot_follow_are_refused(tmp_path, monkeypatch, capsys):
    shutil.copy(FILES / "walker.urdf", tmp_path)
    monkeypatch.chdir(tmp_path)
    words = "--quick --bends 0.0 0.2 --asymmetries 0.0 0.5 --mixtures 0.0 1.0 --asked 1.0 --cycles 1 --out out"
    assert main(["run", "turning", "--robot", "walker.urdf", *words.split()]) == 2
    told = capsys.readouterr().err
    assert "robot 'walker' cannot walk gait" in told
    assert "with strokes of asymmetry 0.5" in told
    assert told.rstrip().endswith("give smaller --asymmetries.")
    assert [path.name for path in tmp_path.iterdir()] == ["walker.urdf"]
