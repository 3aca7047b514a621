import pytest

from evidence.atlas.command import main


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_trial_of_one_row_leaves_its_outcome_and_a_page(tmp_path, capsys):
    words = ["ghia_u_re100", "--quick", "--jobs", "1"]
    assert main(words) == 0
    out, err = capsys.readouterr()
    assert "None of the 1 rows has been computed in full." in out
    assert "out/atlas/atlas.md" in out
    assert "1 of 1: cavity_re100, done" in err
    kept = tmp_path / "out" / "atlas" / "flows" / "cavity_re100.json"
    before = kept.stat().st_mtime_ns
    assert main(words) == 0
    assert kept.stat().st_mtime_ns == before
    assert "ghia_u_re100: " not in (tmp_path / "out" / "atlas" / "atlas.md").read_text()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["ghia_u_re10"], "there is no row named 'ghia_u_re10'"),
        (["--jobs", "0"], "--jobs is 0; at least 1 flow at a time is needed."),
        (["--jobs", "many"], "'many' is no number"),
        (["--grids", "0", "1"], "--grids is 0 1; give some of 1 to 3."),
        (["--grids", "4"], "--grids is 4; give some of 1 to 3."),
        (["--speed", "3"], "there is no option named '--speed'"),
    ],
)
def test_bad_words_are_refused_in_a_sentence(words, sentence, capsys, tmp_path):
    assert main(words) == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_place_that_takes_nothing_is_refused_before_anything_runs(tmp_path, capsys):
    (tmp_path / "taken").write_text("a file")
    assert main(["ghia_u_re100", "--quick", "--out", "taken/atlas"]) == 2
    assert "taken" in capsys.readouterr().err
