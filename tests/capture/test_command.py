import pytest

from suchus import blueprint
from suchus.capture import film, film_animal, write_table
from suchus.cli import main
from suchus.gaits import GAITS
from suchus.motion import Gait


@pytest.fixture
def table(caiman, crawl, noisy, tmp_path):
    return write_table(film(caiman, crawl, noisy), tmp_path / "tracks.csv")


def test_tracks_become_a_gait_and_a_diagram(table, tmp_path, capsys):
    out = tmp_path / "walks" / "caiman_walk.toml"
    assert main(["capture", str(table), "--out", str(out)]) == 0
    gait = blueprint.read(out, Gait, GAITS)
    assert gait.name == "caiman_walk"
    assert gait.number("trunk_bend") == pytest.approx(GAITS["belly_crawl"].number("trunk_bend"), rel=0.05)
    kinds = ("toml", "svg", "png", "data.csv")
    assert {file.name for file in out.parent.glob("[!.]*")} == {f"caiman_walk.{kind}" for kind in kinds}
    said = capsys.readouterr().out
    assert "standing index" in said
    assert f"suchus run displacement --gait {out}" in said
    assert "heights were not seen" in out.read_text()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ((), "required"),
        (("no.csv",), "there is no file no.csv"),
        (("tracks.csv", "--out", "walk.yaml"), ".toml"),
        (("tracks.csv", "--names", "paw"), "THEIRS=OURS"),
        (("tracks.csv", "--names", "paw=LF"), "no keypoint 'paw'"),
        (("tracks.csv", "--y-axis", "up"), "swapped in both pairs"),
        (("tracks.csv", "--end", "3"), "cycles are needed"),
        (("tracks.csv", "--fsp", "3"), "--fps"),
    ],
)
def test_bad_words_and_tracks_are_one_sentence(table, monkeypatch, capsys, words, told):
    monkeypatch.chdir(table.parent)
    assert main(["capture", *words]) == 2
    said = capsys.readouterr()
    assert told in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""
    assert sorted(file.name for file in table.parent.glob("[!.]*")) == ["tracks.csv"]


def test_lizards_own_names(lizard, clean, tmp_path, monkeypatch):
    file = write_table(film_animal(lizard, clean, cycles=3), tmp_path / "lizard.csv")
    file.write_text(file.read_text().replace("LF_", "left fore paw_"))
    monkeypatch.chdir(tmp_path)
    assert main(["capture", "lizard.csv", "--names", "left fore paw=LF"]) == 0
    assert (tmp_path / "captured.toml").exists()
