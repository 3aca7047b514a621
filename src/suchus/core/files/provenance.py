"""Where a result comes from: what was asked, with which software, on what machine, how long it took. No dates."""

import ast
import hashlib
import json
import math
import platform
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path, PurePath
from typing import Any

from suchus.core import machine

_PACKAGE = Path(__file__).parents[2]
_NO_SYNTAX = frozenset({"lineno", "col_offset", "end_lineno", "end_col_offset", "ctx", "kind", "type_ignores"})
"""Attributes of nodes of syntax trees that are positions, or follow from the other nodes."""
_DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
"""Nodes of syntax trees whose bodies may hold docstrings."""
_PACKAGES = ("suchus", "mujoco", "numpy", "scipy", "numba", "xarray", "h5netcdf", "matplotlib")


def provenance(settings: Mapping[str, Any], *, seconds: float) -> dict[str, Any]:
    """Return where a result comes from; equal runs differ in ``seconds`` at most.

    Args:
        settings: the fields of the experiment; ``seed`` among them, if it has one.
        seconds: how long the run took, its last part where it went on from what was kept [s].
    """
    return {
        "config_hash": digest(settings),
        "versions": versions(),
        "machine": machine.provenance(),
        "code": package_digest(),
        "commit": package_commit(),
        "seed": plain(settings.get("seed")),
        "seconds": round(seconds, 3),
    }


def commit_of(root: str | Path, *folders: str) -> str:
    """Return the abbreviated commit of a checkout, with ``+`` behind it where files differ; empty outside of git.

    Args:
        root: root of the checkout.
        folders: folders below it whose files are compared with the commit.
    """
    if not (Path(root) / ".git").exists():
        return ""
    answers = []
    for words in (("rev-parse", "--short=10", "HEAD"), ("status", "--porcelain", "--", *folders)):
        try:
            done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True, check=False)
        except OSError:  # there is no git on this machine
            return ""
        if done.returncode:
            return ""
        answers.append(done.stdout.strip())
    return answers[0] + "+" * bool(answers[1])


@cache
def package_commit() -> str:
    """Return the commit of the checkout from which suchus runs, looked up once; empty for an installed package."""
    return commit_of(_PACKAGE.parents[1], "src")


def digest(settings: Mapping[str, Any]) -> str:
    """Return the SHA-256 of the settings, the same on every machine and in any order of keys."""
    text = json.dumps(plain(settings), sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def versions() -> dict[str, str]:
    """Return the version of Python and of every package that can change a number or a picture."""
    return {"python": platform.python_version(), **{name: _installed_version(name) for name in _PACKAGES}}


@cache
def _installed_version(package: str) -> str:
    """Return the version of a package, looked up once: the search goes through all installed packages."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


@cache
def code_digest(*paths: str) -> str:
    """Return the SHA-256 of the syntax trees of some packages or modules of suchus, and of their data.

    Comments, docstrings and line breaks change nothing.

    Args:
        paths: paths of folders or of modules, as ``sim/land`` or ``experiments/study/claims.py``.

    Raises:
        FileNotFoundError: there is no such folder or module.
    """
    text = hashlib.sha256()
    for path in paths:
        location = _PACKAGE / path
        if not location.exists():
            raise FileNotFoundError(f"suchus has no {path}, whose source was to be compared.")
        for file in [location] if location.is_file() else sorted([*location.rglob("*.py"), *location.rglob("*.toml")]):
            source = file.read_bytes() if file.suffix == ".toml" else _syntax_of_file(file)
            text.update(file.relative_to(_PACKAGE).as_posix().encode() + b"\0" + source + b"\0")
    return text.hexdigest()


@cache
def _syntax_of_file(file: Path) -> bytes:
    """Return the syntax tree of a module of suchus; most digests are of overlapping sets of modules."""
    return syntax_of(file.read_bytes())


def syntax_of(source: bytes) -> bytes:
    """Return the syntax tree of a module as text, without docstrings: equal for sources that do the same.

    The text is the same under every version of Python that has the same grammar: fields that are empty are left out,
    since ``ast.dump`` writes them in some versions only.

    Raises:
        SyntaxError: the source is no Python.
    """
    text: list[str] = []
    _write(ast.parse(source), text.append)
    return "".join(text).encode()


def is_docstring(statement: ast.stmt) -> bool:
    """Return whether a statement is a text alone: a docstring of a module, class, function or field."""
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _write(node: ast.AST, write: Callable[[str], None]) -> None:
    """Write a syntax tree without positions and docstrings."""
    write(f"{type(node).__name__}(")
    for name, value in node.__dict__.items():
        if name in _NO_SYNTAX or value is None:
            continue
        elements = value if isinstance(value, list) else (value,)
        if name == "body" and isinstance(node, _DOCUMENTED):
            elements = [statement for statement in elements if not is_docstring(statement)]
        if not elements:
            continue
        write(f"{name}=")
        for element in elements:
            if isinstance(element, ast.AST):
                _write(element, write)
            else:
                write(repr(element))
            write(",")
    write(")")


@cache
def package_digest() -> str:
    """Return the first 12 digits of the SHA-256 of every file of suchus: another one may mean other results."""
    text = hashlib.sha256()
    for file in sorted(_PACKAGE.rglob("*")):
        if "__pycache__" not in file.relative_to(_PACKAGE).parts and file.is_file():
            text.update(file.relative_to(_PACKAGE).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()[:12]


def has_same_provenance(stored: Mapping[str, Any], settings: Mapping[str, Any]) -> bool:
    """Return whether a result has these settings, code, versions and arithmetic, so that a run would repeat it.

    Args:
        stored: what ``provenance`` returned for it.
        settings: the fields of the experiment.
    """
    current_provenance, stored_machine = provenance(settings, seconds=0.0), stored.get("machine")
    same_arithmetic = (
        isinstance(stored_machine, dict)
        and stored_machine.get("arithmetic") == current_provenance["machine"]["arithmetic"]
    )
    return same_arithmetic and all(
        stored.get(name) == current_provenance[name] for name in ("config_hash", "versions", "code")
    )


def plain(value: Any) -> Any:
    """Return a value as JSON can hold it: dataclasses as objects, arrays and tuples as lists.

    Numbers that are not finite become the words ``nan``, ``inf`` and ``-inf``.

    Raises:
        TypeError: the value has no such form.
    """
    if value is None or isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else str(float(value))
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, (set, frozenset)):
        return sorted((plain(item) for item in value), key=repr)
    if isinstance(value, PurePath):
        return value.as_posix()
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    raise TypeError(f"a {type(value).__name__} cannot be written as JSON: {value!r}")
