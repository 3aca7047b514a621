"""The same bytes from kernels that were just compiled, from those of the cache, and from some of each."""

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.registry import cpu_target

from suchus.flow import compiled, linking

FEW = """
import hashlib, numba, numpy as np
from suchus.flow import farfield, project
random = np.random.default_rng(3)
u, v, source = (random.standard_normal((68, 100)).astype(np.float32) for _ in range(3))
block, x, y = np.zeros((4, 8, 12)), 8 * np.arange(12) + 3.5, 8 * np.arange(8) + 3.5
points, weights, signs = random.random((2, 70)), random.random((4, 50)), np.ones(50)
face_points, none, window = random.integers(0, 140, (4, 50)), np.zeros((0, 12)), np.array([20, 40, 30, 60])
where, inner = np.array([0, 64, 96, 20, 40, 30, 60]), (np.uint64(1),)
for threads in (1, 2):
    numba.set_num_threads(threads)
    r, sums, out = np.zeros_like(u), np.zeros((68, 4)), np.zeros(50)
    project.residual(r, np.stack([u, v]), source, np.ones_like(u), where, where, inner, (False, False), sums)
    farfield.induce(
        u, v, window, block, x, y, np.zeros((0, 2), int), none, none, points, face_points, weights, signs, out
    )
    print(hashlib.sha256(r.tobytes() + sums.tobytes() + out.tobytes()).hexdigest())
print(project.residual.stats.cache_misses and "compiled" or "loaded")
print(farfield.induce.stats.cache_misses and "compiled" or "loaded")
"""
"""Two kernels, of those that once differed."""

WHOLE = """
import hashlib, numpy as np
from flow_cases import eel_setup
from suchus import flow
for threads in (1, 2):
    sim = flow.Simulation(eel_setup(), thread_count=threads)
    sim.run(0.1, progress=False)
    print(hashlib.sha256(sim.water.u.tobytes() + sim.record.bodies.tobytes()).hexdigest())
"""
"""A free eel, which takes nearly all kernels."""


def told(script, cache):
    """What a process of its own says, with a cache folder of its own."""
    here = Path(__file__).parent
    paths = os.pathsep.join(
        [str(Path(linking.__file__).parents[2]), str(here), *filter(None, [os.environ.get("PYTHONPATH")])]
    )
    env = {**os.environ, "NUMBA_CACHE_DIR": str(cache), "NUMBA_NUM_THREADS": "2", "PYTHONPATH": paths}
    return subprocess.run(
        [sys.executable, "-c", script], env=env, capture_output=True, text=True, check=True
    ).stdout.split()  # fmt: skip


def forget(cache, kernel):
    """Take a kernel out of a cache folder."""
    files = [f for f in Path(cache).rglob("*.nb*") if f".{kernel}-" in f".{f.name}"]
    assert files
    for file in files:
        file.unlink()


@pytest.mark.slow("kernels are compiled anew, and run a second and a third time")
def test_the_same_bytes_cold_warm_partly_warm_and_on_two_threads(tmp_path):
    cold, warm = told(FEW, tmp_path), told(FEW, tmp_path)
    forget(tmp_path, "project.residual")
    partly = told(FEW, tmp_path)
    assert (cold[2:], warm[2:], partly[2:]) == (["compiled"] * 2, ["loaded"] * 2, ["compiled", "loaded"])
    assert len({*cold[:2], *warm[:2], *partly[:2]}) == 1


@pytest.mark.validate
def test_the_same_bytes_of_a_whole_flow(tmp_path):
    cold, warm = told(WHOLE, tmp_path), told(WHOLE, tmp_path)
    for kernel in ("poisson.solve", "immerse.immerse", "paint.section_motions"):
        forget(tmp_path, kernel)
    assert len({*cold, *warm, *told(WHOLE, tmp_path)}) == 1


def test_numba_has_the_names_that_linking_needs():
    assert linking.missing() == []
    assert linking.options() == {"pipeline_class": linking.KernelCompiler}


def test_a_name_that_is_gone_is_missed(monkeypatch):
    monkeypatch.setattr(linking, "_REQUIRED_NAMES", (*linking._REQUIRED_NAMES, "_no_such_name"))
    assert linking.missing() == ["_no_such_name"]
    assert linking.options() == {}  # as numba does it


def test_numba_stays_as_it_is():
    assert type(cpu_target.target_context.codegen()) is JITCPUCodegen
    assert JITCPUCodegen._library_class is JITCodeLibrary

    @numba.njit
    def inner(x):
        return x + 1

    @numba.njit
    def outer(x):
        return 2 * inner(x)

    assert outer(3) == 8
    assert inner(3) == 4
    assert type(outer.overloads[outer.signatures[0]].library) is JITCodeLibrary


def test_a_function_of_this_room_is_put_together_here():
    @numba.njit(**linking.options())
    def twice(x):
        return 2 * x

    assert twice(3) == 6
    assert type(twice.overloads[twice.signatures[0]].library) is linking.Library


def test_a_part_is_compiled_once_whatever_whole_numbers_it_is_called_with():
    @compiled.kernel_part
    def raised(x, n):
        return x**n

    @numba.njit
    def powers(x, n):
        return raised(x, 2), raised(x, 3), raised(x, n)

    assert powers(2.0, 4) == (4.0, 8.0, 16.0)
    assert len(raised._compiled.signatures) == 1


def test_a_part_called_from_python_is_plain_python():
    @compiled.kernel_part
    def half(x):
        return x / 2

    assert half(3.0) == 1.5
    assert half.py_func(3.0) == 1.5
