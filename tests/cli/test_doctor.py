"""`suchus doctor`: what it finds, on both sides of every judgement."""

import json
import subprocess
import sys
from types import SimpleNamespace

import pytest

from suchus.apps.cli import doctor, main
from suchus.apps.cli.doctor import Finding, Trial

REQUIRES = ("numpy>=2.2,<3", "mujoco>=3.17,<5", 'viser>=1.1,<2; extra == "viewer"', 'mjviser; extra == "viewer"')
WALKED = Trial(output={"seconds": 0.4, "finite": True})
COMPILED = {"layer": "omp", "folder": "/cache/kernels-1", "compiled": 62, "missing": []}


def at(**versions):
    return versions.get


@pytest.fixture
def well(monkeypatch):
    """A machine on which all trials succeed."""
    trials = {"walk": WALKED, "swim": Trial(output=COMPILED), "draw": Trial(output=None, failure="no EGL")}
    monkeypatch.setattr(doctor, "run_trials", lambda *names: [trials[name] for name in names])
    monkeypatch.setattr(doctor, "packages", lambda: Finding(heading="packages", lines=("numpy 2.4.6",)))
    return trials


def test_a_machine_that_is_well_has_its_page_and_exit_code_0(well, capsys):
    assert main(["doctor"]) == 0
    out = capsys.readouterr().out
    for heading in ("packages", "threads", "walking", "swimming", "results", "OpenGL", "browser", "extras"):
        assert f"\n{heading}" in out
    assert out.endswith("suchus can run here.\n")
    assert len(out.splitlines()) < 40
    assert max(map(len, out.splitlines())) <= 110


def test_a_walk_that_fails_is_the_sentence_and_exit_code_2(well, capsys):
    well["walk"] = Trial(output=None, failure="ImportError: libc is too old")
    assert main(["doctor"]) == 2
    out, err = capsys.readouterr()
    assert "can run here" not in out
    assert "extras" in out
    assert err == "suchus: suchus cannot run here: a short walk failed (ImportError: libc is too old).\n"


def test_packages_in_their_ranges_are_well_and_others_are_named():
    assert doctor.packages(REQUIRES, at(numpy="2.4.6", mujoco="3.17.0")).problem == ""
    assert doctor.packages(REQUIRES, at(numpy="2.4.6", mujoco="3.17.0")).lines == ("numpy 2.4.6, mujoco 3.17.0",)
    low = doctor.packages(REQUIRES, at(numpy="2.1.9", mujoco="5.0"))
    assert "numpy is 2.1.9" in low.problem
    assert "mujoco is 5.0" in low.problem
    assert "mujoco is missing" in doctor.packages(REQUIRES, at(numpy="2.2")).problem


def test_extras_are_there_or_it_is_said_how_to_get_them():
    (viewer, *others) = doctor.extras(REQUIRES, at(viser="1.1.1", mjviser="0.0.14")).lines
    assert viewer.startswith("viewer    yes, viser 1.1.1, mjviser 0.0.14")
    assert all("no: pip install 'suchus[" in line for line in others)
    assert "pip install 'suchus[viewer]'" in doctor.extras(REQUIRES, at(viser="1.1.1")).lines[0]
    assert "pip install 'suchus[viewer]'" in doctor.extras(REQUIRES, at(viser="2.0", mjviser="1")).lines[0]


def test_every_extra_that_is_told_is_one_of_the_package():
    assert all(doctor._needs(None, extra) for extra in doctor._EXTRAS)


def test_a_bad_number_of_threads_keeps_suchus_from_running(monkeypatch):
    monkeypatch.setenv("SUCHUS_THREADS", "two")
    assert "'two'" in doctor.cores().problem
    monkeypatch.setenv("SUCHUS_THREADS", "2")
    assert doctor.cores().problem == ""


def test_a_walk_must_end_in_numbers():
    assert doctor.walking(WALKED).problem == ""
    assert "no number" in doctor.walking(Trial(output={"seconds": 0.4, "finite": False})).problem


def test_what_is_said_of_compiled_code():
    def told(**changes):
        return " ".join(doctor.compiled(Trial(output=COMPILED | changes)).lines)

    assert told() == ("numba compiles; its threads are those of omp compiled code is kept in /cache/kernels-1 (there)")
    assert "(not there yet" in told(compiled=0)
    assert "set NUMBA_CACHE_DIR" in told(folder=None)
    assert "libgomp1" in told(layer="workqueue")
    assert "lacks _name" in told(missing=["_name"])
    assert "cannot be compiled (x)" in doctor.compiled(Trial(output=None, failure="x")).problem


def test_a_folder_that_takes_nothing_is_said(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "can be written" in doctor.places().lines[0]
    monkeypatch.setattr(doctor, "Path", SimpleNamespace(cwd=lambda: "/dev/null"))
    assert "say --out DIR" in doctor.places().lines[0]


@pytest.fixture
def python(monkeypatch):
    """Let a line of Python stand for the trials."""

    begin = subprocess.Popen

    def set_to(code):
        monkeypatch.setattr(
            doctor.subprocess, "Popen", lambda words, **how: begin([sys.executable, "-I", "-S", "-c", code], **how)
        )

    return set_to


def test_trials_that_answer_fail_die_and_hang(python, monkeypatch):
    python("print('noise'); print('{\"by\": \"egl\"}')")
    assert doctor.run_trials("draw", "draw") == [Trial(output={"by": "egl"})] * 2
    python("import sys; print('first', file=sys.stderr); sys.exit('ImportError: no')")
    assert doctor.run_trials("walk") == [Trial(output=None, failure="ImportError: no")]
    python("import os; os.kill(os.getpid(), 11)")
    assert doctor.run_trials("walk") == [Trial(output=None, failure="the process died of signal 11")]
    python("import time; time.sleep(60)")
    monkeypatch.setattr(doctor, "_TRIAL_TIMEOUT", 0.2)
    assert doctor.run_trials("walk") == [Trial(output=None, failure="no answer within 0.2 s")]


def test_the_trial_walk_walks():
    found = doctor.trial_walk()
    assert found["finite"] is True
    assert found["seconds"] > 0
    assert json.loads(json.dumps(found)) == found


def test_words_that_make_no_sense(capsys):
    assert main(["doctor", "please"]) == 2
    assert "takes no 'please'" in capsys.readouterr().err
    assert main(["doctor", "--help"]) == 0
    assert "exit code" in capsys.readouterr().out
