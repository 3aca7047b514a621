"""A saved outcome, checked and read back for the page: the page is made of files and simulates nothing."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from markupsafe import Markup
from pydantic import BaseModel, ConfigDict, FiniteFloat, ValidationError

from suchus.article.verdict import Word
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.files import digest, read_json, read_text
from suchus.visual.figures import WIDTH
from suchus.visual.pages import as_pixels, embedded

OUTCOME = "outcome.json"
RECORD = "record.nc"


class _OutcomePart(BaseModel):
    model_config = ConfigDict(strict=True, extra="allow")


class _Measure(_OutcomePart):
    value: FiniteFloat | None
    unit: str
    time_step: FiniteFloat | None = None


class _Share(_OutcomePart):
    share: FiniteFloat
    low: FiniteFloat
    high: FiniteFloat
    designs: int
    turned_by: str = ""
    at: FiniteFloat | None = None
    above: bool = False


class _Verdict(_OutcomePart):
    claim: str
    quantity: str
    statement: str
    where: str
    printed: FiniteFloat | None
    measured: FiniteFloat | None
    unit: str
    verdict: Word
    why: str
    low: FiniteFloat | None = None
    high: FiniteFloat | None = None
    repeats: str = ""
    quote: str = ""
    rule: list[str] = []
    fragile: bool = False
    share: _Share | None = None
    unswept: str = ""
    too_few: str = ""
    time_step: str = ""


class _Provenance(_OutcomePart):
    config_hash: str
    seed: Any
    seconds: FiniteFloat


class _File(_OutcomePart):
    name: str
    caption: str


class _Outcome(_OutcomePart):
    experiment: str
    title: str
    shows: str
    decides: str
    command: str
    measures: dict[str, _Measure]
    verdicts: list[_Verdict]
    provenance: _Provenance
    figures: list[_File]
    tables: list[str]
    films: list[_File] = []
    replays: list[_File] = []
    unjudged: str = ""
    too_short: str = ""
    time_steps: str = ""


def check_described(outcome: Any, file: Path) -> None:
    """Refuse the contents of a file that is no outcome.

    Args:
        outcome: what a file says, as JSON is read.
        file: which, for the message.

    Raises:
        IncompatibleRecord: naming the place and what is wrong there.
    """
    try:
        _Outcome.model_validate(outcome)
    except ValidationError as error:
        first_error = error.errors(include_url=False, include_input=False)[0]
        location = ".".join(map(str, first_error["loc"]))
        if first_error["type"] == "missing":
            raise IncompatibleRecord(f"{file} lacks {location}.") from error
        raise IncompatibleRecord(
            f"{file} is no outcome of suchus: {location or 'it'} is of another kind ({first_error['msg'].lower()})."
        ) from error


_THUMBNAIL_WIDTH = 288
"""Width of a small picture [pixel], which is shown at half of it and sharp on fine screens."""


def content_hash(outcome: Mapping[str, Any]) -> str:
    """Return the SHA-256 of an outcome without its command and provenance, which differ between equal runs."""
    return digest({name: value for name, value in outcome.items() if name not in ("command", "provenance")})


_COLUMN = 1.15 * 72 * WIDTH
"""Width of a drawing beyond which it takes both columns of the page [pt]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A figure ready for a page."""

    name: str
    """Name of the file without its ending."""
    caption: str
    """Caption: what the picture or replay shows."""
    file: Path
    """The picture as a drawing; as pixels it stands beside it."""
    is_wide: bool = False
    """Whether the figure needs the full width of the page to be readable."""

    @property
    def source(self) -> Markup:
        """The picture itself as a data URI."""
        return embedded(self.file, self.file.with_suffix(".png"))

    @property
    def thumbnail(self) -> Markup:
        """A small picture of it as a data URI; empty where its pixels do not stand beside it."""
        png = self.file.with_suffix(".png")
        return as_pixels(png.read_bytes(), _THUMBNAIL_WIDTH) if png.is_file() else Markup()


@dataclass(frozen=True, slots=True, kw_only=True)
class MediaFile:
    """A film or a replay in a file of its own, which the page links."""

    file: Path
    """Path of the file."""
    caption: str
    """Caption: what the picture or replay shows."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """The contents of a folder of results."""

    folder: Path
    """The folder."""
    outcome: Mapping[str, Any]
    """Contents of ``outcome.json``."""
    pictures: tuple[Picture, ...]
    """The figures."""
    tables: Mapping[str, str]
    """Further texts by file name."""
    films: tuple[MediaFile, ...] = field(default=())
    """Moving pictures, those whose files are there."""
    replays: tuple[MediaFile, ...] = field(default=())
    """Runs to look at, those whose files are there."""

    @property
    def name(self) -> str:
        """Name of the experiment."""
        return str(self.outcome["experiment"])


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """An experiment that failed."""

    name: str
    """Name of the experiment."""
    sentence: str
    """One sentence that says why it failed."""
    trace: str = ""
    """Traceback, if the error is not one of suchus' own."""


def load_result(folder: str | Path) -> Result:
    """Read a folder that ``save_outcome`` wrote.

    Raises:
        UnreadableFile: there is no outcome in it.
        IncompatibleRecord: it says something else than an outcome should.
    """
    folder = Path(folder)
    file = folder / OUTCOME
    try:
        outcome = read_json(file)
        check_described(outcome, file)
        pictures = tuple(
            Picture(
                name=f["name"],
                caption=f["caption"],
                file=_path_inside(folder, f"{f['name']}.svg"),
                is_wide=_is_wide(_path_inside(folder, f"{f['name']}.svg")),
            )
            for f in outcome["figures"]
        )
        tables = {name: read_text(_path_inside(folder, name)) for name in outcome["tables"]}
        films = _moving(folder, outcome.get("films", ()))
        replays = _moving(folder, outcome.get("replays", ()))
    except UnreadableFile:
        raise
    except OSError as error:
        raise UnreadableFile(f"{error.filename or file} cannot be read: {(error.strerror or '').lower()}.") from error
    return Result(folder=folder, outcome=outcome, pictures=pictures, tables=tables, films=films, replays=replays)


def is_unchanged(result: Result) -> bool:
    """Return whether an outcome is as suchus wrote it; True for one of a version that wrote no ``content_hash``."""
    stored_hash = result.outcome["provenance"].get("content_hash")
    return stored_hash is None or stored_hash == content_hash(result.outcome)


def has_all_files(result: Result) -> bool:
    """Return whether every file that an outcome names is in its folder: record, films and replays too."""
    names = [
        RECORD,
        *(file["name"] for file_list in ("films", "replays") for file in result.outcome.get(file_list, ())),
    ]
    return all(_path_inside(result.folder, name).is_file() for name in names)


def _is_wide(svg: Path) -> bool:
    """Return whether a drawing is wider than a figure that fills one column of text."""
    width = re.search(r'<svg[^>]*\bwidth="([\d.]+)pt"', read_text(svg)[:2000])
    return width is not None and float(width[1]) > _COLUMN


def _moving(folder: Path, outcome: Iterable[Mapping[str, str]]) -> tuple[MediaFile, ...]:
    files = (MediaFile(file=_path_inside(folder, entry["name"]), caption=entry["caption"]) for entry in outcome)
    return tuple(entry for entry in files if entry.file.is_file())


def _path_inside(folder: Path, name: str) -> Path:
    """A file of the folder itself; a name that leads elsewhere is refused."""
    if Path(name).name != name:
        raise IncompatibleRecord(f"{folder / OUTCOME} is no outcome of suchus: {name!r} is no file of its folder.")
    return folder / name
