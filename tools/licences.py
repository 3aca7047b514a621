"""Licences of all that suchus stands on: of every package of every extra, the development tools and those of a release.

``make licences``. Nothing is installed: pip works out what would be, and the packages' own statements are read. The
packages without one are named at the end.
"""

import json
import re
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from needs import PROJECT, needs
from release.environment import PINNED, ROOT, Failed, run

_TOLD = "License :: OSI Approved :: "


def licence(metadata: Mapping[str, Any]) -> str:
    """Return what a package says of its licence; empty where it says nothing.

    Args:
        metadata: of the package, as pip reports them.
    """
    classified = [one.removeprefix(_TOLD) for one in metadata.get("classifier", ()) if one.startswith(_TOLD)]
    written = (metadata.get("license") or "").strip().splitlines()  # some put its whole text there
    return metadata.get("license_expression") or ", ".join(classified) or (written[0][:60] if written else "")


def table(packages: Iterable[Mapping[str, Any]], whose: Mapping[str, set[str]]) -> tuple[list[str], list[str]]:
    """Return rows of packages, and the names of those that do not say their licence.

    Args:
        packages: their metadata.
        whose: for each set of requirements, the packages that it brings, by their names in small letters.
    """
    rows, silent = ["| package | version | licence | of |", "|---|---|---|---|"], []
    for one in sorted(packages, key=lambda one: plain(one["name"])):
        of = [name for name, brought in whose.items() if plain(one["name"]) in brought]
        rows.append(f"| {one['name']} | {one['version']} | {licence(one) or '**none said**'} | {', '.join(of)} |")
        silent += [one["name"]] * (not licence(one))
    return rows, silent


def plain(name: str) -> str:
    """Return a package's name as an index compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def packages(requirements: Iterable[str], place: Path, *pinned: Path) -> list[dict[str, Any]]:
    """Return the metadata of all that some requirements would bring into an empty environment.

    Raises:
        Failed: they cannot be had.
    """
    asked, report = place / "asked.txt", place / "report.json"
    asked.write_text("\n".join(requirements), encoding="utf-8")
    words = ["--quiet", "--disable-pip-version-check", "install", "--dry-run", "--ignore-installed"]
    words += [word for file in pinned for word in ("--constraint", str(file))]
    run([sys.executable, "-m", "pip", *words, "--report", report, "--requirement", asked], cwd=place)
    return [one["metadata"] for one in json.loads(report.read_text(encoding="utf-8"))["install"]]


def main() -> int:
    """Print the table."""
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    versions = ROOT / "constraints.txt"
    every, whose = dict[str, dict[str, Any]](), dict[str, set[str]]()
    with tempfile.TemporaryDirectory(prefix="suchus-licences-") as folder:
        for name in ("", *project["optional-dependencies"]):
            print(f"looking at what {name or 'suchus itself'} needs ...", file=sys.stderr, flush=True)
            try:
                found = packages(needs(project, [name] if name else []), Path(folder), versions)
            except Failed as error:
                print(f"What {name or 'suchus itself'} needs is not to be had: {error}", file=sys.stderr)
                return 1
            whose[name or "all"] = {plain(one["name"]) for one in found}
            every |= {plain(one["name"]): one for one in found}
        tools = [line for line in PINNED.with_name("constraints.txt").read_text("utf-8").splitlines() if "==" in line]
        found = packages(tools, Path(folder))
        whose["release"] = {plain(one["name"]) for one in found}
        every |= {plain(one["name"]): one for one in found if plain(one["name"]) not in every}
    for name in list(whose)[1:]:
        whose[name] -= whose["all"]
    rows, silent = table(every.values(), whose)
    print("\n".join(rows))
    if silent:
        print(f"\n{', '.join(silent)}: no licence is said in the metadata; look into the package.", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
