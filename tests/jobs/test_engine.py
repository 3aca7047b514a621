"""The engine: what is missing is done, once, kept as it comes, and the same wherever it is done."""

import threading
import time
from contextlib import closing

import pytest

from suchus.core import threads
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.jobs import (
    Cluster,
    InMemory,
    Job,
    PieceCrash,
    ProcessCrash,
    Processes,
    Tally,
    ThisProcess,
    finish,
    place_for,
)


def squared(item, progress):
    progress("squaring", 0.5)
    return item * item


def job(work=squared, items=(1, 2, 3, 4, 5), **more):
    return Job(name="squares", kind="sum", piece="term", unit="terms", work=work, items=items, **more)


def results(store, count=5):
    return [store.get(number) for number in range(count)]


class Written(InMemory):
    """Remembers in which order results were put."""

    def __init__(self):
        super().__init__()
        self.order = []

    def put(self, number, result):
        self.order.append(number)
        super().put(number, result)


@pytest.mark.parametrize("at_once", [1, 2, 3, 9])
def test_only_what_is_missing_is_done_and_all_is_told(at_once):
    store, told, each, finished = Written(), [], [], []
    store.put(1, 4)
    store.put(4, 25)
    finish(
        job(sizes=(1, 10, 2, 3, 4)),
        store,
        place=ThisProcess(at_once),
        progress=lambda *said: told.append(said),
        progress_of=lambda number: lambda stage, share: each.append((number, stage, share)),
        finished=lambda number, result: finished.append((number, result)),
    )
    assert results(store) == [1, 4, 9, 16, 25]
    assert sorted(store.order[2:]) == [0, 2, 3]
    assert sorted(finished) == [(0, 1), (2, 9), (3, 16)]
    assert sorted(each) == [(number, "squaring", 0.5) for number in (0, 2, 3)]
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert shares[0] >= 14.5 / 20  # what was there counts
    assert told[-1][0].startswith("20 of 20 terms, ")
    assert shares[-1] == 1.0


def test_pieces_side_by_side_share_the_threads_and_the_last_of_an_odd_number_has_all(monkeypatch):
    monkeypatch.setenv("SUCHUS_THREADS", "6")
    store = InMemory()
    finish(job(lambda item, _: threads.count()), store, place=ThisProcess(2))
    assert results(store) == [3, 3, 3, 3, 6]
    monkeypatch.setenv("SUCHUS_THREADS", "1")  # there is nothing to share
    finish(job(lambda item, _: threading.current_thread() is threading.main_thread()), other := InMemory(),
           place=ThisProcess(2))  # fmt: skip
    assert results(other) == [True] * 5


@pytest.mark.parametrize("at_once", [1, 2])
def test_an_error_ends_the_job_and_keeps_what_was_finished(at_once):
    def refusing(item, progress):
        if item == 4:
            raise InvalidDesign("no four.")
        return squared(item, progress)

    store, before = InMemory(), threading.active_count()
    with pytest.raises(InvalidDesign, match="no four"):
        finish(job(refusing), store, place=ThisProcess(at_once))
    assert store.get(0) == 1
    assert not store.has(3)
    assert threading.active_count() == before


def test_ctrl_c_ends_threads_in_the_middle_of_their_pieces():
    """A piece is left at the next word that it says of its progress, whatever errors it catches."""

    caught = []

    def endless(item, progress):
        while not caught:
            time.sleep(0.001)
            try:
                progress("waiting", 0.1)
            except Exception as error:
                caught.append(error)

    def stop(stage, share):
        raise KeyboardInterrupt

    before = threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        finish(job(endless), InMemory(), place=ThisProcess(2), progress=stop)
    assert threading.active_count() == before
    assert caught == []


class Deadly:
    """A place at which the process of every piece dies."""

    at_once = 1

    def results(self, job, items, begun):
        yield from ((number, PieceCrash(-9)) for number in range(len(items)))


def test_the_result_of_a_piece_whose_processes_died_is_what_the_job_says_or_the_end():
    with pytest.raises(
        ProcessCrash, match="the process at term 0 of sum 'squares' ended with exit code -9, 3 times; what was finished"
    ):
        finish(job(), InMemory(), place=Deadly())
    store = InMemory()
    finish(job(died=lambda item, code: (item, code)), store, place=Deadly())
    assert results(store) == [(item, -9) for item in (1, 2, 3, 4, 5)]


def test_a_place_is_this_machine_some_processes_of_it_or_a_cluster():
    client = object()
    assert place_for("a sum") == ThisProcess(1)
    assert place_for("a sum", local_place=ThisProcess(2)) == ThisProcess(2)
    assert place_for("a sum", jobs=3) == Processes(3)
    assert place_for("a sum", jobs=3, threads_per_process=1) == Processes(3, each=1)
    assert place_for("a sum", client=client) == Cluster(client)
    with pytest.raises(OutsideLimits, match="a sum in 0 processes cannot be; at least 1 is needed"):
        place_for("a sum", jobs=0)
    with pytest.raises(OutsideLimits, match="a sum takes a cluster or 2 processes of this machine, not both"):
        place_for("a sum", client=client, jobs=2)


def test_a_tally_tells_count_rate_time_left_failures_and_more(monkeypatch):
    now = [100.0]
    monkeypatch.setattr("suchus.core.jobs.engine.time.perf_counter", lambda: now[0])
    told = []
    tally = Tally(20, "runs", lambda *said: told.append(said), done_units=4, failed=1)
    tally.finished(0, 2, fresh=False)  # of an earlier start: it says nothing of the rate
    assert told[-1] == ("6 of 20 runs, 1 failed", 0.3)
    now[0] = 102.0
    tally.under_way(1, 3.5)
    assert told[-1] == ("9 of 20 runs, 1.8/s, 6 s left, 1 failed", 0.475)
    tally.note = "best 3 m"
    tally.finished(1, 4, failed=2)
    assert told[-1] == ("10 of 20 runs, 2.0/s, 5 s left, 3 failed, best 3 m", 0.5)
    now[0] = 20_100.0
    tally.finished(2, 1)
    assert told[-1] == ("11 of 20 runs, 0.9/h, 10.0 h left, 3 failed, best 3 m", 0.55)


def test_results_come_one_after_the_other_where_one_is_done_at_once():
    with closing(ThisProcess(1).results(job(), [1, 2], lambda i: lambda *_: None)) as coming:
        assert list(coming) == [(0, 1), (1, 4)]
