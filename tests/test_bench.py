"""Every bench runs, in its short form, and prints ratios; no test depends on what they are."""

import importlib.util
import os
import re
import shutil
from pathlib import Path

import pytest
from tests.laboratory.page_modules import engine_folder

ROOT = Path(__file__).parent.parent
BENCHES = {path.stem: path for path in sorted((ROOT / "bench").glob("bench_*.py"))}
RATIOS = {
    "bench_coupling": r"coupled [\d.]+ s in \d+ steps, \d+\.\d+ times",
    "bench_flow": r"an outline of its \d+ corners [\d.]+ ms: \d+\.\d+ times",
    "bench_kinematics": r"leg\.inverse .* \d+\.\d+ of leg\.forward",
    "bench_lake": r"swimming +\d+ +\d+\.\d+",
    "bench_pictures": r"\d+ pictures/s, each as long as +\d+\.\d steps",
    "bench_land": r"\d+ environments .* ratio \d+\.\d+",
    "bench_page": r"over that at full speed: ratio \d+\.\d+",
    "bench_portable": r"of processor time: ratio \d+\.\d+",
    "bench_study": r"beside the bare physics \d+\.\d+",
    "bench_wet": r"wading +[\d.]+ +ratio \d+\.\d+",
}
"""How a bench prints a ratio; that of a card prints one only where there is a card."""


@pytest.fixture
def run_bench(programs, tmp_path):
    def run(name, **environment):
        whole = os.environ | {"SUCHUS_BENCH": "short"} | environment
        return programs.run([BENCHES[name]], cwd=tmp_path, environment=whole)

    return run


def test_every_bench_but_that_of_a_card_has_a_ratio():
    assert {*RATIOS, "bench_gpu"} == {*BENCHES}


def has_browser_and_engine():
    """Whether this machine can time the laboratory in one page."""
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    return bool(browser) and engine_folder() is not None and importlib.util.find_spec("playwright") is not None


@pytest.mark.parametrize("name", RATIOS)
def test_a_bench_prints_ratios(name, run_bench):
    if name == "bench_page" and not has_browser_and_engine():
        pytest.skip("chromium, playwright or the engine of the page is not on this machine")
    done = run_bench(name)
    assert done.returncode == 0, done.stderr
    assert re.search(RATIOS[name], done.stdout), done.stdout


def test_small_flows_are_compared_with_large_ones_and_in_lockstep(programs, tmp_path):
    environment = os.environ | {"SUCHUS_BENCH": "short"}
    done = programs.run([BENCHES["bench_flow"], "--small"], cwd=tmp_path, environment=environment)
    assert done.returncode == 0, done.stderr
    for ratio in (r"in lockstep \d+\.\d+ times as fast", r"have \d+\.\d+ of the rate", r"\d+\.\d+ of that with 6"):
        assert re.search(ratio, done.stdout), done.stdout


def test_the_bench_of_the_page_says_what_is_missing(run_bench, tmp_path):
    done = run_bench("bench_page", PATH=str(tmp_path), XDG_CACHE_HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    assert "is not timed" in done.stdout


def test_the_bench_of_a_card_says_that_there_is_none(run_bench):
    done = run_bench("bench_gpu", CUDA_VISIBLE_DEVICES="-1")
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("There is no card of NVIDIA that numba can use")
