"""A fingerprint of a setup: every value in it, down to what its functions compute with."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cached_property, partial
from hashlib import sha256
from numbers import Real
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType

import numpy as np


def fingerprint(setup: object) -> str:
    """Return what two simulations must share for one to go on from the other's checkpoint.

    Numbers count by their value (1 is 1.0), arrays by all of theirs, and a function by its code, its defaults and what
    it was made with. So a motion that is written anew in the same words is the same, and one with another amplitude is
    another.
    """
    digest = sha256()
    _Walk(digest.update).value(setup)
    return digest.hexdigest()


class _Walk:
    """Writes values as bytes that differ wherever the values do."""

    def __init__(self, write: Callable[[bytes], None]) -> None:
        self._write = write
        self._open: list[int] = []  # what is being written: a function may know itself

    def _word(self, kind: str, text: str | bytes = "") -> None:
        data = text.encode() if isinstance(text, str) else text
        self._write(f"{kind}:{len(data)}:".encode() + data)

    def value(self, value: object) -> None:
        """Write any value."""
        if id(value) in self._open:
            self._word("again", str(self._open.index(id(value))))
            return
        self._open.append(id(value))
        self._write_value(value)
        self._open.pop()

    def _write_value(self, value: object) -> None:
        if value is None or isinstance(value, bool | np.bool_ | str | bytes):
            self._word("plain", repr(value.item() if isinstance(value, np.bool_) else value))
        elif isinstance(value, Real):
            self._word("number", float(value).hex())
        elif isinstance(value, np.ndarray):
            self._word("array", f"{value.dtype.str}{value.shape}")
            self._word("numbers", np.ascontiguousarray(value).tobytes())
        elif is_dataclass(value) and not isinstance(value, type):
            self._parts(type(value).__qualname__, {f.name: getattr(value, f.name) for f in fields(value)})
        elif isinstance(value, dict):
            self._parts("dict", {repr(key): item for key, item in value.items()})
        elif isinstance(value, list | tuple | set | frozenset):
            items = sorted(value, key=repr) if isinstance(value, set | frozenset) else value
            self._parts(type(value).__name__, {str(k): item for k, item in enumerate(items)})
        else:
            self._behaviour(value)

    def _parts(self, kind: str, parts: dict[str, object]) -> None:
        self._word(kind, str(len(parts)))
        for name, part in parts.items():
            self._word("name", name)
            self.value(part)

    def _behaviour(self, value: object) -> None:
        if isinstance(value, FunctionType):
            cells = [cell.cell_contents for cell in value.__closure__ or ()]
            names = _names(value.__code__)
            known = {name: value.__globals__[name] for name in names if name in value.__globals__}
            own = {name: item for name, item in known.items() if _decides(item, value.__module__)}
            self._code(value.__code__)
            self._parts("function", {"with": cells, "or": value.__defaults__, "and": value.__kwdefaults__, "of": own})
        elif isinstance(value, MethodType):
            self._parts("method", {"of": value.__self__, "is": value.__func__})
        elif isinstance(value, partial):
            self._parts("partial", {"is": value.func, "with": value.args, "and": value.keywords})
        elif isinstance(value, type | BuiltinFunctionType | ModuleType | np.ufunc):
            self._word("named", f"{getattr(value, '__module__', '')}.{value.__name__}")
        else:
            own = {name: getattr(value, name) for name in getattr(type(value), "__slots__", ()) if hasattr(value, name)}
            kept = {
                name: part for name, part in getattr(value, "__dict__", {}).items()
                if not isinstance(getattr(type(value), name, None), cached_property)  # filled in as it is asked for
            }  # fmt: skip
            self._parts(type(value).__qualname__, {**own, **kept})

    def _code(self, code: CodeType) -> None:
        self._word("code", code.co_code)
        self._word("names", " ".join((*code.co_names, *code.co_varnames, *code.co_freevars)))
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                self._code(constant)
            else:
                self.value(constant)


def _names(code: CodeType) -> list[str]:
    """Return the names that a function looks up, and those that functions inside it do."""
    inner = [name for part in code.co_consts if isinstance(part, CodeType) for name in _names(part)]
    return sorted({*code.co_names, *inner})


def _decides(value: object, module: str) -> bool:
    """Return whether a global that a function reads is a part of what it does: a value, or a function beside it."""
    if isinstance(value, FunctionType):
        return value.__module__ == module
    return isinstance(value, Real | str | tuple | list | dict | np.ndarray) or (
        is_dataclass(value) and not isinstance(value, type)
    )
