"""Arrays packed for the page: one block of bytes, and where in it each array lies."""

import base64
from typing import Any

import numpy as np

_KINDS = {"int8", "uint8", "int16", "uint16", "uint32", "float32"}


class PackedArrays:
    """Bytes that grow; every array begins at a multiple of four."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self.size = 0
        """Bytes so far [-]."""

    def add(self, array: np.ndarray) -> dict[str, Any]:
        """Append an array and return where it lies: its ``kind``, its ``start`` [byte], its ``count`` of numbers."""
        assert array.dtype.name in _KINDS
        raw = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).tobytes()
        place = {"kind": array.dtype.name, "start": self.size, "count": int(array.size)}
        raw += bytes(-len(raw) % 4)
        self._parts.append(raw)
        self.size += len(raw)
        return place

    def text(self) -> str:
        """Return everything as base64."""
        return base64.b64encode(b"".join(self._parts)).decode("ascii")


def quantised(values: np.ndarray, kind: type[np.signedinteger[Any]]) -> tuple[np.ndarray, float]:
    """Return whole numbers and the size of the largest value, which the greatest whole number stands for."""
    largest = float(np.abs(values).max(initial=0.0)) or 1.0
    return np.round(values / largest * np.iinfo(kind).max).astype(kind), largest
