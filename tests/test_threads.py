import pytest

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
