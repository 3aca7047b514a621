"""Pieces of work in processes: all of them come, in any order, whoever dies or is stopped."""

import os
import signal
import time
import warnings
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from suchus.core.errors import Doubtful, OutsideLimits
from suchus.core.jobs import PieceCrash
from suchus.core.jobs.processes import PieceProgress, PieceResult, PieceStarted, dismiss, hire, side_by_side


def squared(item, tell):
    tell("squaring", 0.5)
    warnings.warn(Doubtful(f"{item} is odd", kind="odd", size=item) if item % 2 else f"{item} is even", stacklevel=1)
    return item * item


def threads_of(item, tell):
    return os.environ["SUCHUS_THREADS"]


def refused(item, tell):
    raise OutsideLimits(f"{item} is too much.")


def deadly(item, tell, folder: Path, deaths: int):
    """Kill the process at the item 1, as often as is said, and leave a file for each time."""
    if item == 1 and len(list(folder.iterdir())) < deaths:
        (folder / str(os.getpid())).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return item


def endless(item, tell, folder: Path):
    (folder / str(os.getpid())).touch()
    time.sleep(60.0)


def test_every_piece_is_begun_in_order_and_done_and_what_it_warns_of_is_said_here():
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        heard = list(side_by_side(squared, [1, 2, 3, 4, 5], 2))
    assert sorted(str(one.message) for one in told) == ["1 is odd", "2 is even", "3 is odd", "4 is even", "5 is odd"]
    assert {one.message.size for one in told if isinstance(one.message, Doubtful)} == {1, 3, 5}
    assert {i: said.value for i, said in heard if isinstance(said, PieceResult)} == {0: 1, 1: 4, 2: 9, 3: 16, 4: 25}
    assert [i for i, said in heard if isinstance(said, PieceStarted)] == [0, 1, 2, 3, 4]
    assert PieceProgress("squaring", 0.5) in [said for _, said in heard]
    assert list(side_by_side(squared, [], 2)) == []


def test_processes_share_the_threads(monkeypatch):
    monkeypatch.setenv("SUCHUS_THREADS", "5")
    heard = side_by_side(threads_of, [0, 1], 2)
    assert [said.value for _, said in heard if isinstance(said, PieceResult)] == ["2", "2"]
    heard = side_by_side(threads_of, [0], 2, threads_per_process=1)
    assert [said.value for _, said in heard if isinstance(said, PieceResult)] == ["1"]


def test_our_own_errors_come_back_and_end_it():
    with pytest.raises(OutsideLimits, match=r"^[78] is too much"):
        list(side_by_side(refused, [7, 8], 2))


@pytest.mark.battery("kills")
@pytest.mark.slow("processes are killed")
@pytest.mark.parametrize(("deaths", "tries"), [(1, 1), (1, 2), (2, 2)])
def test_a_piece_whose_process_dies_is_begun_again_as_often_as_is_said(deaths, tries, tmp_path, counted):
    heard = list(side_by_side(partial(deadly, folder=tmp_path, deaths=deaths), [0, 1, 2], 2, tries=tries))
    counted(deaths)
    ends = {i: said for i, said in heard if isinstance(said, (PieceResult, PieceCrash))}
    assert ends[0] == PieceResult(0)
    assert ends[2] == PieceResult(2)
    assert ends[1] == (PieceResult(1) if deaths < tries else PieceCrash(-signal.SIGKILL))
    assert len([said for i, said in heard if i == 1 and isinstance(said, PieceStarted)]) == tries


def test_who_is_busy_when_it_is_stopped_is_ended(tmp_path):
    with closing(side_by_side(partial(endless, folder=tmp_path), [0], 1)) as heard:
        assert next(heard) == (0, PieceStarted())
        while not (started := list(tmp_path.iterdir())):
            time.sleep(0.02)
    with pytest.raises(ProcessLookupError):
        os.kill(int(started[0].name), 0)


@pytest.mark.slow("processes are stopped")
def test_no_process_hears_ctrl_c():
    """Not the first one either, with which Python starts a process of its own."""
    workers = [hire(squared, 1), hire(squared, 1)]
    for worker in workers:
        os.kill(worker.process.pid, signal.SIGINT)
    time.sleep(0.3)
    assert all(worker.process.is_alive() for worker in workers)
    dismiss(workers)
    assert [worker.process.exitcode for worker in workers] == [0, 0]
