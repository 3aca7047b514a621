"""Studies, searches and sweeps on a cluster: the same bytes, also when a worker or the scheduler is killed."""

import json
import os
import pickle
import subprocess
import sys
import time
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from suchus.apps.cli import main
from suchus.core.errors import IncompatibleRecord, InvalidDesign
from suchus.core.fingerprint import fingerprint
from suchus.core.jobs import NoCluster, conduct_sweep, connected
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_3d.experiment import Item, _swim_locally, swim_in_space
from suchus.experiments.optimise import Aim, Optimisation, optimise
from suchus.experiments.optimise.conduct import try_candidates
from suchus.experiments.optimise.evaluate import evaluate
from suchus.experiments.study import Study, Vary, conduct
from suchus.experiments.study.varied import conduct_varied, varied_study
from suchus.sim.land import Run
from suchus.swimming.water import fit, printed_wave
from suchus.swimming.water.resolved import SwimSetting

pytestmark = pytest.mark.filterwarnings("default")  # Dask's own


@pytest.fixture
def asked(robot, crawl_gait):
    return Study(
        name="spread",
        run=Run(robot=robot, gait=crawl_gait, noise=0.01),
        vary=(Vary(field="gait.height", values=(0.5, 1.7)),),
        measure=("displacement",),
        seeds=2,
        chunk=1,
        duration=1.1,
        timestep=0.01,
    )


@pytest.fixture
def search(robot, crawl_gait):
    return Optimisation(
        name="small",
        run=Run(robot=robot, gait=crawl_gait),
        vary=(Vary(field="gait.stroke", low=0.0, high=0.75), Vary(field="gait.trunk_bend", low=0.0, high=2.3)),
        aims=(Aim(name="displacement"),),
        evaluations=4,
        population=4,
        duration=1.1,
        timestep=0.01,
    )


class Machines:
    """A scheduler and workers, each a process that can be killed."""

    def __init__(self, folder, workers):
        self._file, self._folder = folder / "scheduler.json", folder
        self.scheduler = self._begun("scheduler", "--host", "127.0.0.1", "--port", "0")
        self.workers = [self._begun("worker", "--nthreads", "1", "--no-nanny") for _ in range(workers)]
        while not (self._file.exists() and self._file.read_text().rstrip().endswith("}")):  # not while it is written
            assert self.scheduler.poll() is None
            time.sleep(0.05)
        self.address = json.loads(self._file.read_text())["address"]

    def _begun(self, what, *options):
        words = [sys.executable, "-m", "dask", what, "--scheduler-file", str(self._file), "--no-dashboard", *options]
        places = [str(Path(__file__).parent), *sys.path]  # a sweep's calculation stands where workers can import it
        return subprocess.Popen(
            words,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            cwd=self._folder,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(places), "SUCHUS_THREADS": "1"},
        )

    def stop(self):
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture
def machines(tmp_path):
    pytest.importorskip("distributed", reason="Dask is not installed: pip install suchus[cluster]")
    (tmp_path / "machines").mkdir()
    made = Machines(tmp_path / "machines", workers=2)
    yield made
    made.stop()


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def squared(number, progress):
    time.sleep(0.2)
    progress("squaring", 1.0)
    return xr.Dataset({"x": ("i", np.arange(3.0) * number**2, {"units": "m"})}, attrs={"of": number})


@pytest.mark.battery("kills")
@pytest.mark.slow("a cluster, of which parts are killed, and a second run")
def test_the_same_bytes_whatever_is_killed(asked, search, machines, tmp_path, counted):
    claims = varied_study(EXPERIMENTS["tail_bending"], samples=8)
    with connected(machines.address) as client:
        client.wait_for_workers(2, timeout=300)
        conduct_varied(claims, tmp_path / "claims", client=client)
        optimise(search, tmp_path / "search", client=client)
        conduct(asked, tmp_path / "study", progress=lambda *_: machines.workers[0].kill(), client=client)
        assert len(client.nthreads()) == 1
        with pytest.raises(NoCluster, match=r"the cluster was lost \(.*\); what was finished is kept"):
            conduct_sweep(
                "squares", squared, range(1, 6), tmp_path / "sweep", progress=lambda *_: machines.stop(), client=client
            )
    counted(2)
    assert 1 <= len(list((tmp_path / "sweep" / "parts").iterdir())) < 5
    results = conduct_sweep("squares", squared, range(1, 6), tmp_path / "sweep")  # resumed, here
    assert [(float(one.x[1]), one.attrs) for one in results] == [(float(n**2), {"of": n}) for n in range(1, 6)]
    spread = conduct(asked, tmp_path / "study_here")
    assert int((spread.error != "").sum()) == 2
    conduct_varied(claims, tmp_path / "claims_here")
    optimise(search, tmp_path / "search_here")
    conduct_sweep("squares", squared, range(1, 6), tmp_path / "sweep_here")
    for name in ("claims", "study", "search", "sweep"):
        assert contents(tmp_path / name) == contents(tmp_path / f"{name}_here")


@pytest.fixture
def swims(robot):
    """Name, calculation and items of a sweep of one small swim in three dimensions."""
    wave = fit(robot, printed_wave(robot, "I", sign=-1)).gait
    return (
        "swims",
        partial(swim_in_space, robot),
        [Item(wave, SwimSetting(axes=3, cells=54, viscosity=2e-3, cycles=1, frames=2))],
    )


def test_a_worker_gets_the_swim_that_is_asked(swims):
    for part in swims:
        assert fingerprint(pickle.loads(pickle.dumps(part))) == fingerprint(part)


@pytest.mark.validate  # half a minute: two swims, and machines that load the solver
def test_a_swim_in_three_dimensions_has_the_bytes_of_one_here(robot, swims, machines, tmp_path):
    with connected(machines.address) as client:
        conduct_sweep(*swims, tmp_path / "there", client=client)
    (swum,) = conduct_sweep(*swims, tmp_path / "here", local=partial(_swim_locally, robot, str(tmp_path / "kept")))
    assert contents(tmp_path / "there") == contents(tmp_path / "here")
    assert swum.sizes["frame"] == 2
    assert float(swum.power[-1]) > 0.0


class Backwards:
    """A place that does three pieces at once, and finishes the last one first."""

    at_once = 3

    def results(self, job, items, begun):
        self.sizes = [len(item) for item in items]
        return ((i, job.work(items[i], begun(i))) for i in reversed(range(len(items))))


def test_a_generation_in_pieces_is_the_generation(search):
    shares = np.random.default_rng(0).uniform(-0.2, 1.2, (5, 2))  # some cannot be
    place, told = Backwards(), []
    found = try_candidates(place, search, shares, lambda _, share: told.append(share))
    xr.testing.assert_identical(found, evaluate(search, shares))
    assert place.sizes == [2, 2, 1]
    assert told == sorted(told)
    assert told[-1] == 1.0


@cache
def done():
    """Numbers that a sweep was at; of a call, since what a function is made with belongs to its store."""
    return []


def halved(number, progress):
    done().append(number)
    if len(done()) == 3:
        raise KeyboardInterrupt
    return xr.Dataset({"x": ((), number / 2)})


def test_a_sweep_goes_on_with_what_is_missing_and_refuses_another(tmp_path):
    done.cache_clear()
    with pytest.raises(KeyboardInterrupt):
        conduct_sweep("halves", halved, (1, 2, 3, 4), tmp_path / "s")
    for name, work, items in (("halves", halved, (1, 2, 3)), ("halves", squared, (1, 2, 3, 4))):
        with pytest.raises(IncompatibleRecord, match=r"differs from 'halves' in (items|work)"):
            conduct_sweep(name, work, items, tmp_path / "s")
    shares = []
    whole = conduct_sweep(
        "halves", halved, (1, 2, 3, 4), tmp_path / "s", progress=lambda _, share: shares.append(share)
    )
    assert done() == [1, 2, 3, 3, 4]
    assert shares == [0.75, 1.0]
    assert [float(one.x) for one in whole] == [0.5, 1.0, 1.5, 2.0]
    with pytest.raises(InvalidDesign, match="items is empty"):
        conduct_sweep("none", halved, (), tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_a_scheduler_that_is_not_there_is_a_sentence(asked, tmp_path):
    pytest.importorskip("distributed", reason="Dask is not installed: pip install suchus[cluster]")
    with (
        pytest.raises(NoCluster, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"),
        connected("tcp://127.0.0.1:9", patience=0.5),
    ):
        pass


PAGE = """
name = "s"
{}
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.6
"""


@pytest.mark.parametrize(
    "words",
    [["study", "study.toml"], ["optimise", "search.toml"], ["run", "swim_sweep"], ["run", "swim_3d"]],
)
def test_each_command_takes_a_scheduler(words, tmp_path, monkeypatch, capsys):
    (tmp_path / "study.toml").write_text(PAGE.format('measure = ["slip"]\ndesign = "latin"\nsamples = 2'))
    (tmp_path / "search.toml").write_text(PAGE.format('aims = [{name = "displacement"}]'))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert main([*words, "--scheduler", "tcp://127.0.0.1:9", "--out", "out"]) == 2
    assert "pip install 'suchus[cluster]'" in capsys.readouterr().err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["search.toml", "study.toml"]
