import numpy as np
import pytest

from suchus.animals.capture import Tracks, film, film_animal, write_table
from suchus.apps.cli import main
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait


@pytest.fixture
def table(caiman, crawl, noisy, tmp_path):
    return write_table(film(caiman, crawl, noisy), tmp_path / "tracks.csv")


def test_tracks_become_a_gait_and_a_diagram(table, tmp_path, capsys):
    out = tmp_path / "walks" / "caiman_walk.toml"
    assert main(["capture", str(table), "--out", str(out)]) == 0
    gait = blueprint.read_design(out, Gait, GAITS)
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


def test_a_body_without_limbs_is_measured_and_no_foot_is_missed(tmp_path, capsys):
    """Keypoints from snout to tail tip, none called hip: no bend of a trunk, no foot, and nothing is drawn of them."""
    time, along = np.arange(0.0, 4.0, 0.02), np.linspace(0.0, 1.0, 200)
    heading = 0.8 * along * np.sin(2 * np.pi * (along - 1.5 * time[:, None]))
    place = 0.3 * np.stack([-np.cos(heading), np.sin(heading)], axis=-1).cumsum(axis=1) / 200
    place[..., 0] += 0.15 * time[:, None]
    names = ("snout", "shoulder", "spine_2", "spine_1", "tail_base", "tail_1", "tail_2", "tail_tip")
    at = place[:, np.linspace(0, 199, len(names)).astype(int)]
    at = at + 5e-4 * np.random.default_rng(3).standard_normal(at.shape)
    eel = Tracks(time=time, points=names, position=at, unit="m", source="an eel")
    write_table(eel, tmp_path / "eel.csv")
    assert main(["capture", str(tmp_path / "eel.csv"), "--tables", str(tmp_path / "eel")]) == 0
    said = capsys.readouterr().out
    assert "no foot is tracked" in said
    assert not any(word in said for word in ("without LF", "stance share", "limb phase"))
    assert "m per cycle" in said.splitlines()[0]
    made = {file.name for file in (tmp_path / "eel").iterdir()}
    assert {"curvature.svg", "strides.svg", "quantity.csv"} <= made
    assert "cycle.svg" not in made
