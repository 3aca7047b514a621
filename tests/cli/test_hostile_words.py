"""Surroundings and words that broke commands: each is one sentence now, or does not matter."""

import os
import subprocess
import sys

import pytest

from suchus.apps.cli import main

BIG = "1" * 5000
BAD = {
    "pipe as a robot": ["run", "displacement", "--robot", "PIPE"],
    "device as a study": ["study", "/dev/zero"],
    "folder as a record": ["replay", "."],
    "root as a record": ["replay", "/"],
    "null byte": ["study", "a\0b.toml"],
    "null byte in a place": ["run", "displacement", "--out", "a\0b"],
    "long name": ["optimise", "n" * 300],
    "large number": ["run", "displacement", "--seed", BIG],
    "large optional number": ["reproduce", "--jobs", BIG],
    "large port": ["view", "--port", "9" * 400],
    "host that is none": ["view", "--host", "a..b", "--port", "0"],
    "number of a run": ["replay", "PIPE", "--run", BIG],
    "long word": ["list", "x" * 5000],
    "long command": ["x" * 5000],
    "not a number": ["export", "--timestep", "nan"],
    "gait without a name": ["export-commands", "--gait"],
    "option that is none": ["export-commands", "--nope"],
    "terminal's own letters": ["run", "\x1b[31m\nred"],
    "no letters at all": ["run", "\ud800"],
}


@pytest.mark.parametrize("case", BAD)
def test_hostile_words_are_one_short_sentence(case, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    os.mkfifo(tmp_path / "PIPE")
    assert main(BAD[case]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert len(err) < 3500
    assert err.strip().isprintable()
    assert not any(word in err for word in ("int()", "literal", "object", "Traceback", "set_int_max"))
    assert [p.name for p in tmp_path.iterdir()] == ["PIPE"]


def run(words, **settings):
    command = [sys.executable, "-m", "suchus", *words]
    environment = {**os.environ, **settings.pop("env", {})}
    return subprocess.run(
        command, stderr=subprocess.PIPE, text=True, timeout=600, env=environment, check=False, **settings
    )


def test_surroundings_that_broke_commands():
    with open("/dev/full", "w") as full:  # noqa: PTH123
        done = run(["list"], stdout=full)
    assert (done.returncode, done.stderr) == (2, "suchus: what was to be printed is lost: no space left on device.\n")
    done = run(["list"], stdout=subprocess.DEVNULL, preexec_fn=lambda: os.close(1))
    assert (done.returncode, done.stderr) == (0, "")
    odd = {"PYTHONIOENCODING": "ascii", "LC_ALL": "C", "COLUMNS": "3", "MPLBACKEND": "bogus"}
    done = run(["export", "--help"], stdout=subprocess.PIPE, env=odd)
    assert (done.returncode, done.stderr) == (0, "")
    assert "--format" in done.stdout


def test_a_gait_is_named_as_an_option_too(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for words in (["--gait", "trot"], ["--gait=trot"], ["trot"], ["--cycles", "1", "--gait", "trot"]):
        assert main(["export-commands", *words]) == 2
        assert "there is no gait named 'trot'" in capsys.readouterr().err
