"""A Dockerfile without Docker: read, and its steps done in a fresh virtual environment.

What only the root of a container may do (``apt-get``, ``useradd``) is left out, and said.
"""

import json
import re
import shlex
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from release.environment import Environment, clean, run

_FOR_ROOT = ("apt-get", "useradd")


@dataclass(frozen=True, slots=True)
class Step:
    """An instruction."""

    word: str
    """What it is, such as RUN."""
    rest: str
    """What follows it, on one line."""


def steps(text: str) -> list[Step]:
    """Return the instructions of a Dockerfile.

    Raises:
        ValueError: a line is no instruction.
    """
    joined = re.sub(r"\\\n\s*", "", re.sub(r"^\s*#.*\n", "", text, flags=re.M))
    found = []
    for line in filter(None, map(str.strip, joined.splitlines())):
        word, _, rest = line.partition(" ")
        if not word.isupper() or not rest:
            raise ValueError(f"{line!r} is no instruction of a Dockerfile.")
        found.append(Step(word, rest.strip()))
    return found


def copied(instructions: Sequence[Step]) -> list[str]:
    """Return what is copied from the checkout."""
    return [name for step in instructions if step.word == "COPY" for name in shlex.split(step.rest)[:-1]]


def begins(instructions: Sequence[Step]) -> list[str]:
    """Return the words that a container begins with when nothing else is said."""
    last = {step.word: step.rest for step in instructions}
    return [*json.loads(last["ENTRYPOINT"]), *json.loads(last["CMD"])]


def follow(instructions: Sequence[Step], context: Path, root: Path, environment: Environment) -> list[str]:
    """Do the steps in a folder that stands for the container's, and return those that were left out.

    Args:
        instructions: of the Dockerfile.
        context: the checkout.
        root: an empty folder.
        environment: whose commands come first.
    """
    here, left_out = root, []
    for step in instructions:
        if step.word == "WORKDIR":
            here = root / step.rest.lstrip("/")
            here.mkdir(parents=True, exist_ok=True)
        elif step.word == "COPY":
            *names, target = shlex.split(step.rest)
            for name in names:
                place = here / target / name if target.endswith("/") else here / target
                _copy(context / name, place)
        elif step.word == "RUN" and step.rest.split()[0] in _FOR_ROOT:
            left_out.append(step.rest)
        elif step.word == "RUN":
            run(["/bin/sh", "-c", step.rest], cwd=here, env=clean(str(environment.bin)))
    run(begins(instructions), cwd=here, env=clean(str(environment.bin)))
    return left_out


def _copy(source: Path, target: Path) -> None:
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    else:
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
