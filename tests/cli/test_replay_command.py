import numpy as np
import pytest

import suchus
from suchus.apps.cli import main
from suchus.core import files as record


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """A record of two runs, and one that is no run at all."""
    folder = tmp_path_factory.mktemp("stored")
    robot, gaits = suchus.ROBOTS["caiman"], suchus.GAITS
    runs = [suchus.Run(robot=robot, gait=gaits[name], label=name) for name in ("belly_crawl", "limbs_only")]
    record.save(suchus.simulate(runs, duration=1.2, timestep=0.005), folder / "two.nc")
    record.save(record.load(folder / "two.nc").isel(run=0), folder / "one.nc")
    record.save(record.load(folder / "two.nc")[["mass"]], folder / "other.nc")
    (folder / "text.nc").write_text("text")
    return folder


def test_a_page_stands_beside_the_record(stored, capsys):
    assert main(["replay", str(stored / "one.nc")]) == 0
    assert "one.html" in capsys.readouterr().out
    assert "<canvas" in (stored / "one.html").read_text()


def test_runs_are_chosen_by_label_or_number(stored, tmp_path, capsys):
    out = tmp_path / "page.html"
    assert main(["replay", str(stored / "two.nc"), "--run", "limbs_only", "--ghost", "0", "--out", str(out)]) == 0
    assert "limbs only and belly crawl" in capsys.readouterr().out
    assert out.stat().st_size < 1_000_000


BAD = {
    "none.nc": "no file",
    "text.nc": "NetCDF",
    "two.nc": "0 belly_crawl, 1 limbs_only",
    "two.nc --run gallop": "'gallop'",
    "two.nc --run 2": "'2'",
    "one.nc --run 3": "one run only",
    "one.nc --robot long_tail": "'long_tail'",
    "one.nc --robot longtail": "Did you mean",
    "one.nc --out page.png": "page.png",
    "one.nc --out /dev/null/page.html": "cannot be written",
    "other.nc --run 0": "no record of a run on land",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_words_are_one_sentence_and_leave_nothing(words, stored, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    file, *options = words.split()
    before = sorted(path.name for path in stored.iterdir())
    assert main(["replay", str(stored / file), *options]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert BAD[words] in err
    assert before == sorted(path.name for path in stored.iterdir())
    assert not list(tmp_path.iterdir())


def test_nothing_but_numbers_is_run(stored):
    """A record is data: what it holds are arrays and text."""
    kinds = {variable.dtype.kind for variable in record.load(stored / "two.nc").variables.values()}
    assert kinds <= set("biufU")
    assert np.isfinite(record.load(stored / "two.nc").position.values).all()
