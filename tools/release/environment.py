"""A fresh environment: an interpreter with its packages, and commands that run in it away from the checkout."""

import os
import re
import shlex
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[2]
PINNED = Path(__file__).with_name("pins.txt")
"""Versions and digests of what builds and checks a release."""
_OURS = ("PYTHONPATH", "PYTHONHOME", "PIP_CONSTRAINT", "VIRTUAL_ENV", "UV_CONSTRAINT", "SUCHUS_THREADS")


class Failed(Exception):
    """A command that ended badly; its output stands in the message."""


def pins(text: str) -> dict[str, str]:
    """Return the entries of a file of pins by their packages' names, each a version with its digests."""
    joined = (entry for entry in re.split(r"(?<!\\)\n", text) if "==" in entry)
    return {entry.partition("==")[0]: entry for entry in joined}


def clean(path: str = "") -> dict[str, str]:
    """Return the variables of a user who has no checkout.

    Args:
        path: a folder that comes first on ``PATH``.
    """
    kept = {name: value for name, value in os.environ.items() if name not in _OURS}
    if path:
        kept["PATH"] = path + os.pathsep + kept.get("PATH", "")
    return kept


def run(words: Sequence[str | Path], *, cwd: Path, env: dict[str, str] | None = None) -> str:
    """Run a command and return what it printed on standard output.

    Raises:
        Failed: its exit code is not 0.
    """
    command = [str(word) for word in words]
    done = subprocess.run(command, cwd=cwd, env=env or clean(), capture_output=True, text=True, check=False)
    if done.returncode:
        tail = "\n".join((done.stdout + done.stderr).splitlines()[-25:])
        raise Failed(f"{shlex.join(command)} ended with {done.returncode}:\n{tail}")
    return done.stdout


@dataclass(frozen=True, slots=True)
class Environment:
    """A virtual environment in a folder."""

    folder: Path
    """Where it is."""
    python: str = field(default=sys.executable)
    """The interpreter that it is made with."""

    @property
    def bin(self) -> Path:
        """Where its commands are."""
        return self.folder / "bin"

    def make(self) -> "Environment":
        """Make it, with pip, if it is not there."""
        if not (self.bin / "python").exists():
            run([self.python, "-m", "venv", self.folder], cwd=self.folder.parent)
        return self

    def pip(self, *words: str | Path) -> None:
        """Install."""
        run([self.bin / "python", "-m", "pip", "--quiet", "install", *words], cwd=self.folder.parent)

    def pip_if_served(self, name: str) -> bool:
        """Install a tool in the version of ``PINNED`` and return True, or False where it is not to be had.

        Its files and those of all that it needs are compared with their digests. pip is pinned first: an old one does
        not compare what is asked for by name.
        """
        pip = self.folder / "pip.txt"
        try:
            if not pip.exists():
                pip.write_text(pins(PINNED.read_text(encoding="utf-8"))["pip"], encoding="utf-8")
                self.pip("--require-hashes", "--requirement", pip)
            self.pip("--require-hashes", "--constraint", PINNED, "--build-constraint", PINNED, name)
        except Failed:
            return False
        return True

    def suchus(self, *words: str, cwd: Path) -> tuple[str, float]:
        """Run a command of suchus; return what it printed, and how long it took [s]."""
        start = time.monotonic()
        printed = run([self.bin / "suchus", *words], cwd=cwd, env=clean(str(self.bin)))
        return printed, time.monotonic() - start
