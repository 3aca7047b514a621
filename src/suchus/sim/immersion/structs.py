"""Where the fields of MuJoCo's structs lie: derived from its own description, verified against its bindings."""

import ctypes
import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco.introspect import structs
from mujoco.introspect.ast_nodes import AnonymousStructDecl, ArrayType, PointerType

from suchus.core.errors import OtherMuJoCo

_PLAIN: dict[str, Any] = {
    "mjtNum": ctypes.c_double,
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "int": ctypes.c_int,
    "char": ctypes.c_char,
    "mjtSize": ctypes.c_int64,
    "int64_t": ctypes.c_int64,
    "mjtByte": ctypes.c_ubyte,
    "mjtBool": ctypes.c_bool,
    "size_t": ctypes.c_size_t,
    "uint64_t": ctypes.c_uint64,
    "uintptr_t": ctypes.c_size_t,
}
"""Plain C types by the names that MuJoCo's description uses."""


def offset(struct: str, field: str) -> int:
    """Return where a field of a struct begins [byte].

    Args:
        struct: as ``mjModel``.
        field: its name; of a struct inside, as ``opt.gravity``.

    Raises:
        OtherMuJoCo: MuJoCo's description has no such struct or field, or a type that is not known.
    """
    member_name, _, subfield = field.partition(".")
    kind = _struct(struct)
    if not hasattr(kind, member_name):
        raise OtherMuJoCo(f"{struct}.{field}", mujoco.__version__, "its description has no such field")
    begins = int(getattr(kind, member_name).offset)
    if not subfield:
        return begins
    members: Any = kind._fields_
    inner = next(member[1] for member in members if member[0] == member_name)
    return begins + offset(inner.__name__, subfield)


@lru_cache(maxsize=1)
def plugin_struct() -> type[ctypes.Structure]:
    """Return the struct of a plugin with its members in the order of the header that comes with MuJoCo.

    ``mujoco.introspect`` does not describe it. Functions are addresses.

    Raises:
        OtherMuJoCo: there is no such header, or the struct lacks what a plugin of passive forces needs.
    """
    header = Path(mujoco.__file__).parent / "include" / "mujoco" / "mjplugin.h"
    text = re.sub(r"//[^\n]*", "", header.read_text(encoding="utf-8")) if header.is_file() else ""
    body = re.search(r"typedef struct mjpPlugin_ \{(.*?)\} mjpPlugin;", text, re.DOTALL)
    fields: list[tuple[str, Any]] = []
    for declaration in body.group(1).split(";") if body else ():
        name = re.search(r"(?<=\(\*)\w+(?=\))|\w+\s*$", declaration.strip())
        if name is None:
            continue
        kind = ctypes.c_char_p if name.group() == "name" else ctypes.c_void_p if "*" in declaration else ctypes.c_int
        fields.append((name.group(), kind))
    missing = {"name", "capabilityflags", "nstate", "init", "reset", "compute"} - {name for name, _ in fields}
    if missing:
        raise OtherMuJoCo(f"mjpPlugin.{min(missing)}", mujoco.__version__, "its header has no such field")
    return type("mjpPlugin", (ctypes.Structure,), {"_fields_": fields})


@lru_cache(maxsize=32)
def _struct(name: str) -> type[ctypes.Structure]:
    """Return a struct with the fields of MuJoCo's description in their order."""
    if name not in structs.STRUCTS:
        raise OtherMuJoCo(name, mujoco.__version__, "its description has no such struct")
    return _ctypes_struct(name, structs.STRUCTS[name].fields)


def _ctypes_struct(name: str, members: Sequence[Any]) -> type[ctypes.Structure]:
    fields = [(member.name, _type(f"{name}.{member.name}", member.type)) for member in members]
    return type(name, (ctypes.Structure,), {"_fields_": fields})


def _type(field_path: str, declaration: Any) -> Any:
    """Return the ctypes type of a declaration in MuJoCo's description."""
    if isinstance(declaration, PointerType):
        return ctypes.c_void_p
    if isinstance(declaration, ArrayType):
        return _type(field_path, declaration.inner_type) * int(np.prod(declaration.extents))
    if isinstance(declaration, AnonymousStructDecl):
        return _ctypes_struct(field_path, declaration.fields)
    if declaration.name in _PLAIN:
        return _PLAIN[declaration.name]
    if declaration.name in structs.STRUCTS:
        return _struct(declaration.name)
    if hasattr(mujoco, declaration.name):  # an enumeration
        return ctypes.c_int
    raise OtherMuJoCo(field_path, mujoco.__version__, f"its type {declaration.name} is not known")


def verify(struct: str, instance: Any, fields: Sequence[str]) -> None:
    """Compare the memory at the derived offsets with the values of MuJoCo's bindings.

    Args:
        struct: as ``mjModel``.
        instance: a ``mujoco.MjModel`` or ``mujoco.MjData`` in which no field is empty.
        fields: the names of its fields; arrays are compared by address, numbers by value.

    Raises:
        OtherMuJoCo: another thing lies there; the message names field and version.
    """
    for field, derived in _field_values(struct, instance._address, fields):
        bound = _bound(instance, field)
        is_equal = derived == bound.ctypes.data if isinstance(bound, np.ndarray) else derived == bound
        if not is_equal:
            raise OtherMuJoCo(
                f"{struct}.{field}", mujoco.__version__, f"{derived} lies at its offset, not what it holds"
            )


def _bound(instance: Any, field: str) -> Any:
    for name in field.split("."):
        instance = getattr(instance, name)
    return instance


def _field_values(struct: str, address: int, fields: Sequence[str]) -> Iterator[tuple[str, float]]:
    """Yield each field with the content of its offset: the address of an array, or the number itself."""
    for field in fields:
        field_address = address + offset(struct, field)
        owner, name = (structs.STRUCTS[struct], field)
        while "." in name:
            member_name, _, name = name.partition(".")
            owner = structs.STRUCTS[next(member.type.name for member in owner.fields if member.name == member_name)]
        declaration = next(member.type for member in owner.fields if member.name == name)
        if isinstance(declaration, ArrayType):
            yield field, field_address
        elif isinstance(declaration, PointerType):
            yield field, ctypes.c_size_t.from_address(field_address).value
        else:
            yield field, _PLAIN[declaration.name].from_address(field_address).value
