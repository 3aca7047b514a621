"""The one place that knows how the flow kernels are compiled.

Row kernels take whole arrays and the numbers of rows and columns, which they make ``unsigned``: an index such as
``i - 1`` of a signed ``i`` may be negative to the compiler, which then guards every access and does not vectorise (13
times slower). A row cut out of an array beforehand costs 15 ns for the counting of its references, which with ten of
them is as much as the work on 512 cells. Threads share rows in blocks of ``BLOCK``; a sum is kept per row and added up
in order, so that the same bytes come out on any number of threads.
"""

import gc
import re
import sys
from collections.abc import Callable
from pathlib import Path
from time import monotonic
from types import FunctionType
from typing import Any, Generic, ParamSpec, TypeVar

import numba
import numpy as np
from numba.core import event
from numba.extending import models, register_model

from suchus.core import kernel_cache
from suchus.flow import linking

P = ParamSpec("P")
R = TypeVar("R")

BLOCK = 32
"""Rows that one thread takes at a time [-]."""

SERIAL_BELOW = 4_096
"""Levels with fewer cells than this run on one thread: starting threads would take longer [-]."""

PAD = 2
"""Rows and columns around the domain, for the boundary values [-]."""

unsigned = np.uint64
"""Type of row and column indices in the kernels."""

signed = np.int64
"""Type of the index of a ``prange`` loop in the kernels. numba counts in different types with and without threads, and
the parts would be compiled for both."""

UNIT = unsigned(1)
"""One, in the type of the indices: with a signed one, row numbers would become floats [-]."""

Window = tuple[int, ...]
"""Padded cell indices around the bodies, first and end along each axis, the last axis first."""

# No "nnan" and no "ninf": a NaN must stay visible.
_FAST = {"contract", "reassoc", "nsz", "arcp"}

_OPTIONS = {"fastmath": _FAST, "error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True, **linking.options()}

_SOURCE_FOLDER = Path(__file__).parent
_MAKERS = re.compile(
    r"^from suchus\.flow\.compiled import (?:\([^)]*?|[^(\n]*?)"
    r"\b(?:compiled|threaded|kernel_part|ordered_part|threaded_part)\b",
    re.M,
)
_BASE_FILES = ("compiled.py", "linking.py")


def folder() -> Path | None:
    """Return where the code of these sources is kept; None where no place can be written to."""
    return kernel_cache.folder(_SOURCE_FOLDER, kernel_files(), "kernels-")


def kernel_files() -> list[Path]:
    """Return the files of this package that hold kernels or parts of them, and those that say how they are compiled."""
    files = sorted(_SOURCE_FOLDER.glob("*.py"))
    return [file for file in files if file.name in _BASE_FILES or _MAKERS.search(file.read_text(encoding="utf-8"))]


FOLDER = folder()
"""Where the machine code is kept between runs; None where no place can be written to."""


class _Notice(event.Listener):  # type: ignore[misc]
    """Prints on the error stream that kernels are being compiled, once compilation has taken ``DELAY``.

    Meanwhile garbage is not collected: a compiler keeps what it makes, and looking for it takes a sixth of the time.
    """

    DELAY = 2.0  # [s]

    def __init__(self) -> None:
        self._open, self._since, self._compile_time, self._is_printed = 0, 0.0, 0.0, False
        self._collects_garbage = False

    def on_start(self, compilation: event.Event) -> None:
        """Store the time at which a compilation starts."""
        if compilation.data["dispatcher"].py_func.__module__.startswith(__package__ or ""):
            if self._open == 0:
                self._since, self._collects_garbage = monotonic(), gc.isenabled()
                gc.disable()
            if not self._is_printed and self._compile_time > self.DELAY:
                self._is_printed = True
                print(
                    "Compiling the flow solver for this machine: once for each precision in plane and space ...",
                    file=sys.stderr, flush=True,
                )  # fmt: skip
            self._open += 1

    def on_end(self, compilation: event.Event) -> None:
        """Add the time of a compilation to the total."""
        if compilation.data["dispatcher"].py_func.__module__.startswith(__package__ or ""):
            self._open -= 1
            if self._open == 0:
                self._compile_time += monotonic() - self._since
                if self._collects_garbage:
                    gc.enable()


event.register("numba:compile", _Notice())


def _compile(function: Callable[P, R], parallel: bool, use_cache: bool = True) -> Callable[P, R]:
    kernel: Callable[P, R] = numba.njit(parallel=parallel, **_OPTIONS)(function)
    if use_cache and FOLDER is not None:  # else it is compiled anew every time
        kernel_cache.keep(kernel, FOLDER)
    return kernel


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function``; keep the code on disk (see ``suchus.core.kernel_cache``)."""
    return _compile(function, parallel=False)


def threaded(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function``, whose ``prange`` loops run on several threads."""
    return _compile(function, parallel=True)


def replace_threaded_parts(kernel: Any, **parts: Any) -> Any:
    """Compile a threaded kernel with other parts in place of those of its module; its code is not kept.

    Args:
        kernel: kernel that ``threaded`` made.
        parts: parts by the names that they have in the kernel's module.
    """
    return _compile(_rewritten(kernel.py_func, parts), parallel=True, use_cache=False)


def replace_kernel_parts(kernel_part: "KernelPart[P, R]", **parts: Any) -> "KernelPart[P, R]":
    """Return a part with other parts in place of those of its module; see ``replace_threaded_parts``."""
    return KernelPart(_rewritten(kernel_part.py_func, parts))


def _rewritten(function: Any, names: dict[str, Any]) -> Any:
    """Return a copy of a function for which some names of its module have other values."""
    function_copy = FunctionType(function.__code__, {**function.__globals__, **names}, function.__name__)
    function_copy.__module__, function_copy.__qualname__ = function.__module__, function.__qualname__
    return function_copy


class PartType(numba.types.Dispatcher):  # type: ignore[misc]
    """Type of a part in the kernels that call it.

    numba compiles a function once more for each constant that it is called with. Kernels take their parts in, and the
    constants with them, so for a part this changes nothing but the time that compiling takes: a third of it.
    """

    def get_call_type(self, context: Any, args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        """Return the signature of a call; a whole number that is written in it counts as any other."""
        return super().get_call_type(context, tuple(map(_any_number, args)), kws)


register_model(PartType)(models.OpaqueModel)


def _any_number(kind: Any) -> Any:
    return kind.literal_type if isinstance(kind, numba.types.IntegerLiteral) else kind


class KernelPart(Generic[P, R]):
    """A function that is compiled as a part of the kernels that call it; called from Python it is plain Python."""

    def __init__(self, function: Callable[P, R], *, parallel: bool = False, ordered: bool = False) -> None:
        self.py_func = function
        options = {**_OPTIONS, "fastmath": _FAST - {"reassoc"}} if ordered else _OPTIONS
        self._compiled = numba.njit(no_cpython_wrapper=True, parallel=parallel, **options)(function)
        self._numba_type_ = PartType(self._compiled)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Return what the function returns."""
        return self.py_func(*args, **kwargs)


def kernel_part(function: Callable[P, R]) -> KernelPart[P, R]:
    """Let the kernels that call ``function`` take it in."""
    return KernelPart(function)


def ordered_part(function: Callable[P, R]) -> KernelPart[P, R]:
    """Let the kernels that call ``function`` take it in; its sums are taken in the order in which they are written.

    For loops over cells with a sum over the axes: how the compiler orders it else hangs on when it unrolls the loop.
    """
    return KernelPart(function, ordered=True)


def threaded_part(function: Callable[P, R]) -> KernelPart[P, R]:
    """Let the kernels that call ``function`` take it in; its ``prange`` loops run on several threads."""
    return KernelPart(function, parallel=True)
