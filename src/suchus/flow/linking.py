"""How the machine code of kernels is put together: each kernel whole, and from its own parts.

numba compiles a function that a kernel calls by itself, links a copy into the kernel, optimises the whole once more and
leaves the copy a *weak* symbol. A process that has just compiled both runs the first one, a process that loads the
kernel from the cache runs the copy. With sums that may be reordered the two differ in their last bits, and a first run
differs from the second. Here the copies belong to their kernel alone, so that a kernel's bytes are those of its object
file, however it came to be. And since what a kernel calls is never run by itself, it is neither optimised nor emitted
by itself, which is half of the time that compiling takes.

numba has no public door for this: ``Library`` overrides names that may change with any release. ``missing`` says which
are gone; then kernels are compiled as numba does it, and ``tests/flow/test_linking.py`` fails.
"""

import ctypes

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.registry import cpu_target

OURS = "_ZN6suchus4flow"
"""How the names of this room's functions begin in machine code."""

LOOP = "__numba_parfor_gufunc"
"""What the names of the loops that run on threads contain."""

_ENVIRONMENT = "_ZN08NumbaEnv"
_environments: list[ctypes.c_void_p] = []

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
        if self._is_part():
            self._finalize_dynamic_globals()
            self._verify_declare_only_symbols()
            engine = self._codegen._engine
            for variable in self._final_module.global_variables:
                if variable.name.startswith(_ENVIRONMENT) and not engine.is_symbol_defined(variable.name):
                    _environments.append(ctypes.c_void_p())
                    engine.add_global_mapping(variable, ctypes.addressof(_environments[-1]))
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


def missing() -> list[str]:
    """Return the names that ``Library`` needs of numba and that are not there."""
    codegen = cpu_target.target_context.codegen()
    return [name for name in _NEEDED if not hasattr(JITCodeLibrary, name)] + (
        [] if issubclass(Library, getattr(codegen, "_library_class", type(None))) else ["_library_class"]
    )


def install() -> None:
    """Compile this room's kernels so from now on; other functions are compiled as before."""
    if not missing():
        cpu_target.target_context.codegen()._library_class = Library
