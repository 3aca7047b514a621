"""Checkpoints: the whole state of a simulation in one file, from which it goes on to the same bytes."""

import struct
import zlib
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from time import monotonic
from typing import Protocol
from zipfile import BadZipFile

import numpy as np

from suchus.core.errors import UnreadableFile
from suchus.core.fingerprint import fingerprint
from suchus.core.reading import check_file
from suchus.core.writing import keep

VERSION = 12
"""Layout of the file; rises with every change of it."""

MARK = b"suchus flow checkpoint %d\n" % VERSION
"""How the file begins; after it the SHA-256 of the rest, 32 bytes, and then the rest, arrays in NumPy's ``npz``."""

_BROKEN = (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError, ArithmeticError, MemoryError,
           EOFError, SyntaxError, BadZipFile, zlib.error, struct.error)  # fmt: skip
"""Errors that zipfile, zlib and NumPy raise for damaged files, and related ones."""

State = dict[str, np.ndarray]
"""What a simulation needs to go on, by name."""


class Resumable(Protocol):
    """A simulation that can be saved and resumed."""

    @property
    def setup(self) -> object:
        """What is simulated; a simulation with the same setup can resume from this one's state."""

    def state(self) -> State:
        """Return all that changes."""

    def resume(self, state: State) -> None:
        """Set all that changes."""


def save(sim: Resumable, path: Path) -> None:
    """Write the state to a file; a kill in between leaves the old file whole.

    Args:
        sim: the simulation.
        path: file to write.

    Raises:
        Unwritable: naming the place.
    """
    content = BytesIO()
    np.savez(content, allow_pickle=False, setup=np.array(fingerprint(sim.setup)), **sim.state())
    data = content.getvalue()
    keep(path, MARK + sha256(data).digest() + data)


def load(sim: Resumable, path: Path) -> None:
    """Set the simulation to the state in a file.

    Args:
        sim: the simulation to resume.
        path: file to read.

    Raises:
        UnreadableFile: not a checkpoint, of another version, damaged, or of another setup.
    """
    check_file(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UnreadableFile(f"the checkpoint {path} cannot be read: {error.strerror}.") from error
    if not data.startswith(MARK):
        raise UnreadableFile(f"{path} is not a checkpoint of version {VERSION}; delete it to start anew.")
    digest, content = data[len(MARK) : len(MARK) + 32], data[len(MARK) + 32 :]
    if sha256(content).digest() != digest:
        raise UnreadableFile(
            f"the checkpoint {path} is damaged: its checksum is not that of what it holds. Delete it to start anew."
        )
    state = arrays(content, path)
    if "setup" not in state or str(state["setup"]) != fingerprint(sim.setup):
        raise UnreadableFile(f"{path} was written by another setup; give that setup, or another file.")
    sim.resume(state)


def arrays(content: bytes, path: Path) -> State:
    """Return the arrays of NumPy's ``npz``.

    Args:
        content: content of a file.
        path: what it is called in messages.

    Raises:
        UnreadableFile: it holds something else, or is damaged.
    """
    try:
        with np.load(BytesIO(content), allow_pickle=False) as file:
            return {key: file[key] for key in file.files}
    except _BROKEN as error:
        raise UnreadableFile(f"{path} holds no arrays that can be read; delete it to start anew.") from error


class Saver:
    """Saves a simulation at intervals of wall-clock time."""

    def __init__(self, path: Path | None, interval: float) -> None:
        self._path, self._interval, self._saved = path, interval, monotonic()

    def save(self, sim: Resumable, *, is_forced: bool = False) -> None:
        """Save if a path was given and the interval has passed, or if ``now`` is true."""
        if self._path is not None and (is_forced or monotonic() - self._saved >= self._interval):
            save(sim, self._path)
            self._saved = monotonic()
