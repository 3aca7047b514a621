"""A catalog: designs of one kind by name, from the package, a project folder, and installed plug-ins."""

import importlib
import sys
import traceback
from collections.abc import Callable, ItemsView, Iterator, Mapping, ValuesView
from importlib import import_module
from importlib.util import find_spec
from operator import attrgetter
from pathlib import Path
from threading import local
from types import ModuleType
from typing import Any, Generic, TypeVar, get_args

from suchus.core.errors import BrokenFile, InvalidDesign, SuchusError, UnknownName
from suchus.core.kinds import show
from suchus.core.reading import path_exists
from suchus.core.sources import Source, current, gather

T = TypeVar("T")


class Catalog(Mapping[str, T], Generic[T]):
    """A lazy mapping from names to what stands in a catalog, see ``suchus.core.sources``.

    Listing the names reads file names only; a module is imported when its name is asked for. A folder declares its
    thing in its module of that name, ``displacement/experiment.py``, or itself. Things of the user's that cannot be
    loaded are listed, refused with a ``BrokenFile`` when they are asked for, and left out of ``values`` and ``items``.

    Args:
        kind: the singular noun, also the name each module must declare (``robot``, ``gait``, ``experiment``).
        package: dotted name of the package whose modules stand in this catalog.
        declares: dotted name of the type of what is declared, as ``module:Class``.
        classes: whether each module declares a class derived from that type, rather than a value of it.
        scattered: whether a module may declare several, as ``measures = (speed, slip)``, each with a name of its own,
            and modules that declare none stand beside them.
        name_of: returns the name that a thing has by itself, which must be that in the catalog.
        read_file: returns what a file of data describes, where this catalog has such files.
        suffix: ending of these files.
    """

    def __init__(
        self,
        kind: str,
        package: str,
        declares: str,
        *,
        classes: bool = False,
        scattered: bool = False,
        name_of: Callable[[Any], str] | None = None,
        read_file: Callable[[Path], Any] | None = None,
        suffix: str = ".toml",
    ) -> None:
        """Store the settings; neither file names nor modules are read yet."""
        self.kind = kind
        self._package, self._declares = package, declares
        self._classes, self._scattered = classes, scattered
        self._name_of, self._read_file, self._suffix = name_of, read_file, suffix
        self._from_files: dict[Path, tuple[int, Any]] = {}
        self._loading = _LoadingFiles()

    def sources(self) -> dict[str, Source]:
        """Return where each thing in the catalog comes from, by name; nothing is imported.

        Raises:
            AmbiguousName: two things have the same name.
        """
        return gather(self.kind, self._package, scattered=self._scattered)

    def __iter__(self) -> Iterator[str]:
        return iter(self.sources())

    def __len__(self) -> int:
        return len(self.sources())

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self.sources()

    def __getitem__(self, name: str) -> T:
        sources = self.sources()
        if name not in sources:
            raise UnknownName(self.kind, name, sources)
        return self._load(sources[name])

    def values(self) -> ValuesView[T]:
        """Return what stands in the catalog and can be loaded."""
        return _SoundValues(self)

    def items(self) -> ItemsView[str, T]:
        """Return names and things that can be loaded."""
        return _SoundItems(self)

    def sound(self) -> Iterator[tuple[str, T]]:
        """Yield name and thing of all that can be loaded; what is a part of suchus must be."""
        for name, source in self.sources().items():
            try:
                yield name, self._load(source)
            except SuchusError:
                if source.shipped:
                    raise

    def _load(self, source: Source) -> T:
        """Return what a source declares.

        Raises:
            BrokenFile: it is the user's, and loading it fails.
            InvalidDesign: it declares something else than stands in this catalog.
        """
        thing = self._load_file(source) if not source.module else self._load_module(source)
        name = self._name_of(thing) if self._name_of else source.name
        if name != source.name:
            raise InvalidDesign(
                f"{source.place} declares the {self.kind} {name!r}, which must have the name by which it stands in the "
                f"catalog, {source.name!r}."
            )
        return thing

    def _load_file(self, source: Source) -> Any:
        """Return what a file of data describes; the value is cached until the file changes."""
        assert source.file is not None
        assert self._read_file is not None
        modified_ns = source.file.stat().st_mtime_ns
        if self._from_files.get(source.file, (None,))[0] != modified_ns:
            if source.name in self._loading.names:
                raise BrokenFile(f"{source.place} starts from itself.")
            self._loading.names.add(source.name)
            try:
                self._from_files[source.file] = modified_ns, self._read_file(source.file)
            except SuchusError as error:
                raise BrokenFile(f"{source.place} cannot be loaded: {error}") from error
            finally:
                self._loading.names.discard(source.name)
        return self._from_files[source.file][1]

    def _load_module(self, source: Source) -> Any:
        """Return what a module declares."""
        module = _imported(source, "" if source.attribute else self.kind)
        try:
            thing: Any = attrgetter(source.attribute or self.kind)(module)
        except AttributeError:
            thing = None
        declared_type = self._declared_type()
        fits = (
            isinstance(thing, type) and issubclass(thing, declared_type)
            if self._classes
            else isinstance(thing, declared_type)
        )
        if not fits:
            type_text = f"subclass of {_name(declared_type)}" if self._classes else _name(declared_type)
            actual_text = "nothing" if thing is None else f"a {type(thing).__name__}"
            raise InvalidDesign(
                f"{source.place} must declare `{source.attribute or self.kind}`, a {type_text}, "
                f"but declares {actual_text}; add it or move the file out of the folder."
            )
        return thing

    def file(self, value: Any, folder: str | Path = Path()) -> Path | None:
        """Return the file that a value names, None where it names none.

        A path does, and a text that is not in the catalog, if it has the ending of such files or a file has that name.

        Args:
            value: value as a user gives it.
            folder: the folder from which paths are read.
        """
        is_name = isinstance(value, str) and (not value or value in self)  # an empty text names no folder
        if not isinstance(value, (str, Path)) or self._read_file is None or is_name:
            return None
        path = Path(folder) / value
        return path if path.suffix == self._suffix or path_exists(path) else None

    def resolve(self, value: Any, folder: str | Path = Path()) -> T:
        """Return what a value stands for: itself, what carries its name in the catalog, or what a file describes.

        Args:
            value: the thing, its name, or the path of its file.
            folder: the folder from which paths are read.

        Raises:
            UnknownName: a name that is not in the catalog.
            UnreadableFile: there is no such file, or it is no TOML.
            MistakenFile: the file describes nothing that can be.
            InvalidDesign: neither a name nor what stands in this catalog.
        """
        path = self.file(value, folder)
        if path is not None and self._read_file is not None:
            entry: T = self._read_file(path)
            return entry
        if isinstance(value, str):
            return self[value]
        declared_type = self._declared_type()
        if not isinstance(value, declared_type):
            raise InvalidDesign(
                f"{show(value)} is no {self.kind}; a {_name(declared_type)} or a name of one is needed."
            )
        return value

    def beside(self, name: str, attribute: str, default: Any, *, module: str = "") -> Any:
        """Return what else a module declares, such as the reasons for its numbers, or ``default``.

        A TOML file declares nothing else, nor does a module of the user's that cannot be loaded.

        Args:
            name: name in the catalog.
            attribute: by which it is declared.
            default: what is returned where nothing is declared.
            module: module of a folder in which it is looked for, if there is one; the others are then not imported.

        Raises:
            UnknownName: a name that is not in the catalog.
        """
        sources = self.sources()
        if name not in sources:
            raise UnknownName(self.kind, name, sources)
        source = sources[name]
        try:
            return getattr(_imported(source, module), attribute, default) if source.module else default
        except BrokenFile:
            return default

    def _declared_type(self) -> Any:
        path, _, cls = self._declares.partition(":")
        declared_type: Any = getattr(import_module(path), cls)
        return declared_type

    def __repr__(self) -> str:
        return f"Catalog({self.kind}: {', '.join(self)})"


class _SoundValues(ValuesView[T]):
    """The things in a catalog that can be loaded, one after the other."""

    def __init__(self, shelf: Catalog[T]) -> None:
        super().__init__(shelf)
        self._shelf = shelf

    def __iter__(self) -> Iterator[T]:
        return (thing for _, thing in self._shelf.sound())


class _SoundItems(ItemsView[str, T]):
    """Names and things in a catalog that can be loaded, one after the other."""

    def __init__(self, shelf: Catalog[T]) -> None:
        super().__init__(shelf)
        self._shelf = shelf

    def __iter__(self) -> Iterator[tuple[str, T]]:
        return self._shelf.sound()


class _LoadingFiles(local):
    """Names of the files that a thread is reading."""

    def __init__(self) -> None:
        self.names: set[str] = set()


def _name(declared_type: Any) -> str:
    """Return the name of a type, or of each of a union."""
    return " or ".join(member.__name__ for member in get_args(declared_type) or (declared_type,))


def _imported(source: Source, submodule: str) -> ModuleType:
    """Return the module that declares a part of a source: its file; in a folder that of the part, if there is one.

    Another project's module of that name gives way.

    Raises:
        BrokenFile: it is the user's, and importing it fails.
    """
    loaded = sys.modules.get(source.module)
    if source.file and loaded and not source.shipped and not _is_of(loaded, source.file):
        for name in [name for name in sys.modules if f"{name}.".startswith(f"{source.module}.")]:
            del sys.modules[name]
    try:
        module = import_module(source.module)
        submodule_name = f"{source.module}.{submodule}"
        return (
            import_module(submodule_name)
            if submodule and hasattr(module, "__path__") and find_spec(submodule_name)
            else module
        )
    except (Exception, SystemExit) as error:
        if source.shipped:
            raise
        raise BrokenFile(f"{_error_location(source, error)} cannot be loaded: {_error_text(error)}") from error


def _is_of(module: ModuleType, file: Path) -> bool:
    return module.__file__ in (str(file), str(file.parent / "__init__.py"))


def _error_location(source: Source, error: BaseException) -> str:
    """Return the line of user code that raised an error: the last one in the folder of the module."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{_project_path(Path(error.filename))}, line {error.lineno},"
    frames = [(Path(f.filename), f.lineno) for f in traceback.extract_tb(error.__traceback__)]
    library_folders = (Path(__file__).parents[1], Path(importlib.__file__).parent)
    user_frames = [
        (file, line)
        for file, line in frames
        if file.is_absolute() and not any(map(file.is_relative_to, library_folders))
    ]
    if source.file:  # of a project, which may lie inside our own folder
        root = source.file.parent
        user_frames = [(file, line) for file, line in frames if file.is_relative_to(root)]
    elif user_frames:
        root = user_frames[0][0].parent
        user_frames = [(file, line) for file, line in user_frames if file.is_relative_to(root)]
    if not user_frames:
        return source.place
    file, line = user_frames[-1]
    return f"{_project_path(file)}, line {line},"


def _project_path(file: Path) -> str:
    project = current()
    return project.shown(file) if project else str(file)


def _error_text(error: BaseException) -> str:
    """Return the message of an error as a sentence; messages of ``SuchusError`` are sentences already."""
    if isinstance(error, SuchusError):
        return str(error)
    text = error.msg if isinstance(error, SyntaxError) else str(error)
    return f"{type(error).__name__}{': ' * bool(text)}{' '.join(text.split())}."
