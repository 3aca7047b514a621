"""Linking of the machine code of kernels: each kernel is optimised as a whole and has its own copies of parts.

numba compiles a function that a kernel calls by itself, links a copy into the kernel, optimises the whole once more and
leaves the copy a *weak* symbol. A process that has just compiled both runs the first one, a process that loads the
kernel from the cache runs the copy. With sums that may be reordered the two differ in their last bits, and a first run
differs from the second. Here the copies belong to their kernel alone, so that a kernel's bytes are those of its object
file, however it came to be. And since what a kernel calls is never run by itself, it is neither optimised nor emitted
by itself, which saves a quarter of the time that compiling takes.

numba itself stays as it is: ``KernelCompiler`` is handed to ``numba.njit`` as the ``pipeline_class`` of this package's
functions, and compiles them with a ``Codegen`` of its own. What ``Library`` overrides is not public and may change with
any release. ``missing`` says which names are gone; then kernels are compiled as numba does it, and
``tests/flow/test_linking.py`` fails.
"""

from functools import cache
from typing import Any

from llvmlite import binding
from numba.core.base import BaseContext
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import Compiler
from numba.core.registry import cpu_target

SYMBOL_PREFIX = "_ZN6suchus4flow"
"""Prefix of the symbols of the functions of ``suchus.flow`` in machine code."""

LOOP = "__numba_parfor_gufunc"
"""Part of the symbols of loops that run on threads."""

_REQUIRED_NAMES = (
    "_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals", "_verify_declare_only_symbols",
    "_get_module_for_linking",
)  # fmt: skip


class Library(JITCodeLibrary):  # type: ignore[misc]
    """The code of one function, and of all that it calls."""

    def _is_part(self) -> bool:
        """Return whether the code belongs to ``suchus.flow`` and is called only by other compiled code."""
        roots = [f.name for f in self._defined() if f.linkage == binding.Linkage.external]
        return self._is_ours() and all(name.startswith(SYMBOL_PREFIX) or LOOP in name for name in roots)

    def _is_ours(self) -> bool:
        return any(f.name.startswith(SYMBOL_PREFIX) for f in self._defined())

    def _defined(self) -> list[binding.ValueRef]:
        return [f for f in self._final_module.functions if not f.is_declaration]

    def _optimize_final_module(self) -> None:
        if not self._is_part():
            super()._optimize_final_module()

    def _finalize_final_module(self) -> None:
        """Finish the code: a part is not emitted; in a kernel the copies of what it calls become its own."""
        if self._is_part():
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            self._finalized = True
            return
        if self._is_ours():
            self._finalized = True
            self._shared_module = self._get_module_for_linking()  # others link what they may drop, as ever
            if self._shared_module is self._final_module:
                self._shared_module = self._final_module.clone()
            self._finalized = False
            for function in self._defined():
                if function.linkage in (binding.Linkage.linkonce_odr, binding.Linkage.weak_odr):
                    function.linkage = binding.Linkage.internal
        super()._finalize_final_module()


class Codegen(JITCPUCodegen):  # type: ignore[misc]
    """Makes the libraries of the functions of ``suchus.flow``."""

    _library_class = Library

    def set_env(self, env_name: str, env: Any) -> None:
        """Set the environment of a function; a part is not emitted by itself and has none."""
        if self._engine.is_symbol_defined(env_name):
            super().set_env(env_name, env)


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, with ``Library`` for the code of a function."""

    def __init__(self, typingctx: Any, targetctx: BaseContext, *args: Any) -> None:
        super().__init__(typingctx, _linked_here(targetctx), *args)


@cache
def _linked_here(context: BaseContext) -> BaseContext:
    """Return a copy of a target with the ``Codegen`` of this module."""
    return context.subtarget(_internal_codegen=Codegen("suchus.flow"))


def missing() -> list[str]:
    """Return the names that ``Library`` and ``KernelCompiler`` need and that numba lacks."""
    lacking = [name for name in _REQUIRED_NAMES if not hasattr(JITCodeLibrary, name)]
    lacking += [] if hasattr(JITCPUCodegen, "_library_class") else ["_library_class"]
    return lacking + ([] if hasattr(cpu_target.target_context, "_internal_codegen") else ["_internal_codegen"])


def options() -> dict[str, Any]:
    """Return the options of ``numba.njit`` for this linking; none if numba lacks names that it needs."""
    return {} if missing() else {"pipeline_class": KernelCompiler}
