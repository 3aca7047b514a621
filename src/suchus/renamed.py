"""Old names of fields, functions and classes: they go on working for one release, and a warning gives the new name."""

import warnings
from collections.abc import Callable, Mapping
from functools import wraps
from importlib import import_module
from typing import Any, TypeVar, get_args, get_type_hints

from suchus.errors import OldKey, OldName

T = TypeVar("T")
_NAMES = "__old_names__"


def old_names(**new: str) -> Callable[[type[T]], type[T]]:
    """Return a decorator that lets a frozen dataclass be made, and read, by old names of its fields.

    Where both names of a field are given the old one counts: ``dataclasses.replace`` fills in the new one by itself.

    Args:
        new: the new name of a field by its old one.
    """

    def decorate(cls: type[T]) -> type[T]:
        made: Callable[..., None] = cls.__init__

        @wraps(made)
        def made_by_any_name(self: T, *args: Any, **values: Any) -> None:
            made(self, *args, **_renamed(cls, values, OldName, stacklevel=4))

        cls.__init__ = made_by_any_name  # type: ignore[method-assign, assignment]
        for old, name in new.items():
            setattr(cls, old, _read_by(cls, old, name))
        setattr(cls, _NAMES, {**names_of(cls), **new})
        return cls

    return decorate


def old_exports(package: str, **new: str) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a package that still gives functions and classes by their old names.

    Args:
        package: its full name.
        new: the new name of a function or a class by its old one; ``module.name`` where it has moved into a module.
    """

    def find(name: str) -> Any:
        if name not in new:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        warnings.warn(sentence(f"{package}.{name}", new[name]), OldName, stacklevel=2)
        place, _, now = f"{package}.{new[name]}".rpartition(".")
        return getattr(import_module(place), now)

    return find


def sentence(old: str, new: str) -> str:
    """Return the sentence of the warning about an old name, given with its owner, and the new name."""
    return f"{old} is now called {new}; the old name works for one more release."


def names_of(kind: Any) -> Mapping[str, str]:
    """Return the new name of each field of a type that had another one, by the old name."""
    found: Mapping[str, str] = getattr(kind, _NAMES, {})
    return found


def new_name(kind: Any, name: str, category: type[Warning] = OldKey, *, stacklevel: int = 3) -> str:
    """Return the name of a field as it is today; of an old one it warns.

    Args:
        kind: the dataclass.
        name: of a field, old or new.
        category: of the warning: ``OldName`` for programmers, ``OldKey`` for those who write files and commands.
        stacklevel: the place that the warning names, as of ``warnings.warn``.
    """
    new = names_of(kind).get(name, name)
    if new != name:
        warnings.warn(sentence(f"{kind.__name__}.{name}", new), category, stacklevel=stacklevel)
    return new


def modern(data: Any, kind: Any) -> Any:
    """Return what a file says of a dataclass with the old names of fields replaced, at any depth; each of them warns.

    Args:
        data: tables, lists and values, as TOML or JSON has them.
        kind: the type that they describe.
    """
    kinds = [one for one in get_args(kind) if one is not Ellipsis] or [kind]
    if isinstance(data, (list, tuple)):
        return type(data)(modern(item, kinds[0]) for item in data)
    if not isinstance(data, dict):
        return data
    for one in kinds:
        if isinstance(one, type) and hasattr(one, "__dataclass_fields__"):
            hints = get_type_hints(one)
            data = {k: modern(v, hints.get(k)) for k, v in _renamed(one, data, OldKey, stacklevel=4).items()}
    return data


def _renamed(kind: Any, values: Mapping[str, Any], category: type[Warning], *, stacklevel: int) -> dict[str, Any]:
    """Return values by name with old names replaced; where both are given, the old one counts."""
    old = names_of(kind)
    given = {name: value for name, value in values.items() if name not in old}
    for name in old:
        if name in values:
            given[new_name(kind, name, category, stacklevel=stacklevel)] = values[name]
    return given


def _read_by(cls: Any, old: str, name: str) -> property:
    def read(self: Any) -> Any:
        new_name(cls, old, OldName)
        return getattr(self, name)

    return property(read, doc=f"Old name of ``{name}``.")
