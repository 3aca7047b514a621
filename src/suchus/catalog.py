"""A shelf of modules, each of which declares one thing: the only dynamic import in suchus."""

from collections.abc import Iterator, Mapping
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any, Generic, TypeVar, get_args

from suchus.errors import InvalidDesign, UnknownName
from suchus.kinds import show

T = TypeVar("T")


class Catalog(Mapping[str, T], Generic[T]):
    """A lazy mapping from module name to what the module declares.

    Listing the names reads file names only; a module is imported when its name is asked for. A folder declares its
    thing in its module of that name, ``displacement/experiment.py``, or itself.

    Args:
        kind: the singular noun, also the name each module must declare (``robot``, ``gait``, ``experiment``).
        package: dotted name of the package whose modules stand on this shelf.
        declares: dotted name of the type of what is declared, as ``module:Class``.
        classes: whether each module declares a class derived from that type, rather than a value of it.
    """

    def __init__(self, kind: str, package: str, declares: str, *, classes: bool = False) -> None:
        self.kind = kind
        self._classes = classes
        self._package = package
        self._declares = declares

    def __iter__(self) -> Iterator[str]:
        root = import_module(self._package)
        return iter(sorted(m.name for m in iter_modules(root.__path__) if not m.name.startswith("_")))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return name in tuple(self)

    def __getitem__(self, name: str) -> T:
        module = self._module(name, self.kind)
        thing: Any = getattr(module, self.kind, None)
        wanted = self._wanted()
        fits = isinstance(thing, type) and issubclass(thing, wanted) if self._classes else isinstance(thing, wanted)
        if not fits:
            found = "nothing" if thing is None else f"a {type(thing).__name__}"
            wanted_as = f"subclass of {_name(wanted)}" if self._classes else _name(wanted)
            path = Path(str(module.__file__))
            file = f"{name}/{path.name}" if path.parent.name == name else path.name
            raise InvalidDesign(
                f"{self._package.replace('.', '/')}/{file} must declare `{self.kind}`, a {wanted_as}, "
                f"but declares {found}; add it or move the file off the shelf."
            )
        return thing

    def resolve(self, value: Any) -> T:
        """Return what a value stands for: itself, or what carries its name on the shelf.

        Raises:
            UnknownName: a name that is not on the shelf.
            InvalidDesign: neither a name nor what stands on this shelf.
        """
        if isinstance(value, str):
            return self[value]
        wanted = self._wanted()
        if not isinstance(value, wanted):
            raise InvalidDesign(f"{show(value)} is no {self.kind}; a {_name(wanted)} or a name of one is needed.")
        return value

    def beside(self, name: str, attribute: str, default: Any) -> Any:
        """Return what else a module declares, such as the reasons for its numbers, or ``default``.

        In a folder it is looked for in the module of its name, RULES in ``rules``, and the others are not imported.
        """
        return getattr(self._module(name, attribute.lower()), attribute, default)

    def _module(self, name: str, part: str) -> ModuleType:
        """Return the module that declares a part of what carries a name: its file; in a folder that of the part."""
        if name not in self:
            raise UnknownName(self.kind, name, self)
        module = import_module(f"{self._package}.{name}")
        inside = f"{module.__name__}.{part}"
        return import_module(inside) if hasattr(module, "__path__") and find_spec(inside) else module

    def _wanted(self) -> Any:
        path, _, cls = self._declares.partition(":")
        wanted: Any = getattr(import_module(path), cls)
        return wanted

    def __repr__(self) -> str:
        return f"Catalog({self.kind}: {', '.join(self)})"


def _name(wanted: Any) -> str:
    """Return the name of a type, or of each of a union."""
    return " or ".join(one.__name__ for one in get_args(wanted) or (wanted,))
