"""The one place where a NetCDF file is opened: whatever a damaged or foreign one does becomes one sentence."""

import io
from pathlib import Path

import h5py
import xarray as xr

from suchus.errors import IncompatibleRecord

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


def _check_inside(file: h5py.File, path: Path, most: int) -> None:
    """Refuse groups and data that lie in other files, and data that are larger than the file can make them."""
    size, groups, seen = 0, [file], set()
    while groups:
        group = groups.pop()
        for name in group:
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                raise IncompatibleRecord(f"{path} refers to other files or places by {name!r}; that is not followed.")
            inside = group[name]
            if isinstance(inside, h5py.Group):
                if inside.id not in seen:
                    seen.add(inside.id)
                    groups.append(inside)
            elif isinstance(inside, h5py.Dataset):
                if inside.external or inside.is_virtual:
                    raise IncompatibleRecord(f"{path} keeps {name!r} in other files; that is not followed.")
                size += inside.size * inside.dtype.itemsize if inside.size else 0
    if size > most:
        raise IncompatibleRecord(f"{path} claims to hold {size:.3g} bytes, more than a file of its size can.")
