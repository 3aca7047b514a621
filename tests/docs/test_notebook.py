"""The notebook runs from top to bottom, and is kept without outputs."""

import json
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt

NOTEBOOK = Path(__file__).parents[2] / "examples" / "first_walk.ipynb"


def cells():
    return json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]


def test_it_is_kept_without_outputs():
    for cell in cells():
        assert cell["cell_type"] == "markdown" or (cell["outputs"] == [] and cell["execution_count"] is None)
    assert len({cell["id"] for cell in cells()}) == len(cells())


def test_its_cells_run_in_their_order(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    session = {"__name__": "__main__"}
    with mpl.rc_context({"backend": "agg"}):
        for cell in cells():
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), cell["id"], "exec"), session)
        plt.close("all")
    said = capsys.readouterr().out
    assert "m forward in one cycle" in said
    assert "turned by" in said
    assert (tmp_path / "first_walk.html").stat().st_size > 100_000
