import pytest

from suchus.cli import main
from suchus.hardware import STRAIGHT, read_map


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_map_to_start_from_then_the_commands(tmp_path, capsys):
    assert main(["export-commands", "--write-map", "mine.toml"]) == 0
    assert read_map(tmp_path / "mine.toml") == STRAIGHT
    assert main(["export-commands", "limbs_only", "--map", "mine.toml"]) == 0
    folder = tmp_path / "export" / "limbs_only_commands"
    names = {"commands.csv", "trajectory.yaml", "loads.csv", "servo_map.toml", "gait.toml", "suchus_commands.json"}
    assert {p.name for p in folder.iterdir()} == names
    assert "hardest worked" in capsys.readouterr().out


BAD = {
    "trot": "belly_crawl",
    "limbs_only --map none.toml": "there is no file none.toml",
    "limbs_only --cycles 0": "commands.cycles is 0",
    "limbs_only --at-limit 2": "0 to 1 is allowed",
    "limbs_only --out /dev/null/here": "cannot be written",
    "limbs_only --spped 2": "there is --gait",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_words_are_one_sentence_and_leave_nothing(words, tmp_path, capsys):
    assert main(["export-commands", *words.split()]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert BAD[words] in err
    assert not list(tmp_path.iterdir())


def test_a_gait_that_saturates_a_servo_is_refused_unless_it_is_allowed(tmp_path, capsys):
    assert main(["export-commands", "belly_crawl"]) == 2
    err = capsys.readouterr().err
    assert "spine_yaw_1 for" in err
    assert "2 % is allowed" in err
    assert not list(tmp_path.iterdir())
    assert main(["export-commands", "belly_crawl", "--at-limit", "0.4"]) == 0
