"""A folder of result tables, one file for each part; each file is complete or absent."""

import fcntl
import hashlib
import json
import logging
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray as xr

from suchus.core import machine
from suchus.core.errors import IncompatibleRecord, UnreadableFile, Unwritable
from suchus.core.files import check_writable, load, path_exists, read_json, save
from suchus.core.files.store import packed as packed_record
from suchus.core.jobs.made_by import source_versions
from suchus.core.writing import keep, write

_NUMBERS, _COLUMN, _COLUMN_ATTRIBUTES, _ORDER = "numbers", "column", "about", "order"  # of a table that is packed
MARK = "study.json"
RESULTS, TABLE = "results.nc", "results.csv"
_FORMAT = 4
_LOG = logging.getLogger(__name__)


class StudySpec(Protocol):
    """A frozen value that says all that decides what the parts hold: a study, a search."""

    @property
    def name(self) -> str:
        """Name, as messages, tables and files show it."""


class Store:
    """The parts of a study, or of a search, on disk.

    Args:
        folder: where they are, or shall be.
        study: study of the stored batches, a dataclass.
        kind: what it is called in messages; also the name of the file that says what the store holds.
        versions: returns what decides the bytes here, see ``made_by.source_versions``.
    """

    def __init__(
        self,
        folder: str | Path,
        study: StudySpec,
        *,
        kind: str = "study",
        versions: Callable[[], Mapping[str, str]] = source_versions,
    ) -> None:
        """Store the settings; the folder is neither made nor read yet."""
        self.folder = Path(folder)
        self.study = study
        self.kind = kind
        self._mark = f"{kind}.json"
        self._versions = versions

    @contextmanager
    def opened(self) -> Iterator["Store"]:
        """Hold the store: make it, or check that it is this study's, and keep others out.

        Raises:
            Unwritable: the place cannot be written to, is taken by something else, or another process is at it.
            IncompatibleRecord: it holds another study, or was written by another version; it stays as it is.
        """
        with (
            self._alone(),
            _no_lock_of_dask(),
        ):  # first of all, so that of studies that start together one finds the other at it
            mark = self.folder / self._mark
            if mark.is_file():
                self._check(mark)
            elif any(self._foreign()):
                raise self._foreign_folder_error()
            check_writable(self.folder)
            if not mark.is_file():
                keep(mark, (json.dumps(self._origin(), indent=1, sort_keys=True) + "\n").encode())
            self._sweep()
            yield self

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Create the folder if it is missing, and hold a lock on it."""
        is_new = not path_exists(self.folder)
        if not is_new and not self.folder.is_dir():
            raise self._foreign_folder_error()
        if is_new:
            check_writable(self.folder)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(self.folder, os.O_RDONLY | os.O_DIRECTORY)
        except OSError as error:
            raise Unwritable(f"{self.folder} cannot be written: {(error.strerror or str(error)).lower()}.") from error
        try:
            self._lock(descriptor)
            yield
        finally:
            os.close(descriptor)

    def _lock(self, descriptor: int) -> None:
        """Lock the folder of a file descriptor, or raise ``Unwritable`` where another process holds the lock."""
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Unwritable(f"{self.folder} is being written by another process; wait or choose another.") from None
        except OSError as error:
            raise Unwritable(f"{self.folder} lies on a disk that knows no locks; choose another place.") from error

    def _foreign_folder_error(self) -> Unwritable:
        return Unwritable(f"{self.folder} exists and holds no {self.kind}; choose another place or move it away.")

    def part(self, number: int) -> Path:
        """Return the file of one batch."""
        return self.folder / "parts" / f"{number:06d}.nc"

    def has(self, number: int) -> bool:
        """Return whether a batch is finished and undamaged; a damaged file is reported."""
        if not self.part(number).is_file():
            return False
        try:
            sound = load(self.part(number), require_seal=True).attrs.get("part") == number
        except (IncompatibleRecord, UnreadableFile):
            sound = False
        if not sound:
            _LOG.warning("%s is damaged and is made again.", self.part(number))
        return sound

    def put(self, number: int, table: xr.Dataset) -> None:
        """Keep the results of a batch.

        Raises:
            Unwritable: the disk is full, or gone.
        """
        save(packed(table.assign_attrs(part=number, study=self.study.name)), self.part(number))

    def get(self, number: int) -> xr.Dataset:
        """Return the results of a finished batch, as they were put."""
        table = unpacked(load(self.part(number)))
        table.attrs = {name: value for name, value in table.attrs.items() if name not in ("part", "study")}
        return table

    def gather(self, parts: int) -> xr.Dataset:
        """Put all parts together, as ``results.nc`` and ``results.csv`` too, and return them.

        Raises:
            UnreadableFile: a part is missing.
            Unwritable: the place cannot be written to.
        """
        tables = []
        for number in range(parts):
            if not self.part(number).is_file():
                raise UnreadableFile(
                    f"{self.folder} lacks part {number} of {parts}; start the {self.kind} again to finish it."
                )
            tables.append(self.get(number))
        table = concatenate_tables(tables).assign_attrs(study=self.study.name, settings=self._origin()["fields"])
        if len(machines := self.machines()) > 1:
            table.attrs["machines"] = json.dumps(machines)
        write(self.folder / RESULTS, packed_record(table))
        write(self.folder / TABLE, table.to_dataframe().to_csv(lineterminator="\n"))
        return table

    def machines(self) -> list[dict[str, Any]]:
        """Return what the store says of the machines that wrote its parts; several only where somebody asked to mix."""
        mark = self.folder / self._mark
        return list(read_json(mark).get("machines", ())) if mark.is_file() else []

    def _origin(self) -> dict[str, Any]:
        """Return the description of this store: its format, study, versions and machine."""
        field_texts = {f.name: repr(getattr(self.study, f.name)) for f in fields(self.study)}  # type: ignore[arg-type]
        return {
            "format": _FORMAT,
            "name": self.study.name,
            "hash": hashlib.sha256(repr(self.study).encode()).hexdigest(),
            "fields": field_texts,
            "versions": dict(self._versions()),
            "machines": [machine.provenance()],
        }

    def _check(self, mark: Path) -> None:
        """Refuse what another study or another version wrote."""
        try:
            description = read_json(mark)
            name, stored_fields, stored_versions = (
                description["name"],
                dict(description["fields"]),
                dict(description["versions"]),
            )
            machines = [dict(entry["arithmetic"]) for entry in description.get("machines", ())]
        except (UnreadableFile, ValueError, KeyError, TypeError) as error:
            raise IncompatibleRecord(f"{mark} is no description of a {self.kind}; choose another place.") from error
        origin = self._origin()
        if stored_fields != origin["fields"]:
            differing_fields = [key for key in origin["fields"] if stored_fields.get(key) != origin["fields"][key]]
            raise IncompatibleRecord(
                f"{self.folder} holds {self.kind} {name!r}, which differs from {self.study.name!r} in "
                f"{', '.join(differing_fields)}; choose another place, or finish that one with its own file."
            )
        version_changes = [
            f"{key} {stored_versions.get(key)} (here {value})"
            for key, value in origin["versions"].items()
            if stored_versions.get(key) != value
        ]
        if version_changes or description.get("format") != _FORMAT:
            maker_text = ", ".join(version_changes) or f"format {description.get('format')} (here {_FORMAT})"
            raise IncompatibleRecord(
                f"{self.folder} was written by {maker_text}; mixed results would not be the same to the byte: choose "
                "another place, or install those versions to finish it."
            )
        self._check_machine(mark, description, machines)

    def _check_machine(self, mark: Path, description: dict[str, Any], machines: list[dict[str, str]]) -> None:
        """Refuse a store of a machine with another arithmetic, or, if mixing is allowed, add this machine to it."""
        if any(not machine.differences(arithmetic) for arithmetic in machines):
            return
        if not machine.asked_to_mix():
            parts = " and ".join(machine.differences(machines[0] if machines else {}))
            raise IncompatibleRecord(
                f"{self.folder} was begun on a machine whose {parts} give other last bits "
                f"({_machine_names(description)}; here {_machine_names({'machines': [machine.provenance()]})}): "
                "mixed results would not be the same to the byte. Finish it there, choose another place, or say "
                f"--mixed, which the results then tell; begun with {machine.PORTABLE_VARIABLE}=1 a {self.kind} gives "
                f"the same "
                "bytes on both."
            )
        description["machines"] = [*description.get("machines", ()), machine.provenance()]
        keep(mark, (json.dumps(description, indent=1, sort_keys=True) + "\n").encode())

    def _foreign(self) -> Iterator[Path]:
        """Everything in the folder but drafts that a kill left behind before the study was described."""
        drafts = (f".{self._mark}-", ".suchus-")
        return (entry for entry in self.folder.iterdir() if not entry.name.startswith(drafts))

    def _sweep(self) -> None:
        """Take away drafts that a kill left behind."""
        for folder in (self.folder, self.folder / "parts"):
            for draft in folder.glob(".*.*-*"):
                if draft.is_dir():
                    shutil.rmtree(draft, ignore_errors=True)


def _machine_names(description: Mapping[str, Any]) -> str:
    """Return the names of the machines in a store's description, for a message."""
    names = ("processor", "vector instructions", "linear algebra", "C library")
    machine_texts = ["; ".join(entry["described"][name] for name in names) for entry in description.get("machines", ())]
    return " and ".join(machine_texts) or "a machine that is not named"


@contextmanager
def _no_lock_of_dask() -> Iterator[None]:
    """Let files be written by this process alone, whatever client is Dask's default.

    With a default client xarray asks the scheduler for a lock on every file, which a busy one may have forgotten.
    """
    if "distributed" not in sys.modules:
        yield
        return
    import dask  # noqa: PLC0415  whoever has a client has it

    with dask.config.set(scheduler="threads"):
        yield


def concatenate_tables(tables: Sequence[xr.Dataset]) -> xr.Dataset:
    """Concatenate tables along ``sample``; a column that a table lacks is NaN in its rows."""
    columns = {str(name): v.attrs for table in tables for name, v in table.data_vars.items() if name != "error"}
    rows = {
        name: np.concatenate([t[name].values if name in t else np.full(t.sizes["sample"], np.nan) for t in tables])
        for name in (*columns, "error")
    }
    return xr.Dataset(
        {name: ("sample", values, columns.get(name, {})) for name, values in rows.items()},
        coords={"sample": np.concatenate([table.sample.values for table in tables])},
    )


def read_description(folder: Path, *, key: str = "versions") -> dict[str, str]:
    """Return a part of a store's description: the versions that made it, or with the key ``fields`` its study's fields.

    Raises:
        UnreadableFile: there is no store.
    """
    try:
        return dict(json.loads((folder / MARK).read_text(encoding="utf-8"))[key])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UnreadableFile(f"{folder} holds no study; start it first.") from error


# --- a table in a file: its columns of numbers as one variable, which is a hundred times faster than a hundred ---


def packed(table: xr.Dataset) -> xr.Dataset:
    """Return a table with all its columns of numbers along one dimension in one variable.

    Args:
        table: of which columns of 64-bit numbers have one dimension and the same; another is returned as it is.
    """
    names = [str(name) for name, column in table.data_vars.items() if column.ndim == 1 and column.dtype == float]
    dims = {table[name].dims for name in names}
    if len(dims) != 1:
        return table
    column_attributes = [[name, dict(table[name].attrs)] for name in names]  # a list: files keep no order of names
    order = [str(name) for name in table.data_vars]
    numbers = np.stack([table[name].values for name in names], axis=1)
    packed_table = table.drop_vars(names).assign_attrs({_COLUMN_ATTRIBUTES: column_attributes, _ORDER: order})
    return packed_table.assign({_NUMBERS: ((*dims.pop(), _COLUMN), numbers)})


def unpacked(table: xr.Dataset) -> xr.Dataset:
    """Return the table that was packed."""
    if _COLUMN_ATTRIBUTES not in table.attrs:
        return table
    dim, numbers = table[_NUMBERS].dims[0], table[_NUMBERS].values
    columns = {
        name: (dim, numbers[:, i].copy(), attrs) for i, (name, attrs) in enumerate(table.attrs[_COLUMN_ATTRIBUTES])
    }
    unpacked_table = table.drop_vars(_NUMBERS).assign(columns)[table.attrs[_ORDER]]
    unpacked_table.attrs = {
        name: value for name, value in table.attrs.items() if name not in (_COLUMN_ATTRIBUTES, _ORDER)
    }
    return unpacked_table
