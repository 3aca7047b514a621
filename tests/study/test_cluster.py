"""A study on a cluster: the same bytes, also when a worker is killed."""

import os
import signal
import warnings

import pytest

from suchus.cli import main
from suchus.land import Run
from suchus.study import NoCluster, Study, Vary, conduct, connected

pytestmark = pytest.mark.filterwarnings("default")  # Dask's own


@pytest.fixture
def asked(robot, crawl_gait):
    return Study(
        name="spread",
        run=Run(robot=robot, gait=crawl_gait, noise=0.01),
        vary=(Vary(field="gait.hip_height", values=(0.088, 0.09, 0.3)),),
        measure=("displacement",),
        seeds=4,
        chunk=1,
        duration=2.0,
    )


@pytest.fixture
def cluster():
    distributed = pytest.importorskip("distributed", reason="Dask is not installed: pip install suchus[cluster]")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        )
    with made:
        yield made


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_two_workers_one_of_them_killed_give_the_same_bytes(asked, cluster, tmp_path):
    killed = []

    def kill_one(told):
        if told.done >= 2 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    with connected(cluster.scheduler_address) as client:
        spread = conduct(asked, tmp_path / "spread", progress=kill_one, client=client)
    assert killed
    assert killed[0] != os.getpid()
    assert int((spread.error != "").sum()) == 4
    conduct(asked, tmp_path / "here")
    assert contents(tmp_path / "spread") == contents(tmp_path / "here")


def test_a_scheduler_that_is_not_there_is_a_sentence(asked, tmp_path):
    pytest.importorskip("distributed", reason="Dask is not installed: pip install suchus[cluster]")
    with (
        pytest.raises(NoCluster, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"),
        connected("tcp://127.0.0.1:9", patience=0.5),
    ):
        pass


def test_without_dask_the_sentence_says_how_to_install_it(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    page = tmp_path / "s.toml"
    page.write_text('measure = ["slip"]\n[[vary]]\nfield = "ground.grip"\nvalues = [1.0]\n')
    assert main(["study", str(page), "--scheduler", "tcp://127.0.0.1:9", "--out", str(tmp_path / "s")]) == 2
    assert "pip install 'suchus[cluster]'" in capsys.readouterr().err
    assert not (tmp_path / "s").exists()
