from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.hardware import read_map, straight
from suchus.robot.robots import ROBOTS


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_a_map_to_start_from_then_the_commands(tmp_path, capsys):
    assert main(["export-commands", "--write-map", "mine.toml"]) == 0
    assert read_map(tmp_path / "mine.toml", ROBOTS["caiman"]) == straight(ROBOTS["caiman"])
    assert main(["export-commands", "limbs_only", "--map", "mine.toml"]) == 0
    folder = tmp_path / "export" / "limbs_only_commands"
    names = {"commands.csv", "trajectory.yaml", "loads.csv", "servo_map.toml", "gait.toml", "suchus_commands.json"}
    assert {p.name for p in folder.glob("[!.]*")} == names
    assert "highest-loaded" in capsys.readouterr().out


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


FORMER = Path(__file__).parents[2] / "examples" / "former_caiman.toml"


def test_the_default_gait_is_exported_and_its_servos_lack_nothing(tmp_path, capsys):
    assert main(["export-commands"]) == 0
    assert "warning" not in capsys.readouterr().out
    assert (tmp_path / "export" / "belly_crawl_commands" / "commands.csv").exists()


def test_weaker_servos_are_exported_for_and_what_they_lack_is_said(tmp_path, capsys):
    assert main(["export-commands", "--robot", str(FORMER)]) == 0
    out = capsys.readouterr().out
    assert "warning: spine_yaw_1 is at its torque limit of 2.5 N m for 2" in out
    assert "STS3250 (4.9 N m) would do." in out
    table = (tmp_path / "export" / "belly_crawl_commands" / "loads.csv").read_text()
    assert "spine_yaw_1,2.5000,2.5,0.2" in table
    assert (tmp_path / "export" / "belly_crawl_commands" / "commands.csv").exists()


def test_a_gait_that_no_servo_follows_is_refused_and_the_loads_are_written_all_the_same(tmp_path, capsys):
    assert main(["export-commands", "belly_crawl", "--robot", str(FORMER), "--tracking", "0.1"]) == 2
    err = capsys.readouterr().err
    assert "spine_yaw_1 is at its torque limit" in err
    assert err.count("\n") == 1
    folder = tmp_path / "export" / "belly_crawl_commands"
    assert {file.name for file in folder.glob("[!.]*")} == {"loads.csv", "suchus_commands.json"}
