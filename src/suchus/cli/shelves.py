"""``suchus list``: what stands on the shelves, listed without importing any of it."""

import ast
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from shutil import get_terminal_size
from textwrap import fill

from suchus.cli.commands import BadCommand

_SHELVES = (
    ("robots", "suchus.robots"),
    ("gaits", "suchus.gaits"),
    ("faults", "suchus.faults"),
    ("experiments", "suchus.experiments"),
)
_USAGE = "usage: suchus list\n\nShow the robots, the gaits, the faults and the experiments, each with its title."


def show(words: Sequence[str]) -> int:
    """Print every shelf and return 0."""
    if any(word in ("-h", "--help") for word in words):
        print(_USAGE)
        return 0
    if words:
        raise BadCommand(f"suchus list takes no {words[0]!r}.")
    shelves = [(heading, package, titles(package)) for heading, package in _SHELVES]
    width = max((len(name) for _, _, shelf in shelves for name in shelf), default=0)
    for i, (heading, package, shelf) in enumerate(shelves):
        print("\n" * bool(i) + heading)
        for name, title in shelf.items():
            needs, robots = _stated(package, name, "needs"), _stated(package, name, "made_for")
            more = f" (needs {', '.join(needs).replace('_', ' ')})" if needs else ""
            more += f" (of {', '.join(robots)})" if robots else ""
            print(entry(name, title + more, width))
    return 0


def entry(name: str, title: str, width: int) -> str:
    """Return a name and its title side by side, the title wrapped to the terminal."""
    columns = max(60, min(110, get_terminal_size().columns))
    return fill(title, columns, initial_indent=f"  {name:<{width}}  ", subsequent_indent=" " * (width + 4))


def titles(package: str) -> dict[str, str]:
    """Return the first line of each module's docstring by name, sorted by name."""
    spec = find_spec(package)
    folders = [Path(place) for place in (spec.submodule_search_locations or ())] if spec else []
    files = (file for folder in folders for file in folder.glob("*.py") if not file.stem.startswith("_"))
    return {file.stem: _title(file) for file in sorted(files, key=lambda file: file.stem)}


def _stated(package: str, name: str, what: str) -> tuple[str, ...]:
    """Return the texts of an assignment in a module, or in a class of it, read without importing it."""
    spec = find_spec(package)
    folders = (spec.submodule_search_locations or ()) if spec else ()
    file = next((Path(place) / f"{name}.py" for place in folders if (Path(place) / f"{name}.py").exists()), None)
    try:
        tree = ast.parse(file.read_text(encoding="utf-8")) if file else ast.Module(body=[], type_ignores=[])
    except (SyntaxError, UnicodeDecodeError):
        return ()
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == what for t in node.targets):
            value = ast.literal_eval(node.value)
            return tuple(str(one) for one in value)
    return ()


def _title(file: Path) -> str:
    try:
        text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8")))
    except (SyntaxError, UnicodeDecodeError):
        return "(cannot be read)"
    return (text or "").partition("\n")[0]
