"""How the kernel is compiled, and three numbers at a time: tuples, which need no memory of their own."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numba import njit

from suchus.core import kernel_cache

Vector = tuple[float, float, float]
"""Three numbers in the world."""
_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
"""Options of numba; products and sums may be computed in one instruction."""
P = ParamSpec("P")
R = TypeVar("R")
_SOURCES = Path(__file__).parent


def folder() -> Path | None:
    """Return where the code of these sources is kept; None where no place can be written to."""
    return kernel_cache.folder(_SOURCES, sorted(_SOURCES.glob("*.py")), "forces-")


FOLDER = folder()
"""Where the machine code is kept between runs; None where no place can be written to."""


def compile_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile what is called from outside; keep the code on disk (see ``suchus.core.kernel_cache``)."""
    kernel: Callable[P, R] = njit(**_OPTIONS)(function)
    if FOLDER is not None:  # else it is compiled anew every time
        kernel_cache.keep(kernel, FOLDER)
    return kernel


def compile_inline(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a part of these, which nothing else calls."""
    inline_options = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "forceinline": True}
    kernel: Callable[P, R] = njit(**_OPTIONS, **inline_options)(function)
    return kernel


@compile_inline
def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compile_inline
def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compile_inline
def plus(a: Vector, b: Vector) -> Vector:
    """Return the sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@compile_inline
def times(a: float, b: Vector) -> Vector:
    """Return a vector times a number."""
    return a * b[0], a * b[1], a * b[2]


@compile_inline
def blend(a: float, x: Vector, b: float, y: Vector, c: float, z: Vector) -> Vector:
    """Return a x + b y + c z."""
    return a * x[0] + b * y[0] + c * z[0], a * x[1] + b * y[1] + c * z[1], a * x[2] + b * y[2] + c * z[2]


@compile_inline
def three(values: np.ndarray, start: int) -> Vector:
    """Return three numbers of an array."""
    return values[start], values[start + 1], values[start + 2]


@compile_inline
def write(values: np.ndarray, start: int, three_: Vector) -> None:
    """Write three numbers into an array."""
    values[start], values[start + 1], values[start + 2] = three_


@compile_inline
def lane(rows: np.ndarray, row: int, column: int) -> Vector:
    """Return three numbers that stand below each other, from a row on."""
    return rows[row, column], rows[row + 1, column], rows[row + 2, column]


@compile_inline
def write_lane(rows: np.ndarray, row: int, column: int, values: Vector) -> None:
    """Write three numbers below each other, from a row on."""
    rows[row, column], rows[row + 1, column], rows[row + 2, column] = values


@compile_inline
def to_world(xmat: np.ndarray, values: np.ndarray, start: int) -> Vector:
    """Return three numbers of a row, a vector in the frame of a body, in the world."""
    v = three(values, start)
    return dot(three(xmat, 0), v), dot(three(xmat, 3), v), dot(three(xmat, 6), v)
