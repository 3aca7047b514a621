"""What a run could go on from is there until its result is."""

import os
import sys
from dataclasses import fields, replace

import pytest

from suchus.apps.cli.run import perform
from suchus.core.errors import Unwritable
from suchus.core.files.provenance import digest
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import CONDUCT, silent
from suchus.robot.robots import ROBOTS

run = sys.modules["suchus.apps.cli.run"]


@pytest.mark.usefixtures("fakes")
def test_nothing_is_forgotten_before_its_successor_is_on_disk(tmp_path, monkeypatch):
    wave, kept, others = EXPERIMENTS["wave"], tmp_path / "mine.kept-swim", tmp_path / "other.kept-swim"
    simulate = type(wave).simulate
    monkeypatch.setattr(
        type(wave), "simulate", lambda *a: replace(simulate(*a), checkpoint_files=(kept, tmp_path / "never_made"))
    )
    kept.touch()
    others.touch()

    def full(*_, **__):
        raise Unwritable("no space left on device")

    with monkeypatch.context() as disk:
        disk.setattr(run, "save_outcome", full)
        with pytest.raises(Unwritable):
            perform(wave, "wave", tmp_path / "out", silent, "again")
    assert kept.is_file()
    perform(wave, "wave", tmp_path / "out", silent, "again")
    assert not kept.exists()
    assert others.is_file()


@pytest.mark.parametrize("name", ["swimming", "swim_free", "swim_3d", "swim_sweep"])
def test_a_place_that_keeps_nothing_is_refused_before_anything_swims(name, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    told = []
    with pytest.raises(Unwritable, match=r"pipe cannot be written: not a directory\."):
        replace(EXPERIMENTS[name].quick(), keep=str(tmp_path / "pipe")).simulate(lambda *said: told.append(said))
    assert not told


def test_where_and_by_how_many_processes_it_is_computed_stands_in_no_result():
    for name in ("swimming", "swim_free", "swim_3d", "swim_sweep"):
        experiment = EXPERIMENTS[name]
        there = {one.name for one in fields(experiment)} & set(CONDUCT)
        elsewhere = {"keep": "/tmp/scratch", "jobs": 7, "scheduler": "tcp://127.0.0.1:8786"}
        other = replace(experiment, **{field: elsewhere[field] for field in there})
        assert "keep" in there
        assert digest(other.settings()) == digest(experiment.settings())
        assert digest(replace(other, robot=ROBOTS["long_tail"]).settings()) != digest(experiment.settings())
