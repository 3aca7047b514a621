"""What is larger than the machine bears is estimated and refused before it begins, on both sides of each bound."""

import os
import resource
import subprocess
import sys
import time

import mujoco
import pytest

from suchus.apps.cli import main
from suchus.apps.cli.entry import MIN_ADDRESS_SPACE
from suchus.core import large
from suchus.core.errors import InvalidDesign, NoMemory
from suchus.core.jobs import processes
from suchus.experiments.study import read_study, run_chunk
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.land.extent import processor_seconds, record_bytes

CRAWL = Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"])
STUDY = """
name = "grip"
duration = {duration}
measure = ["displacement"]
design = "latin"
samples = {samples}

[[vary]]
field = "ground.friction_scale"
low = 0.5
high = 1.0
"""
SEARCH = """
name = "far"
evaluations = {evaluations}
aims = [{{name = "displacement"}}]
[[vary]]
field = "gait.stroke"
low = 0.1
high = 0.3
"""


def refused(call):
    with pytest.raises(InvalidDesign) as caught:
        call()
    return str(caught.value)


def test_half_of_the_memory_is_free_the_rest_is_asked_for_and_more_than_all_is_refused(monkeypatch):
    monkeypatch.setattr(large, "memory", lambda: 4 * 10**9)
    large.check_memory("a thing", 2e9, "take less")
    said = "a thing takes some 2.1 GB of memory, and this machine has 4 GB; take less, or say --large"
    assert refused(lambda: large.check_memory("a thing", 2.1e9, "take less")).startswith(said)
    with large.allowing():
        large.check_memory("a thing", 4e9, "take less")
        assert refused(lambda: large.check_memory("a thing", 4.1e9, "take less")).endswith("has 4 GB; take less.")
    monkeypatch.setattr(large, "memory", lambda: None)
    large.check_memory("a thing", 1e18, "take less")


def test_a_day_of_a_processor_is_free_and_more_is_asked_for():
    large.check_work("a thing", large.MAX_PROCESSOR_TIME, "take less")
    said = refused(lambda: large.check_work("a thing", 2 * large.MAX_PROCESSOR_TIME, "take less"))
    assert said == "a thing takes some 2 days of a processor; take less, or say --large to begin all the same."
    with large.allowing():
        large.check_work("a thing", 2 * large.MAX_PROCESSOR_TIME, "take less")


def test_what_was_allowed_before_is_allowed_afterwards(monkeypatch):
    monkeypatch.delenv(large.LARGE_VARIABLE, raising=False)
    with large.allowing(False):
        assert not large.allowed()
    with large.allowing():
        assert large.allowed()
        with large.allowing():
            pass
        assert large.allowed()
        assert os.environ[large.LARGE_VARIABLE] == "1"  # which processes that help see
    assert not large.allowed()
    assert large.LARGE_VARIABLE not in os.environ


def test_memory_is_the_machines_or_less_by_a_limit(monkeypatch):
    whole = large.memory()
    monkeypatch.setattr(resource, "getrlimit", lambda which: (whole // 2, whole))
    assert large.memory() == whole // 2
    monkeypatch.setattr(resource, "getrlimit", lambda which: (2 * whole, 2 * whole))
    assert large.memory() == whole


@pytest.mark.parametrize(("robot", "gait"), [("caiman", "belly_crawl"), ("swimmer", "undulation")])
def test_estimates_are_of_the_size_of_what_a_run_takes(robot, gait):
    run = Run(robot=ROBOTS[robot], gait=GAITS[gait])
    simulate([run], duration=0.02)  # kernels are loaded, or compiled
    began = time.thread_time()  # threads of other tests do not count
    record = simulate([run], duration=1.0)
    took = time.thread_time() - began
    assert record_bytes(run, record.sizes["time"]) == pytest.approx(record.nbytes, rel=0.3)
    assert 0.05 < processor_seconds(run, 1.0, record.attrs["timestep"]) / took < 20.0  # other machines and loads


def test_a_run_is_refused_before_it_begins_and_only_if_it_is_too_large(monkeypatch):
    need = 2 * record_bytes(CRAWL, 0.1 / 0.01)
    monkeypatch.setattr(large, "memory", lambda: int(need / large.MAX_MEMORY_FRACTION) + 1)
    simulate([CRAWL], duration=0.1)
    monkeypatch.setattr(large, "memory", lambda: int(need / large.MAX_MEMORY_FRACTION) - 1)
    assert refused(lambda: simulate([CRAWL], duration=0.1)).startswith("a run of 0.1 s takes some")
    assert refused(lambda: simulate([CRAWL] * 2, duration=0.1)).startswith("a batch of 2 runs of 0.1 s takes some")
    simulate([CRAWL], duration=0.1, sample_stride=2)
    with large.allowing():
        simulate([CRAWL], duration=0.1)


def test_a_study_is_refused_by_its_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    a_day = large.MAX_PROCESSOR_TIME / processor_seconds(CRAWL, 9.0, 0.005)
    (tmp_path / "s.toml").write_text(STUDY.format(duration=9.0, samples=int(1.01 * a_day)))
    assert main(["study", "s.toml", "--out", "made"]) == 2
    said = capsys.readouterr().err
    assert "of a processor; ask for fewer samples or shorter runs, or say --large to begin" in said
    assert not (tmp_path / "made").exists()


def test_a_search_is_refused_by_its_walks_and_begins_with_large(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "o.toml").write_text(SEARCH.format(evaluations=1_000_000))
    assert main(["optimise", "o.toml", "--out", "made"]) == 2
    assert "search 'far' of 1000000 walks takes some" in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.nc"))

    def begun(*_):
        raise InvalidDesign("it has begun.")

    monkeypatch.setattr(sys.modules["suchus.experiments.optimise.conduct"], "_arm", begun)
    assert main(["optimise", "o.toml", "--out", "made", "--large"]) == 2
    assert "it has begun" in capsys.readouterr().err


def test_a_process_of_too_little_memory_is_told_in_a_sentence(monkeypatch, capsys):
    monkeypatch.setattr(large, "memory", lambda: MIN_ADDRESS_SPACE - 1)
    assert main(["--version"]) == 2
    assert "raise the limit" in capsys.readouterr().err
    monkeypatch.setattr(large, "memory", lambda: MIN_ADDRESS_SPACE)
    assert main(["--version"]) == 0


def test_memory_that_runs_out_is_a_sentence(monkeypatch, capsys):
    def hungry(words, commands):
        raise MemoryError

    monkeypatch.setattr(sys.modules["suchus.apps.cli.entry"], "_dispatch", hungry)
    assert main(["list"]) == 2
    assert "the memory does not suffice" in capsys.readouterr().err


def test_memory_that_mujoco_does_not_get_is_told_as_such(monkeypatch):
    said = ["Could not allocate memory"]

    def full(*_, **__):
        raise ValueError(said[0])

    monkeypatch.setattr("suchus.sim.land.batch.Batch", full)
    with pytest.raises(NoMemory, match="the memory does not suffice"):
        simulate([CRAWL], duration=0.02)
    said[0] = "nsim must be positive"
    with pytest.raises(ValueError, match="nsim"):
        simulate([CRAWL], duration=0.02)


def test_a_command_that_gets_no_memory_of_mujoco_says_so(monkeypatch, capsys):
    def hungry(words, commands):
        raise mujoco.FatalError("Could not allocate memory")

    monkeypatch.setattr(sys.modules["suchus.apps.cli.entry"], "_dispatch", hungry)
    assert main(["list"]) == 2
    assert "the memory does not suffice" in capsys.readouterr().err


def test_a_batch_that_does_not_fit_is_halved_and_a_run_that_does_not_is_no_result(tmp_path, monkeypatch):
    (tmp_path / "s.toml").write_text(STUDY.format(duration=1.1, samples=4))
    study, most, walked = read_study(tmp_path / "s.toml"), [4], simulate

    def narrow(runs, **options):
        if len(runs) > most[0]:
            raise NoMemory
        return walked(runs, **options)

    monkeypatch.setattr("suchus.experiments.study.chunk.simulate", narrow)
    whole = run_chunk(study, 0)
    most[0] = 1
    assert run_chunk(study, 0).identical(whole)
    most[0] = 0
    with pytest.raises(NoMemory):
        run_chunk(study, 0)


def test_memory_that_runs_out_in_another_process_is_the_same_sentence(monkeypatch):
    class Pipe(list):
        send = list.append

        def recv(self):
            if self:
                raise EOFError
            return "a piece"

    def hungry(item, tell):
        raise MemoryError

    monkeypatch.setenv("SUCHUS_THREADS", "1")
    said = Pipe()
    processes._work(said, hungry, 1)
    assert [type(one.error) for one in said] == [NoMemory]


@pytest.mark.skipif(sys.platform != "linux", reason="address space is limited on Linux")
def test_with_a_real_limit_nothing_spins(tmp_path):
    line = 'ulimit -v 250000; exec "$0" -m suchus run displacement --quick --out "$1"'
    command = ["sh", "-c", line, sys.executable, str(tmp_path / "made")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "raise the limit" in done.stderr
    assert not (tmp_path / "made").exists()
