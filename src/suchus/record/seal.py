"""A seal at the end of a file: a checksum by which every flipped bit before it is known.

It follows the last byte of an HDF5 file, where other readers of NetCDF do not look.
"""

import hashlib

_MARK = b"\nsuchus sha256 "
_LENGTH = len(_MARK) + 64 + 1


def sealed(data: bytes) -> bytes:
    """Return the content of a file with its seal."""
    return data + _MARK + hashlib.sha256(data).hexdigest().encode() + b"\n"


def holds(data: bytes) -> bool | None:
    """Return whether a file is as it was written; None where it has no seal."""
    body, end = data[:-_LENGTH], data[-_LENGTH:]
    if not end.startswith(_MARK):
        return None
    return end == sealed(body)[-_LENGTH:]
