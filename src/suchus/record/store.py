"""Records on disk: NetCDF-4 files that appear complete or not at all."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.errors import IncompatibleRecord, UnreadableFile
from suchus.record.place import new_file
from suchus.record.provenance import plain

_MARK = "suchus_record"
_ATTRIBUTES = "suchus_attributes"
_VERSION = 1


def save(record: xr.Dataset, path: Path) -> Path:
    """Write a record as compressed NetCDF and return its path; equal records give equal bytes.

    Attributes of the record may nest: they are stored as JSON, so tuples come back as lists.

    Raises:
        Unwritable: the place cannot be written to.
    """
    attributes = json.dumps(plain(record.attrs), sort_keys=True)
    marked = record.assign_attrs().drop_attrs(deep=False)
    marked.attrs = {_MARK: _VERSION, _ATTRIBUTES: attributes}
    packed = {"zlib": True, "complevel": 4, "shuffle": True}
    encoding = {str(k): packed for k, v in marked.variables.items() if v.dtype.kind in "biuf" and v.size > 1}
    with new_file(path) as draft:  # through memory: HDF5 itself dies when the disk is full
        draft.write_bytes(marked.to_netcdf(engine="h5netcdf", encoding=encoding))
    return path


def load(path: Path) -> xr.Dataset:
    """Read a record into memory.

    Raises:
        UnreadableFile: there is no such file.
        IncompatibleRecord: the file is no record of suchus, or of a later version.
    """
    if not path.is_file():
        raise UnreadableFile(f"there is no file {path}.")
    try:
        record = xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise IncompatibleRecord(f"{path} is not a NetCDF file that can be read.") from error
    version = record.attrs.get(_MARK)
    if version is None:
        raise IncompatibleRecord(f"{path} was not written by suchus.")
    if int(version) > _VERSION:
        raise IncompatibleRecord(
            f"{path} is a record of version {version}; this suchus reads up to {_VERSION}: update suchus."
        )
    attributes: dict[str, Any] = json.loads(record.attrs[_ATTRIBUTES])
    record.attrs = attributes
    return record.assign({k: v.astype(np.str_) for k, v in record.variables.items() if _is_text(v)})


def _is_text(variable: xr.Variable) -> bool:
    return variable.dtype.kind in "OT"
