"""A fingerprint of a setup: every value in it, down to what its functions compute with."""

import csv
import sys
import sysconfig
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import cached_property, lru_cache, partial
from hashlib import sha256
from numbers import Real
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType

import numpy as np

FORMER_NAMES: dict[str, dict[str, str]] = {
    "BendingMap": {"map_to_rest": "back", "difference_time": "tick"},
    "Capsule": {"arc_position": "at"},
    "LinkPiece": {"position": "at", "quaternion": "turn"},
    "Setup": {"coarse_grid": "around"},
}
"""First name of each field that was renamed, by class.

Fingerprints are taken of the first name, so that checkpoints from before the change still match their setup."""


def fingerprint(setup: object) -> str:
    """Return what two simulations must share for one to go on from the other's checkpoint.

    Numbers count by their value (1 is 1.0), arrays by all of theirs, and a function by its code, its defaults, what
    it was made with, and the functions and classes that it calls, but for those of this package and of what is
    installed. So a motion that is written anew in the same words is the same, and one with another amplitude is
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
        self._digests: dict[int, tuple[object, bytes]] = {}  # functions and classes, which many others may know

    def _word(self, kind: str, text: str | bytes = "") -> None:
        data = text.encode() if isinstance(text, str) else text
        self._write(f"{kind}:{len(data)}:".encode() + data)

    def value(self, value: object) -> None:
        """Write any value."""
        if id(value) in self._open:
            self._word("again", str(self._open.index(id(value))))
            return
        self._open.append(id(value))
        if isinstance(value, FunctionType | type):
            self._word("known", self._digest(value))
        else:
            self._write_value(value)
        self._open.pop()

    def _digest(self, value: object) -> bytes:
        """Return the SHA-256 of a function or class; it is computed once in a walk."""
        if id(value) not in self._digests:
            outer, digest = self._write, sha256()
            self._write = digest.update
            self._write_value(value)
            self._write = outer
            self._digests[id(value)] = value, digest.digest()
        return self._digests[id(value)][1]

    def _write_value(self, value: object) -> None:
        """Write a value by its type; numbers by value, arrays by type, shape and bytes."""
        if value is None or isinstance(value, bool | np.bool_ | str | bytes):
            self._word("plain", repr(value.item() if isinstance(value, np.bool_) else value))
        elif isinstance(value, np.datetime64 | np.timedelta64):  # to NumPy a timedelta64 is a Real, without a float
            self._word("date", f"{value.dtype.str}{value.astype(np.int64)}")
        elif isinstance(value, Real):
            self._word("number", float(value).hex())
        elif isinstance(value, complex | np.complexfloating):
            self._word("complex", f"{float(value.real).hex()}{float(value.imag).hex()}")
        elif isinstance(value, np.ndarray) and value.dtype.hasobject:  # its bytes are addresses
            self._parts("objects", {"shape": value.shape, "items": value.tolist()})
        elif isinstance(value, np.ndarray):
            self._word("array", f"{value.dtype.str}{value.shape}")
            self._word("numbers", np.ascontiguousarray(value).tobytes())
        elif is_dataclass(value) and not isinstance(value, type):
            former_names = FORMER_NAMES.get(type(value).__qualname__, {})
            field_values = {former_names.get(f.name, f.name): getattr(value, f.name) for f in fields(value)}
            self._parts(type(value).__qualname__, {**field_values, **_class_of(value)})
        elif isinstance(value, dict):
            self._parts("dict", {repr(key): item for key, item in value.items()})
        elif isinstance(value, list | tuple | set | frozenset):
            items = sorted(value, key=repr) if isinstance(value, set | frozenset) else value
            self._parts(type(value).__name__, {str(k): item for k, item in enumerate(items)})
        else:
            self._behaviour(value)

    def _parts(self, kind: str, parts: dict[str, object]) -> None:
        self._word(kind, str(len(parts)))
        for name, value in parts.items():
            self._word("name", name)
            self.value(value)

    def _behaviour(self, value: object) -> None:
        """Write a function, class or object: its code, its defaults, and the values that it reads."""
        if isinstance(value, FunctionType):
            cells = [_python_function(cell.cell_contents) for cell in value.__closure__ or ()]
            names = _names(value.__code__)
            global_values = _global_values(names, value.__globals__)
            deciding_globals = {name: item for name, item in global_values.items() if _decides(item, value.__module__)}
            self._code(value.__code__)
            self._parts(
                "function",
                {"with": cells, "or": value.__defaults__, "and": value.__kwdefaults__, "of": deciding_globals},
            )
        elif isinstance(value, MethodType):
            self._parts("method", {"of": value.__self__, "is": value.__func__})
        elif isinstance(value, partial):
            self._parts("partial", {"is": value.func, "with": value.args, "and": value.keywords})
        elif isinstance(value, type) and _is_user_code(value):
            self._parts(f"class {value.__qualname__}", _methods(value))
        elif isinstance(value, type | BuiltinFunctionType | ModuleType | np.ufunc):
            self._word("named", f"{getattr(value, '__module__', '')}.{value.__name__}")
        else:
            slot_values = {
                name: getattr(value, name) for name in getattr(type(value), "__slots__", ()) if hasattr(value, name)
            }
            attribute_values = {
                name: attribute for name, attribute in getattr(value, "__dict__", {}).items()
                if not isinstance(getattr(type(value), name, None), cached_property)  # filled in as it is asked for
            }  # fmt: skip
            self._parts(type(value).__qualname__, {**slot_values, **attribute_values, **_class_of(value)})

    def _code(self, code: CodeType) -> None:
        """Write the bytecode, the names and the constants of a function, those of inner functions included."""
        self._word("code", code.co_code)
        self._word("names", " ".join((*code.co_names, *code.co_varnames, *code.co_freevars)))
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                self._code(constant)
            else:
                self.value(constant)


def _python_function(value: object) -> object:
    """Return the function that a compiled one of numba's was made of, and anything else as it is."""
    function = getattr(value, "py_func", None)
    return function if isinstance(function, FunctionType) else value


def _names(code: CodeType) -> list[str]:
    """Return the names that a function looks up, and those that functions inside it do."""
    inner = [name for constant in code.co_consts if isinstance(constant, CodeType) for name in _names(constant)]
    return sorted({*code.co_names, *inner})


def _global_values(names: list[str], namespace: dict[str, object]) -> dict[str, object]:
    """Return what names mean among the globals of a function; of a module, what the function may take from it."""
    values = {name: _python_function(namespace[name]) for name in names if name in namespace}
    for module, value in list(values.items()):
        if isinstance(value, ModuleType) and _is_user_code(value):
            values |= {f"{module}.{name}": vars(value)[name] for name in names if name in vars(value)}
    return values


def _decides(value: object, module: str) -> bool:
    """Return whether a global that a function reads is a part of what it does: a value, or what users wrote."""
    if isinstance(value, FunctionType):
        return value.__module__ == module or _is_user_code(value)
    plain = isinstance(value, Real | str | tuple | list | dict | np.ndarray) or is_dataclass(value)
    return _is_user_code(value if isinstance(value, type) else type(value)) or (plain and not isinstance(value, type))


def _is_user_code(value: object) -> bool:
    """Return whether a function, class or module is the user's own: neither this package's nor an installed one's.

    Installed are the standard library, what suchus itself requires, files in a folder ``site-packages`` or
    ``dist-packages``, and files that a distribution beside them records, as after ``pip install --target``. A package
    that is installed as editable is edited, and so is the user's own.
    """
    name = value.__name__ if isinstance(value, ModuleType) else getattr(value, "__module__", None)
    if not isinstance(name, str) or name.split(".")[0] in ("suchus", *REQUIRED):
        return False
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is None:
        return name == "__main__"
    return not _is_installed(Path(file).resolve())


REQUIRED = (
    "mujoco", "numpy", "scipy", "numba", "xarray", "h5netcdf", "h5py", "tyro", "pydantic", "matplotlib", "PIL", "rich",
    "jinja2", "jaxtyping", "packaging",
)  # fmt: skip
"""Import names of what ``pyproject.toml`` requires; wherever they lie, they are libraries."""
_STANDARD = tuple({Path(sysconfig.get_path(key)).resolve() for key in ("stdlib", "platstdlib")})


def _is_installed(file: Path) -> bool:
    """Return whether the file of a module belongs to the standard library or to an installed distribution."""
    if not {"site-packages", "dist-packages"}.isdisjoint(file.parts):
        return True
    if any(file.is_relative_to(folder) for folder in _STANDARD):
        return True
    folders = (Path(entry).resolve() for entry in sys.path)
    return any(
        file.relative_to(folder).as_posix() in _recorded_files(folder)
        for folder in folders
        if file.is_relative_to(folder)
    )


@lru_cache
def _recorded_files(folder: Path) -> frozenset[str]:
    """Return the files that the distributions in a folder of the import path record, relative to the folder.

    An ``egg-info`` does not count: it lies beside sources that are edited.
    """
    files: set[str] = set()
    for record in folder.glob("*.dist-info/RECORD"):
        with suppress(OSError), record.open(encoding="utf-8", errors="replace", newline="") as lines:
            files.update(row[0] for row in csv.reader(lines) if row)
    return frozenset(files)


def _class_of(value: object) -> dict[str, object]:
    """Return the class of an object as a part of it, if it is the user's own."""
    return {"class": type(value)} if _is_user_code(type(value)) else {}


def _methods(kind: type) -> dict[str, object]:
    """Return the functions of a class and of those that it is made of, and the values that these may read."""
    members: dict[str, object] = {}
    for base in reversed(kind.__mro__):
        if not _is_user_code(base):
            continue
        for name, item in vars(base).items():
            plain = getattr(item, "__func__", getattr(item, "fget", getattr(item, "func", item)))
            is_source_function = (
                isinstance(plain, FunctionType) and plain.__code__.co_filename != "<string>"
            )  # not by dataclass
            if is_source_function or (not name.startswith("__") and _decides(plain, base.__module__)):
                members[name] = plain
    return members
