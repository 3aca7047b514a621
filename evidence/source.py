"""Which modules a result reaches by import, and the digest of what they do."""

import hashlib
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

import grimp

import suchus
from suchus.core.files.provenance import syntax_of

PACKAGE = Path(suchus.__file__).parent
EVIDENCE = Path(__file__).parent
CATALOGS = ("robot.control", "robot.gaits", "robot.motors", "robot.robots", "sim.faults", "sim.metrics")
"""Packages whose modules are loaded by name: who imports the package may reach all of them."""
_DATA = (".toml", ".csv", ".npz")


@cache
def _graph() -> grimp.ImportGraph:
    return grimp.build_graph("suchus", "evidence", cache_dir=None)


@cache
def reached(modules: tuple[str, ...]) -> frozenset[str]:
    """Return all modules of suchus that some modules import, directly or not, and these themselves.

    Args:
        modules: full names, as ``suchus.sim.land.stepper``; of a package all of its modules.

    Raises:
        KeyError: there is no such module.
    """
    graph, everything = _graph(), set[str]()
    todo = [module for name in modules for module in (name, *graph.find_descendants(name))]
    if missing := [name for name in modules if name not in graph.modules]:
        raise KeyError(", ".join(missing))
    while todo:
        everything |= {*todo, *(above for module in todo for above in graph.find_upstream_modules(module))}
        catalogs = [f"suchus.{name}" for name in CATALOGS if f"suchus.{name}" in everything]
        todo = [m for catalog in catalogs for m in graph.find_descendants(catalog) if m not in everything]
    return frozenset(everything)


def digest(modules: Iterable[str], package: Path = PACKAGE) -> str:
    """Return the first 16 digits of the SHA-256 of what some modules do, and of the data beside them.

    Comments, docstrings and line breaks change nothing; the order of the modules neither.

    Args:
        modules: full names.
        package: folder of the package whose sources are read.

    Raises:
        SyntaxError: a source is no Python.
    """
    text = hashlib.sha256()
    for file in sorted(files(modules, package), key=lambda file: _name(file, package)):
        stamp = file.stat()
        text.update(_name(file, package).encode() + _content(file, stamp.st_mtime_ns, stamp.st_size))
    return text.hexdigest()[:16]


def _name(file: Path, package: Path) -> str:
    """Return the path of a file from the package on, or from the folder of evidence on."""
    folder = package if file.is_relative_to(package) else EVIDENCE.parent
    return file.relative_to(folder).as_posix()


@cache
def _content(file: Path, changed: int, size: int) -> bytes:  # noqa: ARG001  a file that is written anew is read anew
    """Return the SHA-256 of what a file does."""
    content = file.read_bytes()
    return hashlib.sha256(syntax_of(content) if file.suffix == ".py" else content).digest()


def files(modules: Iterable[str], suchus_package: Path = PACKAGE) -> Sequence[Path]:
    """Return the files of modules in alphabetical order, and the data files of their folders."""
    found = set[Path]()
    for module in modules:
        root, *names = module.split(".")
        package = suchus_package if root == "suchus" else EVIDENCE
        folder, file = package.joinpath(*names), package.joinpath(*names[:-1], f"{names[-1] if names else ''}.py")
        file = file if file.is_file() else folder / "__init__.py"
        found |= {file, *(data for data in file.parent.glob("*") if data.suffix in _DATA)}
    return sorted(file for file in found if file.is_file())
