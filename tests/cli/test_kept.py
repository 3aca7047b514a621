"""``suchus reproduce`` goes on where it stopped, and keeps nothing that a run would not give again."""

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.apps.cli.reproduce import ExperimentTask, attempt, reusable_result
from suchus.apps.report import Result
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES
from suchus.experiments.experiment import silent

origin = sys.modules["suchus.core.files.provenance"]


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    task = ExperimentTask(name="leg_kinematics", out=tmp_path_factory.mktemp("out"), quick=True)
    assert isinstance(attempt(task, silent).result, Result)
    return task


@pytest.fixture
def task(first, tmp_path):
    """The same result in a folder of its own, which a test may spoil."""
    shutil.copytree(first.out, tmp_path / "out")
    return replace(first, out=tmp_path / "out")


def test_a_finished_experiment_is_kept_and_reads_as_the_run_did(task):
    again, anew = reusable_result(task), attempt(task, silent)
    assert again.summary == anew.summary.rpartition(" (")[0] + " (kept from an earlier run)"
    for name in ("measures", "verdicts", "command", "decides"):
        assert again.result.outcome[name] == anew.result.outcome[name]
    assert again.result.pictures == anew.result.pictures


def test_what_was_never_run_or_asked_in_another_form_is_not_kept(task, tmp_path):
    assert reusable_result(replace(task, quick=False)) is None
    assert reusable_result(replace(task, out=tmp_path / "elsewhere")) is None
    assert reusable_result(replace(task, name="spine_kinematics")) is None


@pytest.mark.parametrize("name", ["package_digest", "versions"])
def test_other_code_and_other_libraries_are_run_again(task, monkeypatch, name):
    other = {"package_digest": "0" * 12, "versions": {"numpy": "1.0"}}[name]
    monkeypatch.setattr(origin, name, lambda: other)
    assert reusable_result(task) is None


@pytest.mark.parametrize("name", ["record.nc", "outcome.json", "*.svg"])
def test_a_result_that_lacks_a_file_is_run_again(task, name):
    next((task.out / task.name).glob(name)).unlink()
    assert reusable_result(task) is None


def test_a_broken_outcome_is_run_again(task):
    (task.out / task.name / "outcome.json").write_text('{"experiment": 1}')
    assert reusable_result(task) is None


@pytest.mark.usefixtures("fakes")
def test_an_experiment_of_ones_own_is_always_run_again_and_so_is_all_that_is_asked_anew(tmp_path, capsys):
    for words in ([], ["--anew"], []):
        assert main(["reproduce", "--out", str(tmp_path), *words]) == 0
        assert "kept" not in capsys.readouterr().err


def test_the_digest_of_the_package_follows_every_file(tmp_path, monkeypatch):
    monkeypatch.setattr(origin, "_PACKAGE", tmp_path)
    digest = origin.package_digest.__wrapped__
    (tmp_path / "a.py").write_text("x = 1")
    first = digest()
    (tmp_path / "__pycache__").mkdir()
    (tmp_path / "__pycache__" / "a.pyc").write_text("1")
    assert digest() == first
    (tmp_path / "table.csv").write_text("1")
    second = digest()
    (tmp_path / "a.py").write_text("x = 2")
    assert len({first, second, digest()}) == 3


def test_what_reproduce_leaves_out_judges_nothing_and_is_named_in_the_docs():
    left_out = [name for name, one in EXPERIMENTS.items() if not one.reproduces]
    assert left_out
    assert [name for name in left_out if {*EXPERIMENTS[name].claims} & {*RULES}] == []  # hypotheses of its own may be
    named = ", ".join(f"`{name}`" for name in left_out[:-1]) + f" and `{left_out[-1]}`"
    page = (Path(__file__).parents[2] / "docs" / "command_line.md").read_text(encoding="utf-8")
    assert f"runs every experiment but {named}, " in page


def test_what_no_verdict_needs_is_asked_for_by_another_command_and_is_another_result(task):
    short = ExperimentTask(name="displacement", out=task.out, quick=False)
    whole = replace(short, whole=True)
    assert short.command == "suchus run displacement --for-verdicts"
    assert whole.command == "suchus run displacement"
    assert short.experiment.settings() != whole.experiment.settings()
    assert replace(short, name="leg_kinematics").command == "suchus run leg_kinematics"  # which needs all of it
    assert replace(short, quick=True, whole=True).command == "suchus run displacement --quick"
