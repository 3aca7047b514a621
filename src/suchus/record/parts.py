"""Long work in parts: what was finished before an interruption is not done again."""

import hashlib
import logging
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from suchus.errors import IncompatibleRecord, UnreadableFile
from suchus.record.provenance import digest, versions
from suchus.record.store import load, save

_PACKAGE = Path(__file__).parent.parent
_LOG = logging.getLogger(__name__)


def code_digest(rooms: Sequence[str]) -> str:
    """Return the SHA-256 of the source of some rooms or modules of suchus.

    Args:
        rooms: names of folders or of modules, as ``land`` or ``experiments/sensitivity.py``.
    """
    files = [file for room in rooms for file in sorted(_sources(_PACKAGE / room))]
    text = hashlib.sha256()
    for file in files:
        text.update(file.relative_to(_PACKAGE).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()


def _sources(place: Path) -> list[Path]:
    return [place] if place.is_file() else list(place.rglob("*.py"))


class Parts:
    """The finished parts of one piece of work, each a NetCDF file.

    Whatever was asked and whatever made it, code and versions included, names the folder: a part never outlives what
    it came from. Each part appears complete or not at all, so that work may be interrupted at any time.

    Args:
        place: folder for the parts of all work, ``~`` is the user's; None keeps nothing.
        asked: settings that the parts depend on.
        rooms: of suchus whose code they depend on, see ``code_digest``.
    """

    def __init__(self, place: Path | None, asked: Mapping[str, Any], rooms: Sequence[str]) -> None:
        self.folder: Path | None = None
        if place is not None:
            made_by = digest({"asked": asked, "code": code_digest(rooms), "versions": versions()})
            self.folder = place.expanduser() / made_by[:16]

    def get(self, name: str, make: Callable[[], xr.Dataset]) -> xr.Dataset:
        """Return a part, from the folder if it is there, else made, and kept.

        Args:
            name: of the part.
            make: makes it; the same every time.

        Raises:
            Unwritable: the folder cannot be written to.
        """
        if self.folder is None:
            return make()
        file = self.folder / f"{name}.nc"
        if file.is_file():
            try:
                return load(file, whole=True)
            except (IncompatibleRecord, UnreadableFile):
                _LOG.warning("%s is damaged and is made again.", file)
        save(make(), file)
        return load(file)
