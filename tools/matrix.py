"""Try suchus on every Python that is here, with the newest and the lowest versions of its ranges, for ``make matrix``.

Usage: python tools/matrix.py [--only 3.12-lowest ...] [TESTS ...]

Each environment gets the wheel, the extras ``viewer``, ``optimise``, ``gym`` and ``usd``, and pytest. In it run
``suchus doctor`` and ``suchus demo --no-browser``, in an empty folder, then the tests named (by default the rooms that
are quick and touch every library). Interpreters are those on the path and pyenv's; none is downloaded. The packages
come by ``uv``, which can take the lowest versions. A line for each says what worked; logs are in build/matrix. The
result of each stays in tests/release/matrix.json, and the table of docs/publishing.md is made of it.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

from pages.passages import put
from release import distributions
from release.environment import ROOT, Environment, Failed, clean, run

PYTHONS = ("3.11", "3.12", "3.13", "3.14")
VERSIONS = {"newest": "highest", "lowest": "lowest-direct"}
"""Of packages, and what uv calls it."""
EXTRAS = ("viewer", "optimise", "gym", "usd")
TESTERS = ("pytest", "pytest-xdist", "hypothesis", "beartype")
"""Packages of the extra ``dev`` that tests need."""
TESTS = ("blueprint", "control", "design", "faults", "kinematics", "metrics", "model", "motion", "paper", "record",
         "shelves", "skin", "verdict", "replay", "hardware", "land")  # fmt: skip
NAMED = ("mujoco", "numpy", "numba", "scipy", "xarray", "pydantic")
"""Packages whose versions the table names."""
KEPT = ROOT / "tests" / "release" / "matrix.json"
PAGE = ROOT / "docs" / "publishing.md"


@dataclass(frozen=True, slots=True)
class Cell:
    """Result in one environment."""

    name: str
    """Python and versions, such as 3.12-lowest."""
    line: str
    """In a line."""
    sound: bool
    """Whether it works, or cannot be had."""
    versions: dict[str, str] = field(default_factory=dict)
    """Of ``NAMED``; nothing where it was not installed."""
    why: str = ""
    """What the installer said, which may name places of this machine and is not kept."""


def main(words: list[str] | None = None) -> int:
    """Fill the table; return 1 where an environment that can be had does not work."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--only", action="append", default=[], metavar="3.12-lowest")
    parser.add_argument("tests", nargs="*", default=[f"tests/{room}" for room in TESTS])
    asked = parser.parse_args(words)
    place = ROOT / "build" / "matrix"
    place.mkdir(parents=True, exist_ok=True)
    tools = Environment(place / "tools").make()
    if not tools.pip_if_served("uv"):
        print("uv is not to be had, so there are no lowest versions to try.", file=sys.stderr)
        return 1
    wheel, _ = distributions.build(tools, place / "dist")
    cells = []
    for python in PYTHONS:
        interpreter = found(python)
        for versions in VERSIONS:
            name = f"{python}-{versions}"
            if asked.only and name not in asked.only:
                continue
            cells.append(_cell(name, interpreter, wheel, tools, place, asked.tests))
            print(f"{cells[-1].name:12s} {cells[-1].line} {cells[-1].why}", flush=True)
            keep(cells[-1])
    return 0 if all(cell.sound for cell in cells) else 1


def keep(cell: Cell) -> None:
    """Put the result in an environment into ``KEPT``, and the table of all into ``PAGE``."""
    every = json.loads(KEPT.read_text(encoding="utf-8"))
    values = {name: value for name, value in asdict(cell).items() if name not in ("name", "why")}
    every[cell.name] = {"date": date.today().isoformat(), **values}
    KEPT.write_text(json.dumps(dict(sorted(every.items())), indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(put(PAGE.read_text(encoding="utf-8"), {"matrix": table(every)}), encoding="utf-8")


def table(every: dict[str, dict[str, Any]]) -> str:
    """Return what is kept of environments as a table, a row for each Python."""
    rows = [["Python", *VERSIONS], ["---"] * 3]
    rows += [[python, *(_in_words(every.get(f"{python}-{versions}")) for versions in VERSIONS)] for python in PYTHONS]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _in_words(cell: dict[str, Any] | None) -> str:
    if cell is None:
        return "not tried yet"
    names = ", ".join(f"{name} {version}" for name, version in cell["versions"].items())
    return f"{cell['date']}{'' if cell['sound'] else ' **fails**'}: {cell['line']}{f' ({names})' if names else ''}"


def found(python: str) -> str | None:
    """Return an interpreter of a version that answers, or None."""
    pyenv = sorted(Path.home().glob(f".pyenv/versions/{python}.*/bin/python"), reverse=True)
    for one in filter(None, (*map(str, pyenv), shutil.which(f"python{python}"))):
        said = subprocess.run([one, "--version"], capture_output=True, text=True, check=False)
        if said.returncode == 0 and said.stdout.startswith(f"Python {python}."):
            return one
    return None


def testers() -> list[str]:
    """Return what tests need, with the ranges of pyproject.toml."""
    extras = distributions.project()["optional-dependencies"]
    return [need for need in extras["dev"] if re.split(r"[<>=!\[]", need)[0] in TESTERS]


def _cell(name: str, interpreter: str | None, wheel: Path, tools: Environment, place: Path, tests: list[str]) -> Cell:
    if interpreter is None:
        why = _unserved(name, tools, place)
        whether = "cannot be had together" if why else "can be had together"
        return Cell(name, f"packages {whether}; no interpreter here", sound=True, why=why)
    start = time.monotonic()
    environment = Environment(place / name, interpreter)
    shutil.rmtree(environment.folder, ignore_errors=True)
    try:
        _install(environment.make(), name, wheel, tools)
    except Failed as error:
        (place / f"{name}.log").write_text(str(error), encoding="utf-8")
        return Cell(name, f"cannot be installed, see build/matrix/{name}.log", sound=False, why=_reason(error))
    steps = [results for _, results in _steps(environment, place / f"{name}.log", tests)]
    wrong = [results for results in steps if not results.startswith("ok")]
    results = f"{'; '.join(wrong or steps)} ({time.monotonic() - start:.0f} s)"
    return Cell(name, results, sound=not wrong, versions=_versions(environment))


def _versions(environment: Environment) -> dict[str, str]:
    code = f"import importlib.metadata as m, json; print(json.dumps({{n: m.version(n) for n in {NAMED!r}}}))"
    versions: dict[str, str] = json.loads(run([environment.bin / "python", "-c", code], cwd=environment.folder))
    return versions


def _install(environment: Environment, name: str, wheel: Path, tools: Environment) -> None:
    strategy = VERSIONS[name.partition("-")[2]]
    into = [tools.bin / "uv", "pip", "install", "--quiet", "--python", environment.bin / "python"]
    extras = [word for extra in EXTRAS for word in ("--extra", extra)]
    run([*into, "--resolution", strategy, "--no-build", "-r", ROOT / "pyproject.toml", *extras, *testers()], cwd=ROOT)
    run([*into, "--no-deps", "--reinstall", wheel], cwd=ROOT)


def _steps(environment: Environment, log: Path, tests: list[str]) -> Iterator[tuple[str, str]]:
    """Yield what each trial came to: ``ok`` and more, or what went wrong."""
    python = environment.bin / "python"
    work = environment.folder / "an empty folder"
    work.mkdir(exist_ok=True)
    with log.open("w", encoding="utf-8") as out:
        for words in (("doctor",), ("demo", "--no-browser")):
            done = subprocess.run(
                [python, "-P", "-m", "suchus", *words], cwd=work, env=clean(str(environment.bin)),
                stdout=out, stderr=subprocess.STDOUT, check=False,
            )  # fmt: skip
            ends = f"suchus {words[0]} ends with {done.returncode}"
            yield words[0], ends if done.returncode else f"ok: {words[0]}"
        out.flush()
        heard = ["-W", "default::DeprecationWarning"]  # old releases use what newer ones of others will drop
        command = [python, "-P", "-m", "pytest", "-n0", "-m", "not validate", "-p", "no:cacheprovider", *heard, *tests]
        done = subprocess.run(command, cwd=ROOT, env=clean(), stdout=out, stderr=subprocess.STDOUT, check=False)
    last = (log.read_text(encoding="utf-8").strip().splitlines() or [""])[-1].strip("= ")
    where = ", ".join(test.removeprefix("tests/") for test in tests)
    yield "tests", f"{'ok' if done.returncode == 0 else 'tests'}: {last}, of {where}"


def _unserved(name: str, tools: Environment, place: Path) -> str:
    """Say why the ranges could not be met on a Python that is not here, or nothing if they could."""
    python, _, versions = name.partition("-")
    words = [tools.bin / "uv", "pip", "compile", "--quiet", "--python-version", python, "--no-build", "--resolution",
             VERSIONS[versions], "-o", place / f"{name}.txt", ROOT / "pyproject.toml"]  # fmt: skip
    try:
        run(words, cwd=place)
    except Failed as error:
        return _reason(error)
    return ""


def _reason(error: Failed) -> str:
    return " ".join(str(error).split())[-300:]


if __name__ == "__main__":
    sys.exit(main())
