import threading
from types import SimpleNamespace

import pytest

import busy_threads
from suchus.core import threads
from suchus.core.errors import OutsideLimits


def test_threads_follow_the_environment(monkeypatch):
    monkeypatch.setenv("SUCHUS_THREADS", "3")
    assert threads.count() == 3


@pytest.mark.parametrize("bad", ["0", "-1", "two", "1.5", ""])
def test_a_bad_number_of_threads_is_a_sentence(monkeypatch, bad):
    monkeypatch.setenv("SUCHUS_THREADS", bad)
    with pytest.raises(OutsideLimits, match="whole number of at least 1"):
        threads.count()


def test_default_is_the_cores_of_this_process(monkeypatch):
    monkeypatch.delenv("SUCHUS_THREADS", raising=False)
    assert threads.count() >= 1


@pytest.mark.parametrize(("fractions", "is_busy"), [([1.0] * 10, True), ([0.0], False), ([1.0] * 9 + [0.2], False)])
def test_a_thread_that_computes_on_is_named_and_one_that_ends_soon_is_not(fractions, is_busy, monkeypatch):
    done, spent = threading.Event(), [0.0]
    looks = iter(fractions)
    monkeypatch.setattr(
        busy_threads,
        "time",
        SimpleNamespace(
            process_time=lambda: spent[0], sleep=lambda time: spent.append(spent.pop() + next(looks) * time)
        ),
    )
    thread = threading.Thread(target=done.wait, name="on and on")
    thread.start()
    assert ("on and on" in busy_threads.busy_threads()) == is_busy
    done.set()
    thread.join()
