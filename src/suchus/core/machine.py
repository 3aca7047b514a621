"""What of a machine decides the last bits of a number, and how to compute the same bits on every one of a kind.

The same program gives other last bits on another processor where a library has several routines for one function and
takes what is fastest there: the C library's mathematical functions with and without fused multiply-add, NumPy's with
wider vectors, the kernels of the linear algebra. ``arithmetic`` says how this process computes, by computing; what has
the same arithmetic gives the same bytes. ``PORTABLE`` are the settings with which each library takes the routines that
every processor of an architecture has.
"""

import hashlib
import math
import os
import platform
import struct
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

import numpy as np

from suchus.core import threads
from suchus.core.errors import OutsideLimits

PORTABLE_VARIABLE = "SUCHUS_PORTABLE"
"""Environment variable: 1 asks for the routines that every processor of this architecture has."""
PORTABLE: Mapping[str, str] = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",  # of NumPy's own choice; its least is X86_V2
    "OPENBLAS_CORETYPE": "Nehalem",
    "NUMBA_CPU_NAME": "x86-64-v2",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX_Fast_Unaligned_Load",
}
"""What the environment of a portable process says, on x86-64 with the GNU C library. Libraries read these when the
process starts, and so a process that wants them is begun with them, see ``portable_environment``."""
_POINTS = 2048
_mixing: ContextVar[bool] = ContextVar("mixing", default=False)


@contextmanager
def mixing() -> Iterator[None]:
    """While the block runs, let stores be continued that a machine with another arithmetic began; they say so then."""
    token = _mixing.set(True)
    try:
        yield
    finally:
        _mixing.reset(token)


def asked_to_mix() -> bool:
    """Return whether ``mixing`` is asked for."""
    return _mixing.get()


@cache
def arithmetic() -> dict[str, str]:
    """Return how this process computes: by part, the first 12 digits of the SHA-256 of what it makes of fixed numbers.

    The parts are the C library's functions, which MuJoCo calls too, NumPy's over whole arrays, and its linear algebra.
    """
    return {
        "C library": _digest(_of_the_c_library()),
        "NumPy's functions": _digest(array.tobytes() for array in _of_numpy()),
        "linear algebra": _digest(array.tobytes() for array in _of_linear_algebra()),
    }


@cache
def describe() -> dict[str, str]:
    """Return a description of this machine for people: processor, vector instructions, kernels, threads."""
    numpy_config = np.show_config(mode="dicts")
    blas = numpy_config["Build Dependencies"]["blas"]
    kernels = os.environ.get("OPENBLAS_CORETYPE", "of its own choice")
    return {
        "processor": _processor(),
        "architecture": platform.machine(),
        "vector instructions": " ".join(numpy_config["SIMD Extensions"].get("found", [])) or "the least",
        "linear algebra": f"{blas['name']} {blas['version']}, kernels {kernels}",
        "C library": " ".join(platform.libc_ver()).strip() or sys.platform,
        "threads": str(threads.count()),
        "portable": "yes" if is_portable() else "no",
    }


def provenance() -> dict[str, dict[str, str]]:
    """Return what results say of the machine that made them."""
    return {"arithmetic": arithmetic(), "described": describe()}


def differences(other_arithmetic: Mapping[str, str]) -> list[str]:
    """Return the components of ``arithmetic`` in which another machine differs.

    Args:
        other_arithmetic: the other machine's ``arithmetic``; a missing component counts as different.
    """
    return [component for component, digest in arithmetic().items() if other_arithmetic.get(component) != digest]


def is_portable() -> bool:
    """Return whether this process was begun with the settings of ``PORTABLE``."""
    return all(os.environ.get(name) == value for name, value in PORTABLE.items())


def portable_environment(environment: Mapping[str, str]) -> dict[str, str] | None:
    """Return the environment with which a process that asks for portable arithmetic must be restarted.

    Args:
        environment: environment of this process.

    Returns:
        None where nobody asks for it, or where it is so already.

    Raises:
        OutsideLimits: there are no such settings for this kind of machine, or it is asked for in another word than 1.
    """
    setting = environment.get(PORTABLE_VARIABLE, "")
    if setting in ("", "0"):
        return None
    if setting != "1":
        raise OutsideLimits(
            f"{PORTABLE_VARIABLE} is {setting!r}; 1 asks for portable arithmetic, 0 or nothing for the fastest."
        )
    if (platform.machine(), platform.libc_ver()[0]) != ("x86_64", "glibc"):
        raise OutsideLimits(
            f"{PORTABLE_VARIABLE} is for x86-64 with the GNU C library, and this is {platform.machine()} with "
            f"{platform.libc_ver()[0] or 'another C library'}; leave it away, and compare results of machines of one "
            "kind."
        )
    if all(environment.get(name) == value for name, value in PORTABLE.items()):
        return None
    return {**environment, **PORTABLE}


def _digest(chunks: Iterator[bytes]) -> str:
    text = hashlib.sha256()
    for chunk in chunks:
        text.update(chunk)
    return text.hexdigest()[:12]


def _points() -> list[float]:
    """Return pseudo-random numbers in -1..1 that are the same bits on every machine."""
    points, state = [], 12345
    for _ in range(_POINTS):
        state = (state * 1103515245 + 12345) % 2**31
        points.append(state / 2**30 - 1.0)
    return points


def _of_the_c_library() -> Iterator[bytes]:
    """Yield the bytes of the C library's functions at fixed points."""
    for function in (math.sin, math.cos, math.tan, math.exp, math.tanh, math.atan, math.asin):
        yield struct.pack(f"{_POINTS}d", *(function(x) for x in _points()))
    yield struct.pack(f"{_POINTS}d", *(math.log(2.0 + x) for x in _points()))
    yield struct.pack(f"{_POINTS}d", *(math.pow(2.0 + x, 1.7 * x) for x in _points()))
    yield struct.pack(f"{_POINTS}d", *(math.atan2(x, 0.3 - x) for x in _points()))


def _of_numpy() -> Iterator[np.ndarray]:
    """Yield NumPy's functions and sums over fixed points, in double and in single precision."""
    x = np.array(_points())
    for array in (x, x.astype(np.float32)):
        yield from (f(array) for f in (np.sin, np.cos, np.tan, np.exp, np.tanh, np.arctan, np.sinh))
        yield from (
            np.log(array + 2),
            np.power(array + 2, array),
            np.arctan2(array, 1 - array),
            np.hypot(array, 1 - array),
        )
        yield from (array.sum()[None], array.mean()[None], array.std()[None], np.cumsum(array), np.sqrt(array + 1))


def _of_linear_algebra() -> Iterator[np.ndarray]:
    """Yield products, factorisations and eigenvalues of fixed small matrices."""
    x = np.array(_points())
    for n in (3, 7, 19, 40):  # small enough for one thread, whatever their number
        a = x[: n * n].reshape(n, n)
        spd = a @ a.T + n * np.eye(n)
        yield from (a @ a, a @ a[0], np.dot(a[0], a[1])[None], np.linalg.solve(spd, a), np.linalg.cholesky(spd))
        yield from (np.linalg.eigvalsh(spd), np.linalg.svd(a, compute_uv=False), np.einsum("ij,kj->ik", a, spd))


def _processor() -> str:
    """Return the name of the processor, as the operating system reports it."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as cpuinfo:  # noqa: PTH123  no file of ours
            names = [line.partition(":")[2].strip() for line in cpuinfo if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or "unknown"
