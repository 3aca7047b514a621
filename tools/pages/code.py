"""The code as its text describes it: rooms, public names, and which part of the article a docstring names.

Everything is read, nothing is imported, so that a page can be made of rooms whose extras are not installed.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src" / "suchus"
BY_MODULE = (
    "visual.figures", "experiments.catalog", "robot.robots", "robot.gaits", "visual.skin", "visual.replay",
    "apps.viewer", "apps.envs",
)  # fmt: skip
"""Rooms whose modules are used under their own names, beside what the room itself exports."""


@dataclass(frozen=True, slots=True)
class PaperReference:
    """A docstring that names a part of the article."""

    name: str
    """Dotted name of the function, class or module."""
    shown: str
    """The name as people call it, without ``suchus``."""
    paper: str
    """What stands after ``Paper:``."""


@cache
def rooms() -> list[str]:
    """Return the dotted names of all rooms: packages and modules of a wing, or the wing itself if it exports names."""
    names = []
    for wing in wings():
        below = [f"{wing}.{p.parent.name}" for p in (SOURCE / wing).glob("*/__init__.py")]
        alone = [f"{wing}.{p.stem}" for p in (SOURCE / wing).glob("*.py") if not p.stem.startswith("_")]
        names += [wing, *below] if exported(wing) else [*below, *alone]
    return sorted(names)


@cache
def wings() -> list[str]:
    """Return the names of all wings: the folders of the package."""
    return sorted(p.parent.name for p in SOURCE.glob("*/__init__.py"))


def folder_of(room: str) -> Path:
    """Return the folder of a room, or of a module that stands alone its path without the ending."""
    return SOURCE.joinpath(*room.split("."))


def about(room: str) -> str:
    """Return the first line of a room's docstring."""
    return (ast.get_docstring(_tree(_file(room))) or "").partition("\n")[0]


def exported(room: str) -> list[str]:
    """Return the names that a room exports."""
    for node in _tree(_file(room)).body:
        match node:
            case ast.Assign(targets=[ast.Name(id="__all__")], value=ast.List(elts=names)):
                return [str(ast.literal_eval(name)) for name in names]
            case _:
                continue
    return []


def modules(room: str) -> list[str]:
    """Return the modules of a room that a user names: those it exports, or all that declare something public."""
    folder = folder_of(room)
    if not folder.is_dir():
        return []
    wanted = {p.stem for p in folder.glob("*.py") if not p.stem.startswith("_")}
    for below in (p.parent for p in folder.glob("*/__init__.py")):
        inside = [f"{below.name}.{p.stem}" for p in below.glob("*.py") if not p.stem.startswith("_")]
        wanted |= {below.name} if exported(f"{room}.{below.name}") else set(inside)
    return sorted(wanted if room in BY_MODULE else wanted & (set(exported(room)) - _defined(room)))


def public(module: str) -> list[str]:
    """Return the public functions, classes and constants of a module, given by its dotted name."""
    path = SOURCE.joinpath(*module.split(".")[1:])
    tree = _tree(path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))
    names = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.append(node.name)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names += [t.id for t in targets if isinstance(t, ast.Name)]
    return [name for name in names if not name.startswith("_")]


def papers() -> Iterator[PaperReference]:
    """Yield every docstring that says ``Paper: ...``."""
    for file in sorted(SOURCE.rglob("*.py")):
        module = ".".join(["suchus", *file.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__")
        if "Paper: " in file.read_text(encoding="utf-8"):  # to take all sources apart takes seconds
            yield from _papers(_tree(file), module)


def _papers(node: ast.AST, name: str) -> Iterator[PaperReference]:
    if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
        found = re.search(r"Paper: (.*?)(?:\n\n|\Z)", ast.get_docstring(node) or "", re.S)
        if found:
            yield PaperReference(_at_home(name), name.removeprefix("suchus."), " ".join(found[1].split()).rstrip("."))
        for child in node.body:
            if isinstance(child, ast.ClassDef | ast.FunctionDef) and not child.name.startswith("_"):
                yield from _papers(child, f"{name}.{child.name}")


def home(room: str, name: str) -> str:
    """Return the dotted name under which the reference has what a room exports.

    That is the room's own page, unless a module hides the name of what it declares, as in
    ``suchus.swimming.water.fit``.
    """
    hidden = (folder_of(room) / f"{name}.py").is_file() and name in _defined(room)
    return f"suchus.{room}.{name}.{name}" if hidden else f"suchus.{room}.{name}"


def _at_home(name: str) -> str:
    last = name.rpartition(".")[2]
    room = max((room for room in rooms() if name.startswith(f"suchus.{room}.")), key=len, default="")
    return home(room, last) if room and folder_of(room).is_dir() and last in exported(room) else name


def _defined(room: str) -> set[str]:
    """Names that a room imports from its modules: they are functions or classes even if a module is called alike."""
    return {
        alias.asname or alias.name
        for node in _tree(_file(room)).body
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(f"suchus.{room}.")
        for alias in node.names
    }


def _file(room: str) -> Path:
    folder = folder_of(room)
    return folder / "__init__.py" if folder.is_dir() else folder.with_name(f"{folder.name}.py")


@cache
def _tree(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))
