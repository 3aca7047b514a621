"""Records on disk: NetCDF-4 files that appear complete or not at all, and are known if a bit of them flips."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.errors import IncompatibleRecord
from suchus.reading import check_file, unreadable
from suchus.record.foreign import open_foreign
from suchus.record.place import new_file
from suchus.record.provenance import plain
from suchus.record.seal import holds, sealed

_MARK = "suchus_record"
_ATTRIBUTES = "suchus_attributes"
_VERSION = 1


def save(record: xr.Dataset, path: str | Path) -> Path:
    """Write a record as compressed NetCDF and return its path; equal records give equal bytes.

    Attributes of the record may nest: they are stored as JSON, so tuples come back as lists.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    attributes = json.dumps(plain(record.attrs), sort_keys=True)
    marked = record.assign_attrs().drop_attrs(deep=False)
    marked.attrs = {_MARK: _VERSION, _ATTRIBUTES: attributes}
    packed = {"zlib": True, "complevel": 4, "shuffle": True}
    encoding = {str(k): packed for k, v in marked.variables.items() if v.dtype.kind in "biuf" and v.size > 1}
    with new_file(path) as draft:  # through memory: HDF5 itself dies when the disk is full
        draft.write_bytes(sealed(bytes(marked.to_netcdf(engine="h5netcdf", encoding=encoding))))
    return path


def load(path: str | Path, *, whole: bool = False) -> xr.Dataset:
    """Read a record into memory.

    Args:
        path: of the file.
        whole: whether a file without a seal is refused too, as one that something else has changed.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: the file is damaged, no record of suchus, or of a later version.
    """
    path = Path(path)
    check_file(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from error
    unbroken = holds(data)
    if unbroken is False or (whole and unbroken is None):
        raise IncompatibleRecord(f"{path} is damaged: it is not as suchus wrote it; make it again.")
    record = open_foreign(data, path)
    version = record.attrs.get(_MARK)
    if version is None:
        raise IncompatibleRecord(f"{path} was not written by suchus.")
    if not isinstance(version, (int, np.integer)) or version > _VERSION:
        raise IncompatibleRecord(
            f"{path} is a record of version {version}; this suchus reads up to {_VERSION}: update suchus."
        )
    record.attrs = _attributes(record.attrs.get(_ATTRIBUTES), path)
    return record.assign({k: v.astype(np.str_) for k, v in record.variables.items() if _is_text(v)})


def _attributes(text: object, path: Path) -> dict[str, Any]:
    try:
        attributes = json.loads(text) if isinstance(text, str) else None
    except (ValueError, RecursionError):
        attributes = None
    if not isinstance(attributes, dict):
        raise IncompatibleRecord(f"{path} has attributes that suchus did not write; make the record again.")
    return attributes


def _is_text(variable: xr.Variable) -> bool:
    return variable.dtype.kind in "OT"
