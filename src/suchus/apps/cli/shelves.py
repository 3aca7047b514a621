"""``suchus list``: what stands in the catalogs; of suchus' own nothing is imported."""

import ast
import tokenize
import zipfile
from collections.abc import Sequence
from pathlib import Path
from pkgutil import resolve_name
from shutil import get_terminal_size
from textwrap import fill

from suchus.apps.cli.command import REFUSAL
from suchus.apps.cli.entry import PROJECT, BadCommand, reserved_names
from suchus.core.errors import SuchusError
from suchus.core.sources import SHELVES, Source, gather, kind_of

_LISTED = {
    "robots": "suchus.robot.robots:ROBOTS",
    "gaits": "suchus.robot.gaits:GAITS",
    "faults": "suchus.sim.faults:FAULTS",
    "experiments": "suchus.experiments.catalog:EXPERIMENTS",
    "controllers": "suchus.robot.control:CONTROLLERS",
    "measures": "suchus.experiments.study:MEASURES",
    "commands": "suchus.apps.commands:COMMANDS",
    "protocols": "suchus.hardware.protocols:PROTOCOLS",
    "policies": "suchus.robot.policies:POLICIES",
}
"""Module and object of each catalog, by the catalog's name."""
_SCATTERED = ("controllers", "measures")
"""Catalogs whose modules declare things with names of their own."""
_NPY_PREAMBLE = 10  # magic string, version and length of the header of a file of NumPy [byte]
_USAGE = f"""usage: suchus list [{PROJECT} DIR]

Show what stands in the catalogs, each with its title. What a project folder or another package puts there is marked
with where it comes from; it is loaded, and shown as broken where that fails."""


def show(words: Sequence[str]) -> int:
    """Print every catalog and return 0."""
    if any(word in ("-h", "--help") for word in words):
        print(_USAGE)
        return 0
    if words:
        raise BadCommand(f"suchus list takes no {words[0]!r}.")
    shelves = {shelf: gather(kind_of(shelf), SHELVES[shelf], scattered=shelf in _SCATTERED) for shelf in _LISTED}
    width = max((len(name) for sources in shelves.values() for name in sources), default=0)
    for i, (shelf, sources) in enumerate((shelf, sources) for shelf, sources in shelves.items() if sources):
        print("\n" * bool(i) + shelf)
        for name, source in sources.items():
            print(entry(name, title(source) + _needs(source) + _origin(source, shelf), width))
    return 0


def entry(name: str, text: str, width: int) -> str:
    """Return a name and its title side by side, the title wrapped to the terminal."""
    columns = max(60, min(110, get_terminal_size().columns))
    return fill(text, columns, initial_indent=f"  {name:<{width}}  ", subsequent_indent=" " * (width + 4))


def title(source: Source) -> str:
    """Return the first line of the docstring of what is declared or of its module, or of a TOML file's comment."""
    if source.file is None:
        return ""
    if source.file.suffix == ".npz":
        return _policy_title(source.file)
    if source.file.suffix == ".toml":
        first_line = _text(source.file).lstrip().partition("\n")[0]
        return first_line.lstrip("# ") if first_line.startswith("#") else ""
    try:
        tree = ast.parse(_text(source.file))
    except (SyntaxError, ValueError):
        return "(cannot be read)"
    definitions = [node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))]
    docstring_owner = next((node for node in definitions if node.name == source.attribute), tree)
    return (ast.get_docstring(docstring_owner) or "").partition("\n")[0]


def _policy_title(file: Path) -> str:
    """Return task and robot of a policy, read without NumPy; empty where the file cannot be read."""
    try:
        with zipfile.ZipFile(file) as archive:
            return f"{_npy_text(archive.read('task.npy'))}, a policy of {_npy_text(archive.read('robot.npy'))}"
    except (OSError, KeyError, ValueError, zipfile.BadZipFile):
        return ""


def _npy_text(content: bytes) -> str:
    """Return the text in a file of NumPy that holds nothing else: its header begins with its length."""
    start = _NPY_PREAMBLE + int.from_bytes(content[_NPY_PREAMBLE - 2 : _NPY_PREAMBLE], "little")
    return content[start:].decode("utf-32-le").rstrip("\0")


def _needs(source: Source) -> str:
    """Return the capabilities that an experiment needs, or the robots for which a gait was made."""
    if source.attribute:
        return ""
    needs, robots = _assigned_texts(source, "needs"), _assigned_texts(source, "made_for")
    text = f" (needs {', '.join(needs).replace('_', ' ')})" if needs else ""
    return text + (f" (of {', '.join(robots)})" if robots else "")


def _origin(source: Source, shelf: str) -> str:
    """Return the source of a user's entry, the claims that it states, and the error if it cannot be loaded."""
    if source.shipped:
        return ""
    if shelf == "commands" and source.name in reserved_names():
        return f" [{REFUSAL}: {source.place}]"
    try:
        resolve_name(_LISTED[shelf])[source.name]
        claims = _own_claims(source.name) if shelf == "experiments" else ""
    except SuchusError as error:
        return f" [broken: {error}]"
    return f"{claims} [{source.place}]"


def _own_claims(experiment: str) -> str:
    """Return the claims that an experiment itself states, as the list shows them; empty without any.

    Raises:
        InvalidDesign: its claims or rules cannot be used.
    """
    resolve_name("suchus.experiments.claims:rules_of")(experiment)
    claims = resolve_name("suchus.experiments.claims:claims_of")(experiment)
    return f" (claims {', '.join(claims)})" if claims else ""


def _assigned_texts(source: Source, name: str) -> tuple[str, ...]:
    """Return the texts of an assignment in a module, or in a class of it, read without importing it."""
    if source.file is None or source.file.suffix != ".py":
        return ()
    try:
        for node in ast.walk(ast.parse(_text(source.file))):
            if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == name for t in node.targets):
                return tuple(str(text) for text in ast.literal_eval(node.value))
    except (SyntaxError, ValueError, TypeError):  # a text that is no literal
        return ()
    return ()


def _text(file: Path) -> str:
    """Return the text of a module or a TOML file."""
    try:
        with tokenize.open(file) if file.suffix == ".py" else file.open(encoding="utf-8") as stream:
            return stream.read()
    except (OSError, SyntaxError, UnicodeDecodeError) as error:
        raise ValueError(str(error)) from error
