"""Where things in the catalogs come from: the package, a project folder of the user's, other packages of the user's.

A project is a folder with a ``suchus.toml``. Its sub-folders ``robots``, ``gaits``, ``faults``, ``experiments``,
``controllers``, ``measures``, ``protocols``, ``policies`` and ``commands`` hold files as the catalogs of the package
do.
``suchus.toml`` names files that stand elsewhere in the folder. A file is read, or a module run, when its name is asked
for.

Modules of a project are imported as modules of the catalog, ``suchus.sim.faults.tired``, so that values travel between
processes as pickles, and a file means the same in the package and in a project.
"""

import ast
import hashlib
import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache, lru_cache
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import find_spec, spec_from_file_location
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

from suchus.core.errors import AmbiguousName, UnreadableFile
from suchus.core.printable import name_complaint
from suchus.core.reading import read_toml

VARIABLE = "SUCHUS_PROJECT"
"""Variable of the environment that names the project folder; empty for none."""
SETTINGS = "suchus.toml"
"""File that makes a folder a project."""
SHELVES: Mapping[str, str] = {
    "robots": "suchus.robot.robots",
    "gaits": "suchus.robot.gaits",
    "faults": "suchus.sim.faults",
    "experiments": "suchus.experiments.catalog",
    "controllers": "suchus.robot.control",
    "measures": "suchus.sim.metrics",
    "commands": "suchus.apps.commands",
    "protocols": "suchus.hardware.protocols",
    "policies": "suchus.robot.policies",
}
"""Package of each catalog by its folder in a project; the groups of entry points are ``suchus.robots`` and so on."""
DATA_SUFFIXES: Mapping[str, str] = {"robots": ".toml", "gaits": ".toml", "policies": ".npz"}
"""Ending of the files of data that can stand in a catalog, by catalog."""
WITHOUT_RESULTS = ("commands",)
"""Catalogs of which no result is made, so that results stay valid when their files change."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Where one thing in a catalog comes from."""

    name: str
    """Name in the catalog."""
    place: str
    """The file or the entry point, as messages name it."""
    module: str = ""
    """Dotted name of the module that declares it; empty for a file of data."""
    attribute: str = ""
    """Name in the module; empty for what the catalog's modules declare."""
    file: Path | None = None
    """The file, where there is one that is known."""
    shipped: bool = False
    """Whether it is a part of suchus."""


@dataclass(frozen=True, slots=True)
class Project:
    """A folder of the user's own: robots, gaits, faults, experiments, controllers, measures, protocols and commands."""

    folder: Path
    """The folder, absolute."""
    named: Mapping[str, tuple[Path, ...]] = field(default_factory=dict)
    """Files that ``suchus.toml`` names, by catalog."""

    def files(self, shelf: str) -> Iterator[tuple[str, Path]]:
        """Yield name and file of all that stands in a catalog, the files of modules that begin with ``_`` included.

        Args:
            shelf: one of ``SHELVES``.
        """
        folder = self.folder / shelf
        folder_entries = sorted(folder.iterdir()) if folder.is_dir() else []
        for path in (*folder_entries, *self.named.get(shelf, ())):
            complaint = name_complaint(path.name) if path.suffix in _suffixes(shelf) else None
            if complaint is not None:
                raise UnreadableFile(f"a file of the folder {shelf} cannot be taken: {complaint}.")
            if path.suffix in _suffixes(shelf) and path.is_file():
                yield path.stem, path
            elif (path / "__init__.py").is_file():
                yield path.name, _declaring(path, kind_of(shelf))

    def shown(self, path: Path) -> str:
        """Return a path as messages name it: from the project's folder on."""
        return path.relative_to(self.folder).as_posix() if path.is_relative_to(self.folder) else str(path)

    def digest(self) -> str:
        """Return the first 12 digits of the SHA-256 of the files of all catalogs of which results are made."""
        text = hashlib.sha256()
        for shelf in (shelf for shelf in SHELVES if shelf not in WITHOUT_RESULTS):
            for name, file in self.files(shelf):
                for path in sorted(file.parent.rglob("*.py")) if _is_folder(name, file) else [file]:
                    text.update(self.shown(path).encode() + b"\0" + path.read_bytes() + b"\0")
        return text.hexdigest()[:12]


def shelf_of(kind: str) -> str:
    """Return the catalog of a kind of things: ``robots`` for ``robot``, ``policies`` for ``policy``."""
    return f"{kind[:-1]}ies" if kind.endswith("y") else f"{kind}s"


def kind_of(shelf: str) -> str:
    """Return the kind of things in a catalog: ``robot`` for ``robots``, ``policy`` for ``policies``."""
    return next(kind for kind in (f"{shelf[:-3]}y", shelf.removesuffix("s")) if shelf_of(kind) == shelf)


def project(folder: str | os.PathLike[str] | None) -> Project | None:
    """Add the contents of a project folder to the catalogs, in this process and in those that it starts.

    Without a call the project is the folder that the variable ``SUCHUS_PROJECT`` names, else the working folder if it
    has a ``suchus.toml``.

    Args:
        folder: the project's; None for none.

    Raises:
        UnreadableFile: there is no such folder, or its ``suchus.toml`` says what cannot be.
    """
    if folder is None:
        os.environ[VARIABLE] = ""
        return None
    opened = _opened(Path(folder))
    os.environ[VARIABLE] = str(opened.folder)
    return opened


def current() -> Project | None:
    """Return the project of this process; None where there is none.

    Raises:
        UnreadableFile: the folder is not there, or its ``suchus.toml`` says what cannot be.
    """
    folder = os.environ.get(VARIABLE)
    if folder is not None:
        return _opened(Path(folder)) if folder else None
    return _opened(Path()) if Path(SETTINGS).is_file() else None


@contextmanager
def project_context(folder: str | None) -> Iterator[None]:
    """Use a project folder in this process while the block runs; with None the project stays.

    Raises:
        UnreadableFile: there is no such folder, or its ``suchus.toml`` says what cannot be.
    """
    previous_folder = os.environ.get(VARIABLE)
    if folder is not None:
        project(folder)
    try:
        yield
    finally:
        if previous_folder is None:
            os.environ.pop(VARIABLE, None)
        else:
            os.environ[VARIABLE] = previous_folder


class ProjectPickle:
    """A value whose pickle names the project of this process, so that another process opens the project too.

    There the project is opened before the value is read, whose types may stand in it. A process that was told a project
    by ``SUCHUS_PROJECT`` when it started keeps that one, as on a machine where the folder has another path.

    Args:
        value: what is sent.
    """

    def __init__(self, value: Any) -> None:
        self.value = value

    def __reduce__(self) -> tuple[Any, ...]:
        opened = current()
        return _arrived, (_Opening(str(opened.folder) if opened else None), self.value)


@dataclass(frozen=True, slots=True)
class _Opening:
    """A project folder that is opened where this is read from a pickle."""

    folder: str | None

    def __reduce__(self) -> tuple[Any, ...]:
        return _open_here, (self.folder,)


_AT_START = os.environ.get(VARIABLE)


def _open_here(folder: str | None) -> None:
    if _AT_START is None:
        project(folder)


def _arrived(_: None, value: Any) -> Any:
    return value


def gather(kind: str, package: str, *, scattered: bool = False) -> dict[str, Source]:
    """Return all that stands in a catalog by name, sorted by name; nothing is imported.

    Args:
        kind: what each module declares, as ``robot``; the catalog's folder in a project is ``robots``.
        package: dotted name of the catalog's package.
        scattered: whether things have names of their own, and modules that declare none stand beside them.

    Raises:
        AmbiguousName: two things have the same name.
        UnreadableFile: the project's folder is not there, or its ``suchus.toml`` says what cannot be.
    """
    sources: dict[str, Source] = {}
    for source in (*_shipped(package, kind, scattered), *_of_project(package, kind, scattered), *_plugged(kind)):
        if source.name in sources:
            raise AmbiguousName(kind, source.name, sources[source.name].place, source.place)
        sources[source.name] = source
    return dict(sorted(sources.items()))


def _shipped(package: str, kind: str, scattered: bool) -> Iterator[Source]:
    """Yield what the package itself has in a catalog."""
    if not scattered:
        stamps = _stamped(package)
        yield from _module_sources(package, kind, stamps)
        if DATA_SUFFIXES.get(shelf_of(kind), ".toml") != ".toml":
            yield from _data_sources(package, DATA_SUFFIXES[shelf_of(kind)], stamps)
        return
    for name, file in _modules(package, kind).items():
        if not name.startswith("_"):
            for thing, attribute in _names(file, kind):
                yield _of_package(package, name, file, thing, attribute)


@lru_cache(maxsize=64)
def _module_sources(package: str, kind: str, stamped: "_Stamped") -> tuple[Source, ...]:
    """Return what the modules of a package declare, one thing each."""
    files = _files(kind, stamped).items()
    return tuple(_of_package(package, name, file, name, "") for name, file in files if not name.startswith("_"))


@lru_cache(maxsize=64)
def _data_sources(package: str, suffix: str, stamped: "_Stamped") -> tuple[Source, ...]:
    """Return the files of data in a package's folders."""
    return tuple(
        Source(name=file.stem, place=f"{package.replace('.', '/')}/{file.name}", file=file, shipped=True)
        for folder, *_ in stamped
        for file in sorted(Path(folder).glob(f"*{suffix}"))
    )


def _of_package(package: str, name: str, file: Path, thing: str, attribute: str) -> Source:
    location = f"{package.replace('.', '/')}/{f'{name}/{file.name}' if _is_folder(name, file) else file.name}"
    return Source(name=thing, place=location, module=f"{package}.{name}", attribute=attribute, file=file, shipped=True)


def _modules(package: str, kind: str) -> Mapping[str, Path]:
    """Return the files of a package's modules by name, those of folders that declare the kind; nothing is imported."""
    return _files(kind, _stamped(package))


_Stamped = tuple[tuple[str, int, tuple[int, ...]], ...]
"""Folders of a package, when each was changed and when those in it were [ns]: what lies in them is as it was then."""


def _stamped(package: str) -> _Stamped:
    """Return the folders of a package with the times at which they and their subfolders were modified."""
    folders = list(sys.modules[package].__path__) if package in sys.modules else _folders(package)
    stamps = []
    for folder in folders:
        modified_ns = os.stat(folder).st_mtime_ns  # noqa: PTH116  a catalog is asked some thousand times a minute
        subfolder_times = (
            os.stat(f"{folder}/{name}").st_mtime_ns  # noqa: PTH116
            for name, is_folder in _listed(folder, modified_ns)
            if is_folder
        )
        stamps.append((folder, modified_ns, tuple(subfolder_times)))
    return tuple(stamps)


def _folders(package: str) -> list[str]:
    """Return the folders of a package; neither it nor the packages around it are imported."""
    top_package, *inner_names = package.split(".")
    spec = find_spec(top_package)
    top_folders = (spec.submodule_search_locations or ()) if spec else ()
    folders = [Path(top_folder).joinpath(*inner_names) for top_folder in top_folders]
    return [str(folder) for folder in folders if folder.is_dir()]


@lru_cache(maxsize=64)
def _files(kind: str, stamped: _Stamped) -> Mapping[str, Path]:
    """Return the file of each module of a package by name; the result is cached by the folders' times."""
    return {
        name: _declaring(Path(folder) / name, kind) if is_folder else Path(folder) / f"{name}.py"
        for folder, modified_ns, _ in stamped
        for name, is_folder in _listed(folder, modified_ns)
    }


@lru_cache(maxsize=64)
def _listed(folder: str, _: int) -> tuple[tuple[str, bool], ...]:
    """Return the modules of a package's folder, and which are folders; read anew when the folder has changed."""
    return tuple((info.name, info.ispkg) for info in iter_modules([folder]))


def _declaring(folder: Path, kind: str) -> Path:
    """Return the file of a folder that declares a kind: its module of that name, or its own."""
    module_file = folder / f"{kind}.py"
    return module_file if module_file.is_file() else folder / "__init__.py"


def _is_folder(name: str, file: Path) -> bool:
    """Return whether what has a name is a folder, of which the file is a module."""
    return file.stem == "__init__" or (file.parent.name == name != file.stem)


def _of_project(package: str, kind: str, scattered: bool) -> Iterator[Source]:
    """Yield what the project has in a catalog.

    Raises:
        AmbiguousName: a module has the name of one of the package, which would be imported in its place.
    """
    opened = current()
    if opened is None:
        return
    package_modules = _modules(package, kind)
    for name, file in opened.files(shelf_of(kind)):
        location = opened.shown(file)
        if file.suffix == ".py" and name in package_modules:
            raise AmbiguousName("module", name, f"{package.replace('.', '/')}/{name}", location)
        if file.suffix == DATA_SUFFIXES.get(shelf_of(kind)):
            yield Source(name=name, place=location, file=file)
        elif not name.startswith("_"):
            for thing, attribute in _names(file, kind) if scattered else ((name, ""),):
                yield Source(name=thing, place=location, module=f"{package}.{name}", attribute=attribute, file=file)


def _plugged(kind: str) -> Iterator[Source]:
    """Yield what other installed packages put in a catalog by their entry points."""
    for point in _entry_points().get(f"suchus.{shelf_of(kind)}", ()):
        owner = point.dist.name if point.dist else "an installed package"
        location = f"the entry point {point.name} = {point.value!r} of {owner}"
        yield Source(name=point.name, place=location, module=point.module, attribute=point.attr)


@cache
def _entry_points() -> Mapping[str, Sequence[Any]]:
    """Return the entry points of the catalogs by group."""
    if not _has_plug_ins():
        return {}
    from importlib.metadata import entry_points  # noqa: PLC0415  takes half as long as everything else at the start

    all_points = entry_points()
    return {group: tuple(all_points.select(group=group)) for group in (f"suchus.{shelf}" for shelf in SHELVES)}


def _has_plug_ins() -> bool:
    """Return whether an installed package may have entry points of suchus.

    The files that declare them are searched for the names of the groups, since the library that reads entry points
    takes ten times as long to import. Packages in archives, and those of other import systems, are left to the library.
    """
    if any(hasattr(finder, "find_distributions") and finder is not PathFinder for finder in sys.meta_path):
        return True
    for folder in sys.path:
        try:
            with os.scandir(folder or ".") as folder_entries:
                names = [entry.name for entry in folder_entries if entry.name.endswith((".dist-info", ".egg-info"))]
        except NotADirectoryError:
            return True
        except OSError:
            continue
        if folder.endswith(".egg") or any(_declares_plug_ins(f"{folder or '.'}/{name}") for name in names):
            return True
    return False


def _declares_plug_ins(metadata_folder: str) -> bool:
    """Return whether the metadata of an installed package names a group of entry points of suchus."""
    try:
        with open(f"{metadata_folder}/entry_points.txt", encoding="utf-8", errors="replace") as file:  # noqa: PTH123  as fast as can be
            return re.search(r"^\s*\[\s*suchus\.", file.read(), re.M) is not None
    except OSError:
        return False


def snake(name: str) -> str:
    """Return the name in a catalog of a class or a function: ``lost_foot`` for ``LostFoot``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def _names(file: Path, kind: str) -> tuple[tuple[str, str], ...]:
    """Return what a module of a scattered catalog declares: names in the catalog, and names in the module.

    A project's file that cannot be read stands under its own name, so that its mistake is told when it is asked for.
    """
    stat = file.stat()
    return _declared_names(file, kind, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=1024)
def _declared_names(file: Path, kind: str, *_: int) -> tuple[tuple[str, str], ...]:
    """Return the catalog name and the module name of each thing that a file declares under a kind."""
    text = file.read_text(encoding="utf-8", errors="replace")
    if not re.search(rf"^{kind}s? *[:=]", text, re.M):
        return ()
    try:
        body = ast.parse(text).body
    except (SyntaxError, ValueError):
        return ((file.stem, ""),)
    names: list[tuple[str, str]] = []
    for line in body:
        target = line.targets[0] if isinstance(line, ast.Assign) else getattr(line, "target", None)
        value = getattr(line, "value", None)
        if isinstance(target, ast.Name) and target.id in (kind, f"{kind}s"):
            parts = value.elts if isinstance(value, (ast.Tuple, ast.List)) else [value]
            names += [(snake(element.id), element.id) for element in parts if isinstance(element, ast.Name)]
    return tuple(names)


def _suffixes(shelf: str) -> tuple[str, ...]:
    return (".py", DATA_SUFFIXES[shelf]) if shelf in DATA_SUFFIXES else (".py",)


# --- the folder ------------------------------------------------------------------------------------------------


def _opened(folder: Path) -> Project:
    """Return the project of a folder.

    Raises:
        UnreadableFile: there is no such folder, or its ``suchus.toml`` says what cannot be.
    """
    try:
        folder = folder.absolute()
        if not folder.is_dir():
            raise UnreadableFile(f"there is no folder {folder}; a project is a folder with a {SETTINGS}.")
        stat = (folder / SETTINGS).stat()
    except UnreadableFile:  # an OSError too
        raise
    except FileNotFoundError:
        return Project(folder)
    except (OSError, ValueError) as error:
        reason = (
            (error.strerror or "").lower() if isinstance(error, OSError) else "it is no name that a folder can have"
        )
        raise UnreadableFile(f"the project folder {str(folder)!r} cannot be read: {reason}.") from error
    return _read_project(folder, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=8)
def _read_project(folder: Path, *_: int) -> Project:
    """Return the project of a folder from its ``suchus.toml``; the result is cached by the file's time and size."""
    settings, settings_file = read_toml(folder / SETTINGS), folder / SETTINGS
    unknown = [key for key in settings if key not in SHELVES]
    if unknown:
        matches = [close[0] for key in unknown if (close := get_close_matches(key, SHELVES, n=1))]
        hint = f" Did you mean {', '.join(map(repr, matches))}?" if matches else ""
        verb = "which is" if len(unknown) == 1 else "which are"
        raise UnreadableFile(
            f"{settings_file} has {', '.join(map(repr, unknown))}, {verb} not known; "
            f"there is {', '.join(SHELVES)}.{hint}"
        )
    return Project(folder, {shelf: tuple(_listed_files(folder, shelf, files)) for shelf, files in settings.items()})


def _listed_files(folder: Path, shelf: str, files: Any) -> Iterator[Path]:
    """Yield the files that ``suchus.toml`` names for a catalog.

    Raises:
        UnreadableFile: they are no list of files in the folder.
    """
    if not isinstance(files, list) or not all(isinstance(file, str) for file in files):
        raise UnreadableFile(f"{folder / SETTINGS} has {shelf} = {files!r}; a list of files is needed.")
    for file in files:
        path = folder / file
        if not path.resolve().is_relative_to(folder.resolve()):
            raise UnreadableFile(f"{folder / SETTINGS} names {file!r} among {shelf}, which is not in its folder.")
        if path.suffix not in _suffixes(shelf) or not path.is_file():
            kinds = " or ".join(_suffixes(shelf))
            raise UnreadableFile(f"{folder / SETTINGS} names {file!r} among {shelf}; there is no such {kinds} file.")
        yield path


class _ProjectFinder:
    """Finds modules of the project for the import system, after its own finders: ``suchus.sim.faults.tired``."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """Return how a module of the project is loaded; None for any other module."""
        del path, target
        package, _, module_name = name.rpartition(".")
        shelf = next((shelf for shelf, home in SHELVES.items() if home == package), None)
        opened = current() if shelf else None
        if shelf is None or opened is None:
            return None
        for stem, file in opened.files(shelf):
            if stem == module_name and file.suffix == ".py":
                if not _is_folder(stem, file):
                    return spec_from_file_location(name, file)
                inner = [str(file.parent)]
                return spec_from_file_location(name, file.parent / "__init__.py", submodule_search_locations=inner)
        return None


if not any(isinstance(finder, _ProjectFinder) for finder in sys.meta_path):
    sys.meta_path.append(_ProjectFinder())
