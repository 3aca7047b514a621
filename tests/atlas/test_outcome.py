"""Outcomes on disk, and flows that are computed only where they are not there yet."""

import os
import pickle
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import evidence.atlas
from evidence.atlas import (
    CASES,
    Case,
    RunEffort,
    compute,
    compute_all,
    digest_of,
    finished_outcome,
    load_outcome,
    load_outcomes,
    save_outcome,
)
from evidence.atlas.case import grids
from suchus.core.errors import NotConverged, UnreadableFile, Unwritable
from suchus.core.jobs import processes
from suchus.core.progress import silent

pytestmark = pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")


def plain_run(effort, progress):
    progress("computing", 0.5)
    return {"curve": np.array([[0.0, 1.0], [1.0, effort.cells / 3]]), "drag": np.array(1.5)}


def refusing_run(effort, progress):
    raise NotConverged("the series has 1 rises; run longer.")


def dying_run(effort, progress):
    os._exit(3)


def case(name="one", run=plain_run, cells=4):
    return Case(
        name=name, setup="{cells}", run=run, code=("skin.py",),
        grids=grids((cells, 3, 2), 1.0), quick_effort=RunEffort(cells=2, until=0.5),
    )  # fmt: skip


def test_an_outcome_comes_back_as_it_was_kept(tmp_path):
    kept = compute(case(), quick=False, progress=silent)
    save_outcome(kept, tmp_path)
    back = load_outcome(tmp_path, "one")
    assert replace(back, curves={}) == replace(kept, curves={})
    assert back.curves["curve"] == pytest.approx(kept.curves["curve"], rel=1e-6)
    assert float(back.curves["drag"]) == 1.5
    assert load_outcome(tmp_path, "two") is None


def test_every_part_of_a_set_up_is_in_its_digest():
    one = case()
    digests = {
        digest_of(one, quick=False), digest_of(one, quick=True), digest_of(case(cells=5), quick=False),
        digest_of(case("two"), quick=False), digest_of(replace(one, code=("case.py",)), quick=False),
        digest_of(replace(one, grids=(replace(one.full, coarse=2),)), quick=False),
        digest_of(replace(one, grids=(replace(one.full, initial_duration=2.0),)), quick=False),
    }  # fmt: skip
    assert len(digests) == 7
    assert digest_of(one, quick=False) == digest_of(case(), quick=False)


def test_the_solver_s_code_is_in_the_digest(monkeypatch):
    before = digest_of(case(), quick=False)
    monkeypatch.setattr("evidence.atlas.outcome.code_digest", lambda *rooms: "other" if "flow" in rooms else "same")
    assert digest_of(case(), quick=False) != before


@pytest.mark.parametrize("name", CASES)
def test_the_files_that_decide_a_flow_s_curves_are_there(name):
    assert all((Path(evidence.atlas.__file__).parent / file).is_file() for file in CASES[name].code)
    function = getattr(CASES[name].run, "func", CASES[name].run)
    assert f"{function.__module__.rpartition('.')[2]}.py" in CASES[name].code


def test_a_flow_that_is_refused_is_an_outcome_with_its_sentence(tmp_path):
    kept = compute_all([case(run=refusing_run)], tmp_path, jobs=1, quick=False)["one"]
    assert kept.failed == "the series has 1 rises; run longer."
    assert load_outcome(tmp_path, "one").failed == kept.failed


def test_what_is_finished_is_not_computed_again(tmp_path):
    ran = []

    def counted(effort, progress):
        ran.append(effort.cells)
        return plain_run(effort, progress)

    for _ in range(2):
        compute_all([case(run=counted)], tmp_path, jobs=1, quick=False)
    assert ran == [4]
    compute_all([case(run=counted, cells=5)], tmp_path, jobs=1, quick=False)
    compute_all([case(run=counted, cells=5)], tmp_path, jobs=1, quick=True)
    assert ran == [4, 5, 2]
    (tmp_path / "flows" / "one.json").write_text("{")
    compute_all([case(run=counted)], tmp_path, jobs=1, quick=False)
    assert ran == [4, 5, 2, 4]
    assert finished_outcome(case(), tmp_path, quick=False) is not None
    assert finished_outcome(case(), tmp_path, quick=True) is None


def test_each_grid_has_an_outcome_of_its_own_and_is_computed_once(tmp_path):
    ran = []

    def counted(effort, progress):
        ran.append(effort.cells)
        return plain_run(effort, progress)

    one = case(run=counted)
    assert list(compute_all([one], tmp_path, jobs=1, quick=False, grids=(2,))) == ["one.grid2"]
    found = compute_all([one], tmp_path, jobs=1, quick=False, grids=(1, 2, 3))
    assert ran == [3, 4, 2]
    assert {flow: (kept.grid, kept.cells) for flow, kept in found.items()} == {
        "one": (1, 4), "one.grid2": (2, 3), "one.grid3": (3, 2)
    }  # fmt: skip
    assert len({kept.digest for kept in found.values()}) == 3
    assert load_outcomes(tmp_path, [one]).keys() == found.keys()
    assert load_outcome(tmp_path, "one", 3).cells == 2
    alone = replace(one, name="alone", grids=one.grids[:1])  # a flow with one grid is not computed on others
    assert list(compute_all([alone], tmp_path, jobs=1, quick=False, grids=(1, 2, 3))) == ["alone"]


def test_ctrl_c_keeps_what_is_finished(tmp_path):
    def stopped(effort, progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        compute_all([case(), case("two", stopped)], tmp_path, jobs=1, quick=False)
    assert [path.name for path in (tmp_path / "flows").iterdir()] == ["one.json"]


def test_progress_ends_with_the_outcome(tmp_path):
    said = []

    def each(name):
        return lambda stage, share: said.append((name, stage, share))

    for _ in range(2):  # the second time of what is there
        compute_all([case()], tmp_path, jobs=1, quick=False, each=each, finished=lambda one: said.append(one.case))
    assert said == [("one", "computing", 0.5), "one", "one"]


@pytest.mark.parametrize("name", CASES)
def test_a_flow_can_be_handed_to_another_process(name):
    assert pickle.loads(pickle.dumps(CASES[name])).full == CASES[name].full


def test_side_by_side_a_process_that_dies_takes_only_its_own_flow(tmp_path, monkeypatch):
    """Forked here: a process that starts afresh imports for some seconds."""
    monkeypatch.setattr("suchus.core.jobs.processes.get_context", lambda kind: get_context("fork"))
    monkeypatch.setattr("suchus.core.jobs.processes._STOP_TIMEOUT", 0.5)  # forked ones hold each other's pipes open
    cases = [case(), case("dies", dying_run)]
    came = compute_all(cases, tmp_path, jobs=2, quick=True)
    assert came["one"].curves["curve"][1, 1] == pytest.approx(2 / 3)
    assert "exit code 3" in came["dies"].failed
    assert load_outcome(tmp_path, "one") is not None
    assert load_outcome(tmp_path, "dies") is None  # so that it is tried again


def test_side_by_side_an_error_ends_the_processes(tmp_path, monkeypatch):
    """What ``processes`` promises of its closed generator is tested there; here, that it is closed at once."""
    ended = []

    def working(work, cases, jobs, *, tries, threads_per_process):
        try:
            yield 0, processes.PieceStarted()
            yield 0, processes.PieceProgress("computing", 0.5)
        finally:
            ended.append(jobs)

    def stop(stage, share):
        raise KeyboardInterrupt

    monkeypatch.setattr(processes, "side_by_side", working)
    with pytest.raises(KeyboardInterrupt) as caught:  # holds the frames, so that nothing ends by being forgotten
        compute_all([case(), case("two")], tmp_path, jobs=2, quick=True, each=lambda _: stop)
    assert ended == [2], caught


def test_a_file_of_something_else_is_refused(tmp_path):
    (tmp_path / "flows").mkdir()
    (tmp_path / "flows" / "one.json").write_text('{"case": "one"}')
    with pytest.raises(UnreadableFile, match="holds no outcome of the atlas"):
        load_outcome(tmp_path, "one")


def test_a_place_that_takes_nothing_is_named(tmp_path):
    (tmp_path / "flows").write_text("a file")
    with pytest.raises(Unwritable, match="flows"):
        compute_all([case()], tmp_path, jobs=1, quick=False)
