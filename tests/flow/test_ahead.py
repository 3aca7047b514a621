"""The first compilation in two processes."""

import subprocess

import numba
import numpy as np
import pytest

from suchus.flow import ahead, compiled, poisson


class Other:
    """A process that only notes what happens to it."""

    def __init__(self, words, **settings):
        self.words, self.ended = words, []

    def __enter__(self):
        return self

    def __exit__(self, *what):
        self.ended.append("left")

    def wait(self):
        self.ended.append("waited for")

    def kill(self):
        self.ended.append("killed")


@pytest.fixture
def begun(monkeypatch, tmp_path):
    """The processes that are begun, on a machine with two threads and an empty cache."""
    others = []

    def popen(words, **settings):
        others.append(Other(words))
        return others[-1]

    monkeypatch.setenv("SUCHUS_THREADS", "2")
    monkeypatch.setattr(compiled, "FOLDER", tmp_path)
    monkeypatch.setattr(subprocess, "Popen", popen)
    return others


def test_the_solver_is_left_to_a_second_process_once(begun, monkeypatch):
    solved = []
    monkeypatch.setattr(poisson, "solve", lambda *given: solved.append(given))
    for _ in range(2):
        ahead.precompile(2, np.float32)
    assert len(begun) == 1
    assert "compile_solver(2, 'float32')" in begun[0].words[-1]
    assert begun[0].ended[0] == "waited for"
    assert not solved


def test_every_kind_of_grid_has_its_own_first_time(begun, monkeypatch):
    monkeypatch.setattr(ahead, "_step", lambda water: None)
    for axes, dtype in ((2, np.float32), (2, np.float64), (3, np.float32)):
        ahead.precompile(axes, dtype)
    assert len(begun) == 3


@pytest.mark.parametrize("why", ["one thread", "no place", "not compiled", "a place that takes nothing"])
def test_it_is_left_to_the_flow_where_it_would_not_help(begun, monkeypatch, tmp_path, why):
    if why == "one thread":
        monkeypatch.setenv("SUCHUS_THREADS", "1")
    elif why == "not compiled":
        monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    else:
        monkeypatch.setattr(compiled, "FOLDER", None if why == "no place" else tmp_path / "not there")
    ahead.precompile(2, np.float32)
    assert not begun


def test_ctrl_c_ends_the_other_process(begun, monkeypatch):
    def stopped(water):
        raise KeyboardInterrupt

    monkeypatch.setattr(ahead, "_step", stopped)
    with pytest.raises(KeyboardInterrupt):
        ahead.precompile(2, np.float32)
    assert begun[0].ended == ["killed", "left"]


def test_the_other_process_compiles_the_solver(begun, monkeypatch):
    """What it is told to run, with the cache of the tests."""
    monkeypatch.setattr(ahead, "_step", lambda water: None)
    ahead.precompile(2, np.float32)
    solved = []
    monkeypatch.setattr(poisson, "solve", lambda *given: solved.append(given) or (1, 0.0, 0.0, 0.0, 0.0))
    exec(begun[0].words[-1], {})
    assert len(solved) == 1
