"""A robot of another tool, URDF or MJCF, that a command is given in the place of a robot's own file."""

import re
import shlex
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

from suchus.apps.cli.entry import BadCommand, printable
from suchus.core.errors import SuchusError
from suchus.robot.design import Robot
from suchus.robot.robots import FOREIGN_ENDINGS, ROBOTS

_OPTION = re.compile(r"--(front|heading|up|neck|tail|leave|foot-radius|packages|without-meshes)\b")
"""Options of ``suchus import``; an error that names none of them is mended in the file."""
_pending_notes: dict[str, tuple[str, ...]] = {}
"""What was guessed of each file and is not printed yet, by the word that names it."""


def resolve_robot(word: str) -> Robot:
    """Return the robot that a word names: of the catalog, of a TOML file, or of a URDF or an MJCF.

    What an import guesses is printed by ``print_notes``, since standard error is captured while words are parsed.

    Raises:
        SuchusError: there is no such robot, or its file cannot be imported without further options.
    """
    if Path(word).suffix.lower() not in FOREIGN_ENDINGS:
        robot: Robot = ROBOTS.resolve(word)
        return robot
    try:
        stamp = Path(word).stat().st_mtime_ns
    except OSError:
        stamp = 0
    draft = _draft(str(Path(word).absolute()), word, stamp)
    _pending_notes[word] = draft.remarks
    imported: Robot = draft.robot
    return imported


def print_notes() -> None:
    """Print what was guessed of the files that were read, once each, on standard error."""
    for remarks in _pending_notes.values():
        for remark in remarks:
            print(printable(f"note: {remark}"), file=sys.stderr)
    _pending_notes.clear()


def drop_notes() -> None:
    """Drop what was guessed for a command that was refused before it printed that."""
    _pending_notes.clear()


@lru_cache(maxsize=8)
def _draft(absolute_path: str, word: str, stamp: int) -> Any:
    """Return the draft of a file as it was at a time.

    Args:
        absolute_path: path of the file.
        word: path as the user gave it.
        stamp: when it was changed [ns].
    """
    del absolute_path, stamp
    from suchus.sim.model.importing import import_robot  # noqa: PLC0415  MuJoCo is loaded by who imports

    path = Path(word)
    try:
        return import_robot(path, name=path.stem)
    except SuchusError as error:
        if not _OPTION.search(str(error)):
            raise
        line = shlex.join(["suchus", "import", word])
        raise BadCommand(
            f"{str(error).rstrip('.')}. A file that needs options is imported first: {line} --help names them; then "
            f"say --robot {path.stem}.toml."
        ) from error
