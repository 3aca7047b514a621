"""Kept results: ``results/NAME.json`` holds the numbers, what made them, and a probe that tells when they are old."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from evidence import tolerance
from evidence.tolerance import Bounded
from suchus.core import machine
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.files import commit_of, new_file

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
SHIPPED = {"claims": ROOT / "src" / "suchus" / "article" / "verdict" / "claims.json"}
"""Results whose numbers suchus itself reads: they stand in the package, and everything else about them here."""
FORMAT = 1
"""Version of the files' schema."""
_FIELDS = ("version", "commit", "seconds", "processor")


@dataclass(frozen=True, slots=True, kw_only=True)
class Origin:
    """What made a result."""

    version: str
    """Version of suchus."""
    commit: str
    """Abbreviated commit of the checkout, with ``+`` behind it where files differed from it; empty where unknown."""
    seconds: float | None
    """Processor time of the computation [s]; None where it was not measured."""
    processor: str
    """Processor on which it ran, as it calls itself; empty where unknown."""

    @classmethod
    def here(cls, seconds: float | None) -> "Origin":
        """Return what a result that is made now, on this machine and in this checkout, comes from.

        Args:
            seconds: processor time of the computation [s].
        """
        described = machine.describe()
        rounded = None if seconds is None else round(seconds, 1)
        return cls(version=version("suchus"), commit=commit(), seconds=rounded, processor=described["processor"])


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredResult:
    """A result as it is kept."""

    name: str
    """Name of the result, and of its file."""
    values: Any
    """The numbers: measures by name, or a table that its own page knows."""
    origin: Origin
    """What made it."""
    source: str = ""
    """Digest of the syntax trees of the modules that it reaches, see ``evidence.source``; empty where unknown."""
    probe: Mapping[str, Bounded] = field(default_factory=dict)
    """What its probe gave when it was made; empty where it has none."""


def names() -> list[str]:
    """Return the names of all results that are kept, in alphabetical order."""
    return sorted(path.stem for path in RESULTS.glob("*.json"))


def path_of(name: str) -> Path:
    """Return the file of a result."""
    return RESULTS / f"{name}.json"


def load(name: str, folder: Path | None = None) -> StoredResult:
    """Return a result.

    Args:
        name: of the result.
        folder: where its file stands; ``results`` if None.

    Raises:
        UnreadableFile: there is no such file, or it is damaged.
        IncompatibleRecord: a newer version of suchus wrote it.
    """
    path = (folder or RESULTS) / f"{name}.json"
    if not path.is_file():
        raise UnreadableFile(
            f"there is no result named {name!r}: {path} is missing; `make renew NAME={name}` computes it or says how."
        )
    remedy = f"restore it with git, or compute it again with `make renew NAME={name}`."
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UnreadableFile(f"{path} is damaged ({error}); {remedy}") from error
    if not isinstance(stored, dict) or not isinstance(stored.get("format"), int):
        raise UnreadableFile(f"{path} holds no result: it has no whole number named 'format'; {remedy}")
    if stored["format"] > FORMAT:
        raise IncompatibleRecord(
            f"{path} has format {stored['format']}, which a newer version of suchus wrote; this one reads up to "
            f"{FORMAT}. Update suchus."
        )
    try:
        values = json.loads(SHIPPED[name].read_text(encoding="utf-8")) if name in SHIPPED else stored["values"]
        return StoredResult(
            name=name, values=values, origin=Origin(**stored["made"]), source=stored["source"],
            probe=tolerance.read(stored["probe"]),
        )  # fmt: skip
    except (KeyError, TypeError) as error:
        raise UnreadableFile(f"{path} holds no whole result ({error}); {remedy}") from error


def save(result: StoredResult, folder: Path | None = None) -> Path:
    """Write a result, whole or not at all, and return its file.

    Args:
        result: what is kept.
        folder: where its file is to stand; ``results`` if None.

    Raises:
        Unwritable: the folder cannot be written to.
    """
    head = {
        "format": FORMAT,
        "made": {name: getattr(result.origin, name) for name in _FIELDS},
        "source": result.source,
    }
    probe = ",\n".join(f"  {json.dumps(name)}: {json.dumps(one.plain())}" for name, one in sorted(result.probe.items()))
    values = json.dumps(None if result.name in SHIPPED else result.values, indent=1, ensure_ascii=False)
    text = f'{json.dumps(head, indent=1)[:-2]},\n "probe": {{\n{probe}\n }},\n "values": {values}\n}}\n'
    place = (folder or RESULTS) / f"{result.name}.json"
    with new_file(place) as draft:
        draft.write_text(text, encoding="utf-8")
    if result.name in SHIPPED and folder is None:
        with new_file(SHIPPED[result.name]) as draft:
            draft.write_text(json.dumps(result.values, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return place


def save_part(name: str, values: Any, folder: Path | None = None) -> Path:
    """Write the numbers of a result of which only a part was computed again; the rest of the file stays as it is.

    Args:
        name: of the result.
        values: all its numbers, new and old ones.
        folder: where its file stands; ``results`` if None.

    Raises:
        UnreadableFile: there is a file, and it is damaged.
    """
    place = (folder or RESULTS) / f"{name}.json"
    if not place.is_file():
        return save(StoredResult(name=name, values=values, origin=Origin.here(None)), folder)
    return save(replace(load(name, folder), values=values), folder)


def commit() -> str:
    """Return the abbreviated commit of the checkout, with ``+`` where files differ from it; empty outside of git."""
    return commit_of(ROOT, "src", "evidence")
