"""Records on disk: NetCDF-4 files that appear complete or not at all, and are known if a bit of them flips."""

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr
from xarray.backends import H5NetCDFStore
from xarray.backends.locks import HDF5_LOCK

from suchus.core.errors import IncompatibleRecord
from suchus.core.files.provenance import plain
from suchus.core.reading import check_file, unreadable
from suchus.core.writing import keep

_SEAL = b"\nsuchus sha256 "
_SEAL_LENGTH = len(_SEAL) + 64 + 1  # [byte]
_MIN_SEAL_PART, _SEAL_SEARCH = 8, 4096  # [byte]; beginning of a seal that is known as one; where else one is looked for


def sealed(data: bytes) -> bytes:
    """Return the content of a file with its seal: a checksum by which every flipped bit before it is known.

    It follows the last byte of an HDF5 file, where other readers of NetCDF do not look.
    """
    return data + _SEAL + hashlib.sha256(data).hexdigest().encode() + b"\n"


def holds(data: bytes) -> bool | None:
    """Return whether a file is as it was written; None where it has no seal.

    A seal that is cut, or that other bytes follow, is none that suchus wrote: the file is not as it was written.
    """
    body, end = data[:-_SEAL_LENGTH], data[-_SEAL_LENGTH:]
    if not end.startswith(_SEAL):
        is_cut = any(data.endswith(_SEAL[:length]) for length in range(_MIN_SEAL_PART, len(_SEAL)))
        return False if is_cut or _SEAL in data[-_SEAL_SEARCH:] else None
    return end == sealed(body)[-_SEAL_LENGTH:]


_PACKED = 1100
"""A byte of a file stands for fewer bytes of its content: deflate packs 1032 into one at most [-]."""
_SMALL = 2**24
"""Content that is always read [byte]."""
_BROKEN = (OSError, ValueError, LookupError, RuntimeError, AttributeError, TypeError, ArithmeticError, MemoryError,
           AssertionError, EOFError)  # fmt: skip
"""What h5py, h5netcdf and xarray were seen to raise for files with flipped bytes, and those near them."""


def open_foreign(data: bytes, path: Path) -> xr.Dataset:
    """Return what a NetCDF-4 file holds.

    Args:
        data: its bytes.
        path: what it is called in messages.

    Raises:
        IncompatibleRecord: it is no such file, is broken, names other files, or claims to hold more than it can.
    """
    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            _check_inside(file, path, max(_SMALL, _PACKED * len(data)))
        return xr.load_dataset(io.BytesIO(data), engine="h5netcdf", decode_times=False)
    except IncompatibleRecord:
        raise
    except _BROKEN as error:
        raise IncompatibleRecord(f"{path} is not a NetCDF file that can be read.") from error


def _check_inside(file: h5py.File, path: Path, max_size: int) -> None:
    """Refuse groups and data that lie in other files, and data that are larger than the file can make them."""
    size, groups, group_ids = 0, [file], set()
    while groups:
        group = groups.pop()
        for name in group:
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                raise IncompatibleRecord(f"{path} refers to other files or places by {name!r}; that is not followed.")
            member = group[name]
            if isinstance(member, h5py.Group):
                if member.id not in group_ids:
                    group_ids.add(member.id)
                    groups.append(member)
            elif isinstance(member, h5py.Dataset):
                if member.external or member.is_virtual:
                    raise IncompatibleRecord(f"{path} keeps {name!r} in other files; that is not followed.")
                size += member.size * member.dtype.itemsize if member.size else 0
    if size > max_size:
        raise IncompatibleRecord(f"{path} claims to hold {size:.3g} bytes, more than a file of its size can.")


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
    keep(path, packed(record))
    return path


def packed(record: xr.Dataset) -> bytes:
    """Return a record as the bytes of its file, which ``load`` reads."""
    attributes = json.dumps(plain(record.attrs), sort_keys=True)
    marked = record.assign_attrs().drop_attrs(deep=False)
    marked.attrs = {_MARK: _VERSION, _ATTRIBUTES: attributes}
    packed = {"zlib": True, "complevel": 4, "shuffle": True}
    encoding = {str(k): packed for k, v in marked.variables.items() if v.dtype.kind in "biuf" and v.size > 1}
    memory = io.BytesIO()  # HDF5 itself dies when the disk is full
    store = H5NetCDFStore.open(memory, mode="w", lock=HDF5_LOCK)  # for a lock ``to_netcdf`` imports a cluster
    marked.dump_to_store(store, encoding=encoding)
    store.close()
    return sealed(memory.getvalue())


def load(path: str | Path, *, require_seal: bool = False) -> xr.Dataset:
    """Read a record into memory.

    Args:
        path: path of the file.
        require_seal: whether a file without a seal is refused too, as one that something else has changed.

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
    if unbroken is False or (require_seal and unbroken is None):
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
    """Return the attributes that a record stores as JSON text."""
    try:
        attributes = json.loads(text) if isinstance(text, str) else None
    except (ValueError, RecursionError):
        attributes = None
    if not isinstance(attributes, dict):
        raise IncompatibleRecord(f"{path} has attributes that suchus did not write; make the record again.")
    return attributes


def _is_text(variable: xr.Variable) -> bool:
    return variable.dtype.kind in "OT"
