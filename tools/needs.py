"""Print what suchus needs, a requirement a line: what every user gets, and what the extras named add.

``python tools/needs.py viewer optimise``; the Makefile and the Dockerfile give the lines to pip together with
``pins.txt``, since pip compares digests of packages only where none of what it installs is a folder.
"""

import re
import sys
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).parents[1] / "pyproject.toml"
_OWN = re.compile(r"suchus\[([\w,]+)\]")


def needs(project: dict[str, Any], extras: Iterable[str]) -> list[str]:
    """Return requirements, each once.

    Args:
        project: the table ``[project]`` of a pyproject.toml.
        extras: their names; an extra that asks for others of suchus brings what they ask for.

    Raises:
        KeyError: there is no such extra.
    """
    found = list(project["dependencies"])
    for extra in extras:
        for need in project["optional-dependencies"][extra]:
            own = _OWN.fullmatch(need)
            found += needs(project, own[1].split(",")) if own else [need]
    return list(dict.fromkeys(found))


if __name__ == "__main__":
    print("\n".join(needs(tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"], sys.argv[1:])))
