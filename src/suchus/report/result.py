"""A saved outcome, read back for the page: the page is made of files and simulates nothing."""

import base64
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from suchus.errors import IncompatibleRecord, UnreadableFile
from suchus.report.saving import OUTCOME

_HEAVY = 400_000  # bytes of SVG beyond which the PNG is shown, if that is lighter


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A figure ready for a page."""

    name: str
    """Its file's name without the ending."""
    caption: str
    """What it shows."""
    source: str
    """The picture itself as a data URI."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """What a folder of results holds."""

    told: Mapping[str, Any]
    """What ``outcome.json`` says."""
    pictures: tuple[Picture, ...]
    """The figures."""
    tables: Mapping[str, str]
    """Further texts by file name."""

    @property
    def name(self) -> str:
        """Name of the experiment."""
        return str(self.told["experiment"])


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """An experiment that came to no result."""

    name: str
    """Name of the experiment."""
    sentence: str
    """What went wrong."""
    trace: str = ""
    """Where in the code, if it was none of our own errors."""


def load_result(folder: Path) -> Result:
    """Read a folder that ``save_outcome`` wrote.

    Raises:
        UnreadableFile: there is no outcome in it.
        IncompatibleRecord: it says something else than an outcome should.
    """
    file = folder / OUTCOME
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
        pictures = tuple(
            Picture(name=f["name"], caption=f["caption"], source=_picture(folder, f["name"])) for f in told["figures"]
        )
        tables = {name: (folder / name).read_text(encoding="utf-8") for name in told["tables"]}
        wanted = ("experiment", "title", "shows", "decides", "command", "measures", "verdicts", "provenance")
        missing = [key for key in wanted if key not in told]
    except OSError as error:
        raise UnreadableFile(f"{error.filename} cannot be read: {(error.strerror or '').lower()}.") from error
    except (ValueError, KeyError, TypeError) as error:
        raise IncompatibleRecord(f"{file} is no outcome of suchus: {error}.") from error
    if missing:
        raise IncompatibleRecord(f"{file} lacks {', '.join(missing)}.")
    return Result(told=told, pictures=pictures, tables=tables)


def data_uri(file: Path) -> str:
    """Return an SVG or PNG file as a data URI."""
    kind = {".svg": "image/svg+xml", ".png": "image/png"}[file.suffix]
    return f"data:{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"


def _picture(folder: Path, name: str) -> str:
    svg, png = folder / f"{name}.svg", folder / f"{name}.png"
    return data_uri(png if svg.stat().st_size > max(_HEAVY, png.stat().st_size) else svg)
