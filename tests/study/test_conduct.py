"""Results are the same to the byte, whatever happens on the way."""

import json
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import IncompatibleRecord, OutsideLimits, Unwritable
from suchus.core.files import load
from suchus.core.jobs import PieceCrash, ProcessCrash, processes
from suchus.core.jobs.store import MARK, RESULTS, TABLE, Store, packed, unpacked
from suchus.experiments.study import Plan, Study, Vary, conduct, read_study, run_chunk
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement

PAGE = """
name = "strokes"
design = "latin"
samples = 8
chunk = 1
duration = 1.2
measure = ["displacement"]
noise = 0.01
[[vary]]
field = "gait.stroke"
low = 0.0
high = 0.05
[[vary]]
field = "gait"
values = ["belly_crawl", "limbs_only"]
"""


@pytest.fixture
def asked(robot, crawl_gait):
    return Study(
        name="strokes",
        run=Run(robot=robot, gait=crawl_gait, noise=0.01),
        vary=(Vary(field="gait.stroke", low=0.0, high=0.05),),
        measure=("displacement", "slip"),
        design="sobol",
        samples=5,
        chunk=2,
        duration=1.2,
    )


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_results_are_what_the_simulation_and_the_metrics_say(asked, tmp_path):
    results = conduct(asked, tmp_path / "s")
    plan = Plan(asked)
    record = simulate([plan.run(i) for i in range(5)], duration=asked.duration, timestep=asked.timestep)
    np.testing.assert_array_equal(results.displacement_x, displacement(record).sel(xyz="x"))
    np.testing.assert_array_equal(results["gait.stroke"], [p.values["gait.stroke"] for p in plan])
    units = {name: results[name].attrs["units"] for name in ("displacement_x", "gait.stroke", "slip", "seed")}
    assert units == {"displacement_x": "m", "gait.stroke": "limb reach", "slip": "1", "seed": "1"}
    assert set(results.error.values) == {""}
    stored = load(tmp_path / "s" / RESULTS)
    np.testing.assert_array_equal(stored.slip, results.slip)
    lines = (tmp_path / "s" / TABLE).read_text().splitlines()
    assert lines[0].split(",")[:3] == ["sample", "gait.stroke", "seed"]
    assert len(lines) == 6


def test_threads_and_company_do_not_change_a_byte(asked, tmp_path, monkeypatch):
    conduct(asked, tmp_path / "two")
    monkeypatch.setenv("SUCHUS_THREADS", "1")
    conduct(asked, tmp_path / "one")
    assert contents(tmp_path / "one") == contents(tmp_path / "two")
    alone = conduct(replace(asked, chunk=1), tmp_path / "alone")
    np.testing.assert_array_equal(alone.slip, load(tmp_path / "one" / RESULTS).slip)


def test_progress_counts_up_to_all_runs(asked, tmp_path):
    told = []
    conduct(asked, tmp_path / "s", progress=lambda *said: told.append(said))
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    stage, share = told[-1]
    assert share == 1.0
    assert stage.startswith("5 of 5 runs, ")
    assert stage.endswith("/s, 0 s left")


@pytest.mark.battery("kills")
@pytest.mark.slow("a process is killed, and the study run twice")
def test_a_killed_study_loses_at_most_the_running_batch_and_ends_with_the_same_bytes(tmp_path, counted):
    page = tmp_path / "strokes.toml"
    page.write_text(PAGE)
    kept = {}
    for attempt in range(20):
        store = tmp_path / f"killed {attempt}"
        command = [sys.executable, "-m", "suchus", "study", str(page), "--out", str(store)]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while len(list((store / "parts").glob("*.nc"))) < 2 and process.poll() is None:
                time.sleep(0.002)
            os.kill(process.pid, signal.SIGKILL)
        kept = {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in (store / "parts").glob("*.nc")}
        if len(kept) < 8:
            break  # else this process waited for a busy machine until the study was finished
    counted()
    assert 2 <= len(kept) < 8
    assert not (store / RESULTS).exists()
    asked = read_study(page)
    conduct(asked, store)
    for name, (held, when) in kept.items():
        assert (store / "parts" / name).read_bytes() == held
        assert (store / "parts" / name).stat().st_mtime_ns == when  # not run again
    conduct(asked, tmp_path / "whole")
    assert contents(store) == contents(tmp_path / "whole")


def test_drafts_and_torn_parts_of_a_crash_are_mended(asked, tmp_path):
    conduct(asked, tmp_path / "whole")
    conduct(asked, tmp_path / "torn")
    parts = tmp_path / "torn" / "parts"
    draft = parts / ".000001.nc-abc"
    draft.mkdir()
    (draft / "000001.nc").write_bytes(b"half")
    torn = parts / "000002.nc"
    torn.write_bytes(torn.read_bytes()[:1000])
    (tmp_path / "torn" / RESULTS).unlink()
    conduct(asked, tmp_path / "torn")
    assert contents(tmp_path / "torn") == contents(tmp_path / "whole")
    assert not draft.exists()


def test_an_interrupt_keeps_what_was_finished(asked, tmp_path):
    before = threading.active_count()

    def stop(stage, share):
        if list((tmp_path / "s" / "parts").glob("*.nc")):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        conduct(asked, tmp_path / "s", progress=stop)
    assert threading.active_count() == before
    (kept,) = (tmp_path / "s" / "parts").iterdir()
    when = kept.stat().st_mtime_ns
    conduct(asked, tmp_path / "s")
    assert kept.stat().st_mtime_ns == when  # not run again
    conduct(asked, tmp_path / "whole")
    assert contents(tmp_path / "s") == contents(tmp_path / "whole")


def test_failing_runs_are_recorded_and_the_others_go_on(asked):
    odd = replace(
        asked,
        vary=(
            Vary(field="gait.height", values=(0.51, 1.7)),  # 1.7 is out of the legs' reach
            Vary(field="robot.head.snout", values=(0.02, 0.2125)),  # 0.02 m is behind the shoulders
            Vary(field="robot.tail.joints", values=(6, 8)),  # two topologies do not fit into one batch
        ),
        design="factorial",
        chunk=8,
        measure=("displacement",),
    )
    table = run_chunk(odd, 0)
    said = [error.partition(" ")[0] for error in table.error.values]
    assert said == ["InvalidFields:"] * 2 + [""] * 2 + ["InvalidFields:"] * 2 + ["OutsideLimits:"] * 2
    assert np.isfinite(table.displacement_x.values).tolist() == [False] * 2 + [True] * 2 + [False] * 4
    assert table.displacement_x.values[2] != table.displacement_x.values[3]


def test_a_batch_in_which_all_fail_still_has_its_columns_in_the_end(asked, tmp_path):
    high = replace(asked, vary=(Vary(field="gait.height", values=(1.7, 1.8, 0.51)),), design="factorial")
    results = conduct(high, tmp_path / "s")
    assert np.isnan(results.slip.values).tolist() == [True, True, False]
    assert (results.error != "").values.tolist() == [True, True, False]
    told = []
    (tmp_path / "s" / "parts" / "000001.nc").unlink()
    conduct(high, tmp_path / "s", progress=lambda stage, _: told.append(stage))
    assert told[-1].endswith(", 2 failed")


def test_a_run_that_comes_apart_says_when(asked):
    wild = replace(
        asked, run=replace(asked.run, noise=1.0), timestep=0.01, seeds=3, samples=1, chunk=3, measure=("displacement",)
    )
    table = run_chunk(wild, 0)
    for number, error in zip(table.displacement_x.values, table.error.values, strict=True):
        assert np.isfinite(number) == (error == "")
    assert table.seed.values.tolist() == [0, 1, 2]


def test_another_studys_store_is_named_and_left_alone(asked, tmp_path):
    conduct(asked, tmp_path / "s")
    before = contents(tmp_path / "s")
    with pytest.raises(IncompatibleRecord, match=r"holds study 'strokes', which differs from 'other' in name, samples"):
        conduct(replace(asked, name="other", samples=6), tmp_path / "s")
    assert contents(tmp_path / "s") == before


def test_another_versions_store_is_named_and_left_alone(asked, tmp_path):
    conduct(asked, tmp_path / "s")
    mark = tmp_path / "s" / MARK
    origin = json.loads(mark.read_text())
    origin["versions"]["mujoco"] = "3.9.0"
    mark.write_text(json.dumps(origin))
    before = contents(tmp_path / "s")
    with pytest.raises(IncompatibleRecord, match=r"written by mujoco 3\.9\.0 \(here [\d.]+\)"):
        conduct(asked, tmp_path / "s")
    assert contents(tmp_path / "s") == before


def test_a_folder_of_something_else_or_a_busy_store_is_refused(asked, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("x")
    with pytest.raises(Unwritable, match="holds no study"):
        conduct(asked, tmp_path / "mine")
    (tmp_path / "file").write_text("x")
    with pytest.raises(Unwritable):
        conduct(asked, tmp_path / "file")
    with pytest.raises(Unwritable, match="cannot be written"):
        conduct(asked, tmp_path / "file" / "below")

    def again(stage, share):
        with pytest.raises(Unwritable, match="by another process"):
            conduct(asked, tmp_path / "s")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        conduct(asked, tmp_path / "s", progress=again)


def test_a_table_comes_back_from_its_file_as_it_was(asked, tmp_path):
    names = [f"number_{i}" for i in (3, 10, 1, 2)]
    columns = {name: ("sample", np.array([i, np.nan]), {"units": f"u{i}"}) for i, name in enumerate(names)}
    words = {"arm": ("sample", np.array(["a", "b"]))}
    table = xr.Dataset(
        {**columns, **words, "seed": ("sample", np.array([1, 2]))}, coords={"sample": np.arange(2)}, attrs={"part": 0}
    )
    xr.testing.assert_identical(unpacked(packed(table)), table)
    assert len(packed(table).data_vars) == 3
    store = Store(tmp_path / "s", asked)
    store.put(0, table)
    back = store.get(0)
    xr.testing.assert_identical(back.drop_attrs(deep=False), table.drop_attrs(deep=False))
    assert list(back.data_vars) == list(table.data_vars)
    assert packed(words_alone := table[["arm"]]) is words_alone


@pytest.mark.slow("a second run, by processes of its own")
def test_processes_do_not_change_a_byte_and_what_an_interrupt_leaves_is_finished(asked, tmp_path):
    told = []

    def stop(stage, share):
        if list((tmp_path / "two" / "parts").glob("*.nc")):
            raise KeyboardInterrupt

    conduct(asked, tmp_path / "one")
    with pytest.raises(KeyboardInterrupt):
        conduct(asked, tmp_path / "two", progress=stop, jobs=2)
    assert not multiprocessing.active_children()
    kept = list((tmp_path / "two" / "parts").glob("*.nc"))
    assert len(kept) == 1
    when = kept[0].stat().st_mtime_ns
    conduct(asked, tmp_path / "two", progress=lambda *said: told.append(said), jobs=2)
    assert kept[0].stat().st_mtime_ns == when  # not run again
    assert contents(tmp_path / "two") == contents(tmp_path / "one")
    assert told[-1][0].startswith("5 of 5 runs, ")
    assert told[-1][1] == 1.0


def test_no_process_and_processes_beside_a_cluster_are_refused(asked, tmp_path):
    with pytest.raises(OutsideLimits, match="a study in 0 processes cannot be; at least 1 is needed"):
        conduct(asked, tmp_path / "s", jobs=0)
    with pytest.raises(OutsideLimits, match="a cluster or 2 processes of this machine, not both"):
        conduct(asked, tmp_path / "s", client=object(), jobs=2)
    assert not (tmp_path / "s").exists()


def test_a_batch_whose_processes_die_is_told(asked, tmp_path, monkeypatch):
    monkeypatch.setattr(processes, "side_by_side", lambda *_, **__: (said for said in [(1, PieceCrash(-9))]))
    with pytest.raises(
        ProcessCrash, match="the process at batch 1 of study 'strokes' ended with exit code -9, 3 times"
    ):
        conduct(asked, tmp_path / "s", jobs=2)
