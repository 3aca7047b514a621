"""How the machine code of kernels is put together: each kernel whole, and from its own parts.

numba compiles a function that a kernel calls by itself, links a copy into the kernel, optimises the whole once more and
leaves the copy a *weak* symbol. A process that has just compiled both runs the first one, a process that loads the
kernel from the cache runs the copy. With sums that may be reordered the two differ in their last bits, and a first run
differs from the second. Here the copies belong to their kernel alone, so that a kernel's bytes are those of its object
file, however it came to be. And since what a kernel calls is never run by itself, it is neither optimised nor emitted
by itself, which saves a quarter of the time that compiling takes.

numba itself stays as it is: ``KernelCompiler`` is handed to ``numba.njit`` as the ``pipeline_class`` of this room's
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

OURS = "_ZN6suchus4flow"
"""How the names of this room's functions begin in machine code."""

LOOP = "__numba_parfor_gufunc"
"""What the names of the loops that run on threads contain."""

_NEEDED = (
    "_optimize_final_module", "_finalize_final_module", "_finalize_dynamic_globals", "_verify_declare_only_symbols",
    "_get_module_for_linking",
)  # fmt: skip


class Library(JITCodeLibrary):  # type: ignore[misc]
    """The code of one function, and of all that it calls."""

    def _is_part(self) -> bool:
        """Return whether the code is this room's, and is only ever called by other compiled code."""
        roots = [f.name for f in self._defined() if f.linkage == binding.Linkage.external]
        return self._is_ours() and all(name.startswith(OURS) or LOOP in name for name in roots)

    def _is_ours(self) -> bool:
        return any(f.name.startswith(OURS) for f in self._defined())

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
    """Makes the libraries of this room's functions."""

    _library_class = Library

    def set_env(self, env_name: str, env: Any) -> None:
        """Set the environment of a function; that of a part, which is nowhere by itself, is none of its own."""
        if self._engine.is_symbol_defined(env_name):
            super().set_env(env_name, env)


class KernelCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, which puts the code of a function together as ``Library`` does."""

    def __init__(self, typingctx: Any, targetctx: BaseContext, *args: Any) -> None:
        super().__init__(typingctx, _linked_here(targetctx), *args)


@cache
def _linked_here(context: BaseContext) -> BaseContext:
    """Return a target that is as another one, but for the ``Codegen``."""
    return context.subtarget(_internal_codegen=Codegen("suchus.flow"))


def missing() -> list[str]:
    """Return the names that ``Library`` and ``KernelCompiler`` need of numba and that are not there."""
    lacking = [name for name in _NEEDED if not hasattr(JITCodeLibrary, name)]
    lacking += [] if hasattr(JITCPUCodegen, "_library_class") else ["_library_class"]
    return lacking + ([] if hasattr(cpu_target.target_context, "_internal_codegen") else ["_internal_codegen"])


def options() -> dict[str, Any]:
    """Return what ``numba.njit`` takes to compile a function so; nothing where numba lacks what that needs."""
    return {} if missing() else {"pipeline_class": KernelCompiler}
